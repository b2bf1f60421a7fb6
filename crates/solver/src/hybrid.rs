//! Hybrid systems and their results. Start reading here.
//!
//! A user writes a [`HybridSystem`] and passes it to [`run`](crate::run). A run is a sequence of
//! phases. Each phase is in one mode, and ends with a switch or with the run. An [`Observer`]
//! receives the results while the run goes on.

mod guard;
mod mode_table;
mod readable;
mod results;
pub(crate) mod schedule;

use std::fmt;

pub use guard::{Direction, Guard};
pub use mode_table::{ModeNumber, ModeTable};
pub use readable::ReadableSystem;
pub(crate) use readable::constant;
pub use results::{
    Grazing, Observer, Outcome, Pole, Preempted, Rest, Run, Statistics, SwitchEvent,
};
pub use schedule::{Schedule, Times};

use crate::method::{Method, State, Step, Trial};
use stickslip_number::{Enclosure, Interval};

/// A piecewise-smooth ODE of `N` components with at most `G` guards in a mode.
///
/// The right-hand side and the guards of a mode must also be smooth a little beyond the guards'
/// zeros, since a trial step may end there.
pub trait HybridSystem<const N: usize, const G: usize> {
    /// A smooth regime, with everything besides time and state that its right-hand side and its
    /// guards depend on.
    type Mode: Copy + PartialEq + fmt::Debug;

    /// The derivative of the state in `mode`.
    fn field(&self, mode: Self::Mode, s: f64, y: &State<N>) -> State<N>;

    /// The guards of `mode`. [`Guard::OFF`] fills unused places.
    fn guards(&self, mode: Self::Mode) -> [Guard; G];

    /// The values of the guards of `mode`. Values in unused places are ignored.
    fn guard_values(&self, mode: Self::Mode, s: f64, y: &State<N>) -> [f64; G];

    /// The rates at which the guards of `mode` change along the solution through `y`. Their zeros
    /// are the guards' extrema, so each rate may be multiplied by any positive function. A rate is
    /// NaN if it is not known; the provided version returns NaN for all.
    ///
    /// Only margins ([`mod@crate::margin`]) use these rates. An unknown rate is replaced by a
    /// difference of fourth order of the guard along the field, over a small part of the longest
    /// step so far. This evaluates the guards five times and has a rounding error of some 1e-13. A
    /// guard that changes on a much shorter scale than the solution needs its own rate, or a
    /// `max_step` on that scale.
    fn guard_rates(&self, _mode: Self::Mode, _s: f64, _y: &State<N>) -> [f64; G] {
        [f64::NAN; G]
    }

    /// Whether [`Self::enclose_guards`] bounds the guards, so that their signs are decided and not
    /// sampled. It is true of every [`ReadableSystem`].
    const READABLE: bool = false;

    /// Bounds for the guards of `mode` along a curve, with bounds for time and state along that
    /// curve. A [`ReadableSystem`] provides them by itself.
    fn enclose_guards(
        &self,
        _mode: Self::Mode,
        _s: Enclosure,
        _y: &[Enclosure; N],
    ) -> [Enclosure; G] {
        [Enclosure::ENTIRE; G]
    }

    /// Bounds for the rates of the guards of `mode`, with bounds for time and state. Margins use
    /// them to bound the rounding of a rate. A [`ReadableSystem`] provides them by itself; for
    /// other systems, the noise of rates is measured.
    fn enclose_rates(&self, _mode: Self::Mode, _s: Interval, _y: &[Interval; N]) -> [Interval; G] {
        [Interval::ENTIRE; G]
    }

    /// The mode in which a phase goes on that has taken a step to the state `y`.
    ///
    /// A mode that starts from a known zero may need more state, or another form of its guards, as
    /// long as a guard is so near to that zero that its usual form would be rounding alone. This
    /// function then replaces it by a mode that has the same solutions. It should not do so where
    /// the usual form would be rounding still: after a short step, such a guard ends the phase at
    /// once.
    #[inline]
    fn settle(&self, mode: Self::Mode, _y: &State<N>) -> Self::Mode {
        mode
    }

    /// How far the first step after a switch to `mode` may go, in adaptive runs.
    ///
    /// The error of a step is controlled for the state. Where guards depend on differences that are
    /// much smaller than the state, because a singular end is near for example, this function names
    /// the length on which they change. A length that is not positive sets no limit.
    #[inline]
    fn longest_first_step(&self, _mode: Self::Mode, _s: f64, _y: &State<N>) -> f64 {
        f64::INFINITY
    }

    /// Takes the step `trial` in `mode`.
    ///
    /// The provided version works for every system. If the right-hand sides of the modes differ
    /// in cost, a system may give each mode a step of its own, compiled for that right-hand side
    /// alone. In the collision of spheres, slip uses two of eight components; the stages of the
    /// others vanish when it is compiled.
    #[inline]
    fn step<M: Method>(&self, mode: Self::Mode, trial: &Trial<'_, N>, step: &mut Step<N>) {
        step.take::<M>(&mut |s, y| self.field(mode, s, y), trial);
    }

    /// The mode and state that follow when `guard` of `mode` fires at `y`.
    ///
    /// The provided version changes nothing. It is for guards that end the run, and for guards
    /// that only report a crossing. It may be called more than once for an event, so it should be
    /// a function of its arguments alone.
    fn transition(
        &self,
        mode: Self::Mode,
        _guard: usize,
        _s: f64,
        y: &State<N>,
    ) -> (Self::Mode, State<N>) {
        (mode, *y)
    }

    /// The number, below `G`, under which the firings of `guard` of `mode` are counted
    /// ([`Guard::terminal_after`]). Guards with one number are counted together; the provided
    /// version returns the place of the guard, by which [margins](mod@crate::margin) always count.
    #[inline]
    fn counter(&self, _mode: Self::Mode, guard: usize) -> usize {
        guard
    }

    /// The times at which a [clock](Guard::clock) among the guards of `mode` fires.
    ///
    /// Steps end at these times, without a search. A time at which a phase begins belongs to the
    /// phase before; the run itself starts with the events at its start.
    fn schedule(&self, _mode: Self::Mode, _guard: usize) -> Schedule<'_> {
        Schedule::NEVER
    }

    /// The mode and state in which the run goes on behind the place `s` at which its switches
    /// accumulate, if it does; `y` is the state after the last switch, of `guard` into `mode`. The
    /// provided version lets the run end there ([`Outcome::Zeno`]).
    fn rest(
        &self,
        _mode: Self::Mode,
        _guard: usize,
        _s: f64,
        _y: &State<N>,
    ) -> Option<(Self::Mode, State<N>)> {
        None
    }

    /// A number that is positive where [`Self::transition`] takes one branch, and negative where it
    /// takes another one, for instance a slope of a guard that decides between sliding and
    /// crossing. It is NaN if the transition does not branch; the provided version always returns
    /// NaN.
    ///
    /// Only margins ([`mod@crate::margin`]) use it: the itinerary may change where it is zero.
    fn transition_condition(
        &self,
        _mode: Self::Mode,
        _guard: usize,
        _s: f64,
        _y: &State<N>,
    ) -> f64 {
        f64::NAN
    }
}

/// Where a run starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start<Mode, const N: usize> {
    /// The first mode.
    pub mode: Mode,
    /// The independent variable at the start.
    pub s: f64,
    /// The state at the start.
    pub state: State<N>,
}
