//! How a search is interrupted between two tasks, and goes on.

use crate::family::Family;
use crate::options::TraceOptions;
use crate::tracing::builder::Builder;
use crate::tracing::end::Stop;
use crate::tracing::runs::Traced;
use crate::tracing::tracer::Tracer;
use crate::tracing::tracer::state::{State, StateOf};
use crate::window::{Point, Window};

impl<'f, F: Family> Tracer<'f, F> {
    /// The state from which [`Self::resume`] goes on. While the tracer looks again, the result is
    /// the state before that.
    pub(crate) fn state(&self) -> StateOf<F> {
        self.before_look.as_deref().cloned().unwrap_or_else(|| self.now())
    }

    /// The state between two tasks.
    pub(super) fn now(&self) -> StateOf<F> {
        State {
            network: self.uncut(),
            uncertainties: self.builder.stops.iter().map(|stop| stop.uncertainty).collect(),
            suspects: self.builder.suspects.clone(),
            probed: self.probed,
            stage: self.stage.clone(),
            brackets: None,
            surveyed: false,
        }
    }

    /// Goes back, or on, to a state between two tasks.
    pub(super) fn restore(&mut self, state: StateOf<F>) {
        let statistics = state.network.statistics;
        self.runs.count_from([statistics.free_runs, statistics.prescribed_runs]);
        let stops = state.network.vertices.iter().zip(state.uncertainties);
        let stops = stops.map(|(vertex, uncertainty)| Stop { point: vertex.point, uncertainty });
        self.builder =
            Builder::of(stops.collect(), state.network, state.suspects, self.runs.lengths);
        (self.probed, self.stage) = (state.probed, state.stage);
    }

    /// A tracer that goes on from a state of a search in `window`.
    ///
    /// # Errors
    /// An option is out of its range, or the window is not a rectangle.
    pub(crate) fn resume(
        family: &'f F,
        window: &Window,
        options: &TraceOptions,
        mut state: StateOf<F>,
    ) -> Traced<Self, F> {
        let mut tracer = Self::new(family, window, options)?;
        let brackets = state.brackets.take();
        tracer.restore(state);
        if let Some(brackets) = brackets {
            tracer.begin_again(brackets);
        }
        Ok(tracer)
    }

    /// Makes a second look between pairs of places what the tracer does next.
    pub(crate) fn begin_again(&mut self, brackets: Vec<[Point; 2]>) {
        self.before_look = None;
        let state = State { brackets: Some(brackets.clone()), ..self.state() };
        self.before_look = Some(Box::new(state));
        self.begin_between(brackets);
    }

    /// Whether the tracer looks again where a verification disagreed.
    pub(crate) fn looks_again(&self) -> bool {
        self.before_look.is_some()
    }

    /// The number of pairs of places between which the tracer looks again, if it does.
    pub(crate) fn places_to_look(&self) -> Option<usize> {
        self.before_look.as_ref()?.brackets.as_ref().map(Vec::len)
    }

    /// The number of curves found so far.
    pub(crate) fn curve_count(&self) -> usize {
        self.builder.network.curves.len()
    }
}
