//! What a run of a dynamic system reports, and how it ends.

use crate::dynamic::dense::DynamicDense;
use crate::error::RunError;
use crate::hybrid::{Grazing, Outcome, Pole, Preempted, Rest, Statistics};

/// A guard of a [`DynamicSystem`](crate::dynamic::DynamicSystem) fired. The slices live as long as
/// the call of the observer; [`Self::to_switch`] keeps them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DynamicEvent<'a, Mode> {
    /// The place of the switch.
    pub s: f64,
    /// The guard that fired.
    pub guard: usize,
    /// Further guards of the mode that vanish at the same place, in ascending order. For their
    /// meaning see [`SwitchEvent::simultaneous`](crate::SwitchEvent::simultaneous); here there may
    /// be any number of them.
    pub simultaneous: &'a [usize],
    /// The guard's largest value in the phase divided by its slope here, in units of s
    /// ([`SwitchEvent::flatness`](crate::SwitchEvent::flatness)).
    pub flatness: f64,
    /// Whether the guard jumps over zero and is nowhere small.
    pub jump: bool,
    /// The mode that ended.
    pub from: Mode,
    /// The mode that begins. It is `from` if the run ends here.
    pub to: Mode,
    /// The state on the guard, before the transition.
    pub before: &'a [f64],
    /// The state after the transition. It is `before` if the run ends here.
    pub after: &'a [f64],
}

impl<Mode: Copy> DynamicEvent<'_, Mode> {
    /// The event with slices of its own.
    #[must_use]
    pub fn to_switch(&self) -> DynamicSwitch<Mode> {
        DynamicSwitch {
            s: self.s,
            guard: self.guard,
            simultaneous: self.simultaneous.to_vec(),
            flatness: self.flatness,
            jump: self.jump,
            from: self.from,
            to: self.to,
            before: self.before.to_vec(),
            after: self.after.to_vec(),
        }
    }
}

/// A [`DynamicEvent`] that is kept. A `Vec` of them is an observer.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct DynamicSwitch<Mode> {
    /// The place of the switch.
    pub s: f64,
    /// The guard that fired.
    pub guard: usize,
    /// Further guards that vanish at the same place ([`DynamicEvent::simultaneous`]).
    pub simultaneous: Vec<usize>,
    /// The guard's largest value in the phase divided by its slope here, in units of s.
    pub flatness: f64,
    /// Whether the guard jumps over zero and is nowhere small.
    pub jump: bool,
    /// The mode that ended.
    pub from: Mode,
    /// The mode that begins. It is `from` if the run ends here.
    pub to: Mode,
    /// The state on the guard, before the transition.
    pub before: Vec<f64>,
    /// The state after the transition. It is `before` if the run ends here.
    pub after: Vec<f64>,
}

/// Receives what a run of a [`DynamicSystem`](crate::dynamic::DynamicSystem) finds, in order, as
/// [`Observer`](crate::Observer) does of other runs.
pub trait DynamicObserver<Mode> {
    /// Whether the run calls [`Self::on_segment`]. Dense output costs further stages.
    const WANTS_SEGMENTS: bool = false;

    /// A guard fired.
    fn on_switch(&mut self, _event: &DynamicEvent<'_, Mode>) {}

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
    fn on_segment(&mut self, _mode: Mode, _dense: &DynamicDense<'_>) {}

    /// The run has ended at `s`, in this mode and state. It is called once, last, and not if the
    /// run fails.
    fn on_end(&mut self, _mode: Mode, _s: f64, _state: &[f64]) {}
}

/// Observes nothing.
impl<Mode> DynamicObserver<Mode> for () {}

/// Keeps the switches.
impl<Mode: Copy> DynamicObserver<Mode> for Vec<DynamicSwitch<Mode>> {
    fn on_switch(&mut self, event: &DynamicEvent<'_, Mode>) {
        self.push(event.to_switch());
    }

    fn forget(&mut self, switches: usize) {
        self.truncate(self.len().saturating_sub(switches));
    }
}

/// How a run of a [`DynamicSystem`](crate::dynamic::DynamicSystem) ended.
#[must_use = "a run may end early, which its outcome tells; `finished` turns that into an error"]
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct DynamicRun<Mode> {
    /// Why the run ended.
    pub outcome: Outcome,
    /// Where the run ended.
    pub s: f64,
    /// The mode at the end.
    pub mode: Mode,
    /// The state at the end.
    pub state: Vec<f64>,
    /// Whether every guard was decided by bounds. It is false if guards of a black box were active:
    /// they are sampled, so that one that changes faster than the solution may have fired unseen. A
    /// [`ReadableDynamic`](crate::dynamic::ReadableDynamic) has decided guards. It is false too if
    /// a reset has left a guard so close to its zero that the errors of events may have moved it.
    pub decided: bool,
    /// The work done by the run.
    pub statistics: Statistics,
}

impl<Mode> DynamicRun<Mode> {
    /// The run, if it came to a regular end: the end of its span or a terminal guard.
    ///
    /// # Errors
    /// [`RunError::Unfinished`] if the run ended early: at a limit, at an accumulation of switches,
    /// or because the observer stopped it.
    pub fn finished(self) -> Result<Self, RunError> {
        RunError::unless_regular(self.outcome, self.s).map(|()| self)
    }
}
