//! A run of a dynamic system: the engine on buffers.

use crate::dynamic::dense::DynamicDense;
use crate::dynamic::few::{Unpadded, on_fixed_states};
use crate::dynamic::results::{DynamicEvent, DynamicObserver, DynamicRun};
use crate::dynamic::system::{DynamicStart, DynamicSystem};
use crate::error::RunError;
use crate::events::Note;
use crate::hybrid::{Grazing, Pole, Preempted, Rest, Run};
use crate::method::{DenseOf, Method};
use crate::options::Options;
use crate::runs::run;
use crate::runs::runner::{End, Watcher, run_any};
use crate::system::Free;

/// Integrates `system` from `start` to `end`, through every switch on the way.
///
/// It does what [`run`](crate::run) does for a system of black boxes, with the same options,
/// outcomes, errors and defined answers; see [`mod@crate::dynamic`] for what differs. `end` may be
/// infinite if a terminal guard ends the run. All buffers are allocated when the run starts; a step
/// without event allocates nothing.
///
/// # Errors
/// A [`RunError`] reports invalid options, a span that does not lead forward, a state or right-hand
/// side that is not finite, a guard that is not a number, that is identically zero or that cannot
/// be resolved, and a tolerance that no step meets.
pub fn run_dynamic<M, S, O>(
    method: M,
    system: &S,
    start: DynamicStart<'_, S::Mode>,
    end: f64,
    options: &Options,
    observer: &mut O,
) -> Result<DynamicRun<S::Mode>, RunError>
where
    M: Method,
    S: DynamicSystem,
    O: DynamicObserver<S::Mode>,
{
    on_fixed_states!(system, start, |padded, from, n| {
        let mut observer = Unpadded { observer, n };
        let run = run(method, &padded, from, end, options, &mut observer)?;
        Ok(DynamicRun::of_few(run, n))
    });
    let mut watcher =
        DynamicWatcher { observer, simultaneous: Vec::new(), coefficients: Vec::new() };
    let from = (start.mode, start.s, &start.state.to_vec());
    let system = Free::new(system, start.state.len());
    run_any::<M, _, _>(&system, from, end, options, &mut watcher).map(DynamicRun::from)
}

impl<S: DynamicSystem> From<End<Free<'_, S>>> for DynamicRun<S::Mode> {
    fn from(end: End<Free<'_, S>>) -> Self {
        let End { outcome, s, mode, state, decided, statistics } = end;
        Self { outcome, s, mode, state, decided, statistics }
    }
}

impl<Mode> DynamicRun<Mode> {
    /// A run on fixed states, of which the first `n` components are those of the system.
    pub(crate) fn of_few<const N: usize>(run: Run<Mode, N>, n: usize) -> Self {
        let Run { outcome, s, mode, state, decided, statistics } = run;
        let state = state.as_slice()[..n].to_vec();
        Self { outcome, s, mode, state, decided, statistics }
    }
}

/// An observer of a run, with room for lists.
struct DynamicWatcher<'a, O> {
    observer: &'a mut O,
    simultaneous: Vec<usize>,
    coefficients: Vec<f64>,
}

impl<S: DynamicSystem, O: DynamicObserver<S::Mode>> Watcher<Free<'_, S>> for DynamicWatcher<'_, O> {
    const WANTS_SEGMENTS: bool = O::WANTS_SEGMENTS;

    fn on_switch(&mut self, note: &Note<Free<'_, S>>) {
        let &Note { s, guard, flatness, from, to, .. } = note;
        self.simultaneous.clear();
        self.simultaneous
            .extend((0..note.simultaneous.len()).filter(|&other| note.simultaneous[other]));
        self.observer.on_switch(&DynamicEvent {
            s,
            guard,
            simultaneous: &self.simultaneous,
            flatness,
            jump: note.jump(),
            from,
            to,
            before: &note.before,
            after: &note.after,
        });
    }
    fn on_grazing(&mut self, grazing: &Grazing<S::Mode>) {
        self.observer.on_grazing(grazing);
    }
    fn on_pole(&mut self, pole: &Pole<S::Mode>) {
        self.observer.on_pole(pole);
    }
    fn on_preempted(&mut self, preempted: &Preempted<S::Mode>) {
        self.observer.on_preempted(preempted);
    }
    fn on_rest(&mut self, rest: &Rest<S::Mode>) {
        self.observer.on_rest(rest);
    }
    fn forget(&mut self, switches: usize) {
        self.observer.forget(switches);
    }
    fn stops(&self, s: f64) -> bool {
        self.observer.stops(s)
    }
    fn on_segment(&mut self, mode: S::Mode, dense: &DenseOf<Vec<f64>>) {
        self.coefficients.clear();
        for r in &dense.r[..=dense.degree] {
            self.coefficients.extend_from_slice(r);
        }
        let (n, r) = (dense.r[0].len(), &self.coefficients[..]);
        let dense = DynamicDense { s: dense.s, h: dense.h, n, degree: dense.degree, r };
        self.observer.on_segment(mode, &dense);
    }
    fn on_end(&mut self, mode: S::Mode, s: f64, state: &Vec<f64>) {
        self.observer.on_end(mode, s, state);
    }
}
