//! The results of a run: what it reports while it goes on, and how it ends.

use crate::method::{Dense, State};

/// A guard fired.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwitchEvent<Mode, const N: usize> {
    /// The place of the switch.
    pub s: f64,
    /// The guard that fired.
    pub guard: usize,
    /// Further guards of the mode that vanish at the same place, one bit each. If several guards
    /// fire together, the guard that is listed first decides the transition, unless it yields
    /// ([`Guard::yielding`](crate::Guard::yielding)).
    ///
    /// If mode and state go on unchanged, these are the guards that cross here in their direction,
    /// as far as rounding tells. They have fired with this event and do not fire again. The
    /// following guards are not among them: a guard that only touches zero; a guard whose zero
    /// lies measurably elsewhere, which fires by itself; a terminal guard and a guard with
    /// [`Direction::Below`](crate::Direction::Below), which fire next, with an event of their own
    /// at the same place.
    pub simultaneous: u32,
    /// The guard's largest value in the phase divided by its slope here, in units of s. An error
    /// of the guard, relative to its largest value, moves the switch by the error times this
    /// number. It is large near a graze.
    pub flatness: f64,
    /// The mode that ended.
    pub from: Mode,
    /// The mode that begins. It is `from` if the run ends here.
    pub to: Mode,
    /// The state on the guard, before the transition.
    pub before: State<N>,
    /// The state after the transition. It is `before` if the run ends here.
    pub after: State<N>,
}

/// A guard came so close to zero, or was beyond zero so briefly, that the dense output could not
/// tell whether it fires. A step of the method to the extremum decided it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Grazing<Mode> {
    /// The place of the extremum.
    pub s: f64,
    /// The mode at that place.
    pub mode: Mode,
    /// The guard that comes close to zero.
    pub guard: usize,
    /// The guard's value at the extremum, by a step of the method.
    pub margin: f64,
}

/// Receives what a run finds, in order.
pub trait Observer<Mode, const N: usize> {
    /// Whether the run calls [`Self::on_segment`]. Dense output costs further stages.
    const WANTS_SEGMENTS: bool = false;

    /// A guard fired.
    fn on_switch(&mut self, _event: &SwitchEvent<Mode, N>) {}

    /// A guard touched zero, or nearly.
    fn on_grazing(&mut self, _grazing: &Grazing<Mode>) {}

    /// A step was accepted, and `dense` is its dense output.
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
        /// The guard that fired.
        guard: usize,
    },
    /// The run reached the end of its span.
    ReachedEnd,
    /// [`Options::max_steps`](crate::Options::max_steps) was reached.
    StepLimit,
    /// [`Options::max_switches`](crate::Options::max_switches) was reached.
    SwitchLimit,
    /// The switches accumulate.
    Zeno {
        /// The accumulation point, extrapolated geometrically.
        accumulation: f64,
    },
}

/// The work done by a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Statistics {
    /// Accepted steps, including those that end on a switch.
    pub accepted: usize,
    /// Steps rejected because their error was too large.
    pub rejected: usize,
    /// Steps rejected because a guard was not resolved.
    pub too_coarse: usize,
    /// Evaluations of the right-hand side.
    pub field: usize,
    /// Evaluations of the guards of a mode. One evaluation returns the values of all of them.
    pub guards: usize,
    /// Steps repeated to end on a switch or on an extremum.
    pub resteps: usize,
    /// Isolations of a guard on a step, where the quick look did not suffice.
    pub isolations: usize,
    /// Switches, without the one that ends the run.
    pub switches: usize,
    /// Extrema close to zero that a step of the method had to decide ([`Grazing`]).
    pub grazings: usize,
}

impl Statistics {
    /// Steps tried, accepted or not.
    pub(crate) fn tried(&self) -> usize {
        self.accepted + self.rejected + self.too_coarse
    }
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run<Mode, const N: usize> {
    /// Why the run ended.
    pub outcome: Outcome,
    /// Where the run ended.
    pub s: f64,
    /// The mode at the end.
    pub mode: Mode,
    /// The state at the end.
    pub state: State<N>,
    /// The work done by the run.
    pub statistics: Statistics,
}
