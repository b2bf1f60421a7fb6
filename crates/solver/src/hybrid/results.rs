//! What comes of a run: events while it goes on, and its end.

use crate::method::{Dense, State};

/// A guard fired.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwitchEvent<Mode, const N: usize> {
    /// Where.
    pub s: f64,
    /// The guard that fired.
    pub guard: usize,
    /// Further guards of the mode that vanish at the same place, one bit each. Of guards that fire
    /// together the one listed first decides the transition, unless it gives way
    /// ([`Guard::yielding`]).
    ///
    /// Where mode and state go on unchanged these are the guards that cross here in their
    /// direction, as far as rounding tells: they have fired with this event and do not fire
    /// again. One that only touches is not among them, nor one whose zero can be told
    /// apart, which fires by itself. A terminal guard and one of
    /// [`Direction::Below`](crate::Direction::Below) are not either: they fire next, by an
    /// event of their own at the same place.
    pub simultaneous: u32,
    /// The guard's largest value in the phase over its slope here, in units of s: an error of the
    /// guard relative to that value moves the switch by the error times this. Large near a
    /// graze.
    pub flatness: f64,
    /// The mode that ended.
    pub from: Mode,
    /// The mode that begins; `from` if the run ends here.
    pub to: Mode,
    /// State on the guard, before the transition.
    pub before: State<N>,
    /// State after the transition; `before` if the run ends here.
    pub after: State<N>,
}

/// A guard came so close to zero without firing, or fired so briefly, that the dense output could
/// not tell; a step of the method to the extremum did.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Grazing<Mode> {
    /// Where.
    pub s: f64,
    /// The mode.
    pub mode: Mode,
    /// The guard.
    pub guard: usize,
    /// Its value at the extremum, by the method.
    pub margin: f64,
}

/// Receives what a run finds, in order.
pub trait Observer<Mode, const N: usize> {
    /// Whether [`Self::on_segment`] is wanted: dense output costs further stages.
    const WANTS_SEGMENTS: bool = false;

    /// A guard fired.
    fn on_switch(&mut self, _event: &SwitchEvent<Mode, N>) {}

    /// A guard touched zero or nearly so.
    fn on_grazing(&mut self, _grazing: &Grazing<Mode>) {}

    /// A step was accepted; `dense` covers it.
    fn on_segment(&mut self, _mode: Mode, _dense: &Dense<N>) {}
}

/// Observes nothing.
impl<Mode, const N: usize> Observer<Mode, N> for () {}

/// Why a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "snake_case"))]
pub enum Outcome {
    /// A terminal guard fired.
    EndedByGuard {
        /// Which.
        guard: usize,
    },
    /// The end of the span.
    ReachedEnd,
    /// [`Options::max_steps`](crate::Options::max_steps) was reached.
    StepLimit,
    /// [`Options::max_switches`](crate::Options::max_switches) was reached.
    SwitchLimit,
    /// The switches accumulate.
    Zeno {
        /// Where, extrapolated geometrically.
        accumulation: f64,
    },
}

/// Work done by a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Statistics {
    /// Accepted steps, those that end on a switch included.
    pub accepted: usize,
    /// Steps rejected for their error.
    pub rejected: usize,
    /// Steps rejected because a guard was not resolved.
    pub too_coarse: usize,
    /// Evaluations of the right-hand side.
    pub field: usize,
    /// Evaluations of all guards of a mode at a state.
    pub guards: usize,
    /// Steps repeated to end on a switch or on an extremum.
    pub resteps: usize,
    /// Guards on steps that needed the full isolation.
    pub isolations: usize,
    /// Switches.
    pub switches: usize,
    /// Touches.
    pub grazings: usize,
}

impl Statistics {
    /// Steps taken, good or not.
    pub(crate) fn tried(&self) -> usize {
        self.accepted + self.rejected + self.too_coarse
    }
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run<Mode, const N: usize> {
    /// Why it ended.
    pub outcome: Outcome,
    /// Where it ended.
    pub s: f64,
    /// In which mode.
    pub mode: Mode,
    /// The state there.
    pub state: State<N>,
    /// The work done.
    pub statistics: Statistics,
}
