//! The results of a run: what it reports while it goes on, and how it ends.

use crate::method::{Dense, State};

/// A guard fired.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SwitchEvent<Mode, const N: usize> {
    /// The place of the switch.
    pub s: f64,
    /// The guard that fired.
    pub guard: usize,
    /// Further guards of the mode that vanish at the same place, one bit each; of a mode with more
    /// than 64 guards, the first 64 are named.
    ///
    /// Guards that cross zero here act next, with an event of their own at the same place. If mode
    /// and state go on unchanged, the guards listed cross here in their direction and change
    /// nothing either: they have fired with this event and do not fire again.
    pub simultaneous: u64,
    /// The guard's largest value in the phase divided by its slope here, in units of s. An error
    /// of the guard, relative to its largest value, moves the switch by the error times this
    /// number. It is large near a graze.
    pub flatness: f64,
    /// Whether the guard jumps over zero and is nowhere small.
    pub jump: bool,
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
/// decide whether it fires. A step of the method to the extremum decided it.
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

/// A guard changes its sign at a pole, where it is not zero and does not fire.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Pole<Mode> {
    /// The place of the pole.
    pub s: f64,
    /// The mode at that place.
    pub mode: Mode,
    /// The guard that has the pole.
    pub guard: usize,
}

/// A guard has crossed zero, but a guard that acted before it at the same instant led to a mode
/// that does not have it. It does not act.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Preempted<Mode> {
    /// The place of the instant.
    pub s: f64,
    /// The mode that has the guard.
    pub mode: Mode,
    /// The guard that does not act.
    pub guard: usize,
}

/// The switches of a run accumulated, and the run goes on behind the place where they do
/// ([`HybridSystem::rest`](crate::HybridSystem::rest)).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Rest<Mode> {
    /// The place where the switches accumulate, extrapolated geometrically.
    pub s: f64,
    /// The error of that place.
    pub error: f64,
    /// The guard that fired last.
    pub guard: usize,
    /// The mode that the last switch led to.
    pub from: Mode,
    /// The mode in which the run goes on.
    pub to: Mode,
}

/// Receives what a run finds, in order.
///
/// A run returns no list of switches. It reports them while it goes on, so that a sweep allocates
/// nothing. [`Recorder`](crate::Recorder) is the observer that keeps everything.
pub trait Observer<Mode, const N: usize> {
    /// Whether the run calls [`Self::on_segment`]. Dense output costs further stages.
    const WANTS_SEGMENTS: bool = false;

    /// A guard fired.
    fn on_switch(&mut self, _event: &SwitchEvent<Mode, N>) {}

    /// A guard touched zero, or nearly.
    fn on_grazing(&mut self, _grazing: &Grazing<Mode>) {}

    /// A guard changed its sign at a pole.
    fn on_pole(&mut self, _pole: &Pole<Mode>) {}

    /// A guard has crossed zero and does not act.
    fn on_preempted(&mut self, _preempted: &Preempted<Mode>) {}

    /// The switches of the run accumulated, and it goes on behind them.
    fn on_rest(&mut self, _rest: &Rest<Mode>) {}

    /// The last `switches` switches do not belong to the run. They belong to an endless chain at
    /// one instant, with which the run fails ([`RunError::Cycle`](crate::RunError::Cycle)).
    fn forget(&mut self, _switches: usize) {}

    /// Whether the run should stop at `s`, with [`Outcome::Stopped`]. Called after every step and
    /// every switch.
    fn stops(&self, _s: f64) -> bool {
        false
    }

    /// A step was accepted, and `dense` is its dense output.
    fn on_segment(&mut self, _mode: Mode, _dense: &Dense<N>) {}

    /// The run has ended at `s`, in this mode and state. It is called once, last, and not if the
    /// run fails.
    fn on_end(&mut self, _mode: Mode, _s: f64, _state: &State<N>) {}
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
    /// The observer stopped the run ([`Observer::stops`]).
    Stopped,
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
    /// Bounds of the guards of a readable system over a part of a step. One evaluation bounds all
    /// of them.
    pub enclosures: usize,
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
#[must_use = "a run may end early, which its outcome tells; `finished` turns that into an error"]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Run<Mode, const N: usize> {
    /// Why the run ended.
    pub outcome: Outcome,
    /// Where the run ended.
    pub s: f64,
    /// The mode at the end.
    pub mode: Mode,
    /// The state at the end.
    pub state: State<N>,
    /// Whether every guard was decided by bounds. It is false if guards of a black box were active:
    /// they are sampled, so that one that changes faster than the solution may have fired unseen. A
    /// [`ReadableSystem`](crate::ReadableSystem) has decided guards. It is false too if a
    /// reset has left a guard so close to its zero that the errors of events may have moved it.
    pub decided: bool,
    /// The work done by the run.
    pub statistics: Statistics,
}
