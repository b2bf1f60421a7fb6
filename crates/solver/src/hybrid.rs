//! Hybrid systems and what comes of them: start reading here.
//!
//! [`HybridSystem`] is what a user writes, [`run`](crate::run) what it is for, [`Observer`] how
//! results come out while the run goes on.

mod guard;
mod results;

use std::fmt;

pub use guard::{Direction, Guard};
pub use results::{Grazing, Observer, Outcome, Run, Statistics, SwitchEvent};

use crate::method::{Method, State, Step, Trial};

/// A piecewise-smooth ODE of `N` components with at most `G` guards in a mode.
///
/// The right-hand side and the guards of a mode must be smooth also a little beyond the guards'
/// zeros, since a trial step may end there.
pub trait HybridSystem<const N: usize, const G: usize> {
    /// A smooth regime, with all that its right-hand side and guards depend on beside the state.
    type Mode: Copy + PartialEq + fmt::Debug;

    /// The derivative of the state in `mode`.
    fn field(&self, mode: Self::Mode, s: f64, y: &State<N>) -> State<N>;

    /// The guards of `mode`; [`Guard::OFF`] fills unused places.
    fn guards(&self, mode: Self::Mode) -> [Guard; G];

    /// The values of the guards of `mode`; those of unused places are ignored.
    fn guard_values(&self, mode: Self::Mode, s: f64, y: &State<N>) -> [f64; G];

    /// The rates at which the guards of `mode` change along the solution through `y`, whose zeros
    /// are the guards' extrema; each may be multiplied by anything positive. NaN where they are
    /// not known, as in the provided version.
    ///
    /// Only margins use them. Rates that are not known are replaced by differences of the guards
    /// along the field, of fourth order, over a small part of the longest step so far
    /// ([`mod@crate::margin`]): five times the guards, and some 1e-13 of rounding. A guard that
    /// changes on a much shorter scale than the solution needs its own rate, or a `max_step` on
    /// that scale.
    fn guard_rates(&self, _mode: Self::Mode, _s: f64, _y: &State<N>) -> [f64; G] {
        [f64::NAN; G]
    }

    /// The mode in which a phase goes on once its first step is done.
    ///
    /// A mode that starts from a known zero may need more state for its first step than later, or
    /// another form of its guards; it then gives way here to one that has the same solutions.
    #[inline]
    fn settle(&self, mode: Self::Mode) -> Self::Mode {
        mode
    }

    /// Takes the step `trial` in `mode`.
    ///
    /// The provided one serves every system. A system whose modes have right-hand sides of
    /// different cost may give each mode a step of its own, compiled for that right-hand side
    /// alone.
    #[inline]
    fn step<M: Method>(&self, mode: Self::Mode, trial: &Trial<'_, N>, step: &mut Step<N>) {
        step.take::<M>(&mut |s, y| self.field(mode, s, y), trial);
    }

    /// The mode and state that follow when `guard` of `mode` fires at `y`.
    ///
    /// The provided one changes nothing. It serves guards that end the run, and those that take
    /// note of a crossing and go on.
    fn transition(
        &self,
        mode: Self::Mode,
        _guard: usize,
        _s: f64,
        y: &State<N>,
    ) -> (Self::Mode, State<N>) {
        (mode, *y)
    }
}

/// Where a run starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start<Mode, const N: usize> {
    /// The first mode.
    pub mode: Mode,
    /// The independent variable.
    pub s: f64,
    /// The state.
    pub state: State<N>,
}
