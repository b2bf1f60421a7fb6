//! What a user writes: a system whose dimension is known at run time.

use std::fmt;

use num_dual::Dual64;

use crate::hybrid::{Guard, Schedule, constant};
use stickslip_number::{Enclosure, Interval, Number};

/// A piecewise-smooth ODE whose number of components is known at run time only.
///
/// The dimension is the length of the state from which a run starts. A run passes slices of states
/// and slopes with this length, and slices of values with the length of [`Self::guards`]. So a
/// length can only be wrong if a system expects another dimension than its start has.
///
/// The right-hand side and the guards of a mode must also be smooth a little beyond the guards'
/// zeros, since a trial step may end there.
pub trait DynamicSystem {
    /// A smooth regime, with everything besides time and state that its right-hand side and its
    /// guards depend on.
    type Mode: Copy + PartialEq + fmt::Debug;

    /// Writes the derivative of the state `y` in `mode` to `slope`, which has the length of `y` and
    /// may hold any numbers before.
    fn field(&self, mode: Self::Mode, s: f64, y: &[f64], slope: &mut [f64]);

    /// The guards of `mode`, any number of them. A mode must always have the same number.
    fn guards(&self, mode: Self::Mode) -> &[Guard];

    /// Writes the values of the guards of `mode` to `values`, which has the length of
    /// [`Self::guards`]. Values of guards that are [off](Guard::OFF) are ignored.
    fn guard_values(&self, mode: Self::Mode, s: f64, y: &[f64], values: &mut [f64]);

    /// Whether [`Self::enclose_guards`] bounds the guards.
    const READABLE: bool = false;

    /// Whether runs of up to 8 components, with up to 8 guards in each mode, take states of fixed
    /// dimension. They are several times as fast then, and the engine is compiled thrice more.
    const ON_FIXED_STATES: bool = false;

    /// The largest number of guards of a mode, and of [counters](Self::counter). Only used with
    /// [`Self::ON_FIXED_STATES`].
    fn most_guards(&self) -> usize {
        usize::MAX
    }

    /// A relative and an absolute tolerance of a step's error for each component, in the place of
    /// those of the [options](crate::Options). A list that is shorter leaves the others to these.
    fn tolerances(&self) -> &[(f64, f64)] {
        &[]
    }

    /// The components that the guards read, in any order; an empty list means all.
    fn reads(&self, _mode: Self::Mode) -> &[usize] {
        &[]
    }

    /// Bounds for the guards of `mode` along a curve.
    fn enclose_guards(
        &self,
        _mode: Self::Mode,
        _s: Enclosure,
        _y: &[Enclosure],
        _values: &mut [Enclosure],
    ) {
    }

    /// As [`HybridSystem::counter`](crate::HybridSystem::counter).
    fn counter(&self, _mode: Self::Mode, guard: usize) -> usize {
        guard
    }

    /// As [`HybridSystem::schedule`](crate::HybridSystem::schedule).
    fn schedule(&self, _mode: Self::Mode, _guard: usize) -> Schedule<'_> {
        Schedule::NEVER
    }

    /// The mode in which the run goes on behind the place `s` at which its switches accumulate, if
    /// it does. The state `y` after the last switch, of `guard` into `mode`, is changed to that
    /// from which it goes on. The provided version lets the run end there.
    fn rest(
        &self,
        _mode: Self::Mode,
        _guard: usize,
        _s: f64,
        _y: &mut [f64],
    ) -> Option<Self::Mode> {
        None
    }

    /// Writes the rates at which the guards of `mode` change along the solution through `y` to
    /// `rates`, as [`HybridSystem::guard_rates`](crate::HybridSystem::guard_rates) returns them.
    /// The provided version writes NaN, so that they are replaced by differences. Only margins use
    /// them.
    fn guard_rates(&self, _mode: Self::Mode, _s: f64, _y: &[f64], rates: &mut [f64]) {
        rates.fill(f64::NAN);
    }

    /// Writes bounds for the rates of the guards of `mode` to `rates`, whose bounds are infinite
    /// before, as [`HybridSystem::enclose_rates`](crate::HybridSystem::enclose_rates).
    fn enclose_rates(
        &self,
        _mode: Self::Mode,
        _s: Interval,
        _y: &[Interval],
        _rates: &mut [Interval],
    ) {
    }

    /// A number whose sign says which branch the transition takes, or NaN, as
    /// [`HybridSystem::transition_condition`](crate::HybridSystem::transition_condition). Only
    /// margins use it.
    fn transition_condition(&self, _mode: Self::Mode, _guard: usize, _s: f64, _y: &[f64]) -> f64 {
        f64::NAN
    }

    /// Changes the state `y` on `guard` of `mode` to the one that follows when the guard fires, and
    /// returns the mode that follows.
    ///
    /// The provided version changes nothing. It is for guards that end the run, and for guards that
    /// only report a crossing. A run may call this function more than once for an event.
    fn transition(&self, mode: Self::Mode, _guard: usize, _s: f64, _y: &mut [f64]) -> Self::Mode {
        mode
    }
}

/// A piecewise-smooth ODE whose number of components is known at run time only, and whose formulas
/// the solver can read: its guards are decided by bounds.
pub trait ReadableDynamic {
    /// A smooth regime.
    type Mode: Copy + PartialEq + fmt::Debug;

    /// Writes the derivative of the state `y` in `mode` to `slope`.
    fn field<T: Number>(&self, mode: Self::Mode, s: T, y: &[T], slope: &mut [T]);

    /// The guards of `mode`.
    fn guards(&self, mode: Self::Mode) -> &[Guard];

    /// Writes the values of the guards of `mode` to `values`.
    fn guard_values<T: Number>(&self, mode: Self::Mode, s: T, y: &[T], values: &mut [T]);

    /// As [`DynamicSystem::ON_FIXED_STATES`].
    const ON_FIXED_STATES: bool = false;

    /// As [`DynamicSystem::most_guards`].
    fn most_guards(&self) -> usize {
        usize::MAX
    }

    /// As [`DynamicSystem::tolerances`].
    fn tolerances(&self) -> &[(f64, f64)] {
        &[]
    }

    /// The components that the guards read, in any order; an empty list means all. Only these are
    /// bounded, which saves time if they are few.
    fn reads(&self, _mode: Self::Mode) -> &[usize] {
        &[]
    }

    /// As [`HybridSystem::counter`](crate::HybridSystem::counter).
    fn counter(&self, _mode: Self::Mode, guard: usize) -> usize {
        guard
    }

    /// As [`HybridSystem::schedule`](crate::HybridSystem::schedule).
    fn schedule(&self, _mode: Self::Mode, _guard: usize) -> Schedule<'_> {
        Schedule::NEVER
    }

    /// As [`DynamicSystem::rest`].
    fn rest(
        &self,
        _mode: Self::Mode,
        _guard: usize,
        _s: f64,
        _y: &mut [f64],
    ) -> Option<Self::Mode> {
        None
    }

    /// As [`DynamicSystem::transition_condition`].
    fn transition_condition(&self, _mode: Self::Mode, _guard: usize, _s: f64, _y: &[f64]) -> f64 {
        f64::NAN
    }

    /// As [`DynamicSystem::transition`].
    fn transition(&self, mode: Self::Mode, _guard: usize, _s: f64, _y: &mut [f64]) -> Self::Mode {
        mode
    }
}

impl<S: ReadableDynamic> DynamicSystem for S {
    type Mode = S::Mode;
    const READABLE: bool = true;
    const ON_FIXED_STATES: bool = S::ON_FIXED_STATES;

    fn most_guards(&self) -> usize {
        ReadableDynamic::most_guards(self)
    }
    fn tolerances(&self) -> &[(f64, f64)] {
        ReadableDynamic::tolerances(self)
    }
    #[inline]
    fn field(&self, mode: S::Mode, s: f64, y: &[f64], slope: &mut [f64]) {
        ReadableDynamic::field(self, mode, s, y, slope);
    }
    fn guards(&self, mode: S::Mode) -> &[Guard] {
        ReadableDynamic::guards(self, mode)
    }
    fn guard_values(&self, mode: S::Mode, s: f64, y: &[f64], values: &mut [f64]) {
        ReadableDynamic::guard_values(self, mode, s, y, values);
    }
    fn reads(&self, mode: S::Mode) -> &[usize] {
        ReadableDynamic::reads(self, mode)
    }
    fn enclose_guards(
        &self,
        mode: S::Mode,
        s: Enclosure,
        y: &[Enclosure],
        values: &mut [Enclosure],
    ) {
        ReadableDynamic::guard_values(self, mode, s, y, values);
    }
    fn counter(&self, mode: S::Mode, guard: usize) -> usize {
        ReadableDynamic::counter(self, mode, guard)
    }
    fn schedule(&self, mode: S::Mode, guard: usize) -> Schedule<'_> {
        ReadableDynamic::schedule(self, mode, guard)
    }
    fn rest(&self, mode: S::Mode, guard: usize, s: f64, y: &mut [f64]) -> Option<S::Mode> {
        ReadableDynamic::rest(self, mode, guard, s, y)
    }
    fn guard_rates(&self, mode: S::Mode, s: f64, y: &[f64], rates: &mut [f64]) {
        let mut slope = vec![0.0; y.len()];
        ReadableDynamic::field(self, mode, s, y, &mut slope);
        let along = y.iter().zip(slope).map(|(&y, slope)| Dual64::new(y, slope));
        let along: Vec<_> = along.collect();
        let mut values = vec![Dual64::from(f64::NAN); rates.len()];
        ReadableDynamic::guard_values(self, mode, Dual64::new(s, 1.0), &along, &mut values);
        for (rate, value) in rates.iter_mut().zip(values) {
            *rate = value.eps;
        }
    }
    fn enclose_rates(&self, mode: S::Mode, s: Interval, y: &[Interval], rates: &mut [Interval]) {
        let mut along: Vec<_> = y.iter().copied().map(constant).collect();
        let mut slope = vec![Enclosure::ENTIRE; y.len()];
        ReadableDynamic::field(self, mode, constant(s), &along, &mut slope);
        for (along, slope) in along.iter_mut().zip(slope) {
            along.slope = slope.value;
        }
        let mut values = vec![Enclosure::ENTIRE; rates.len()];
        ReadableDynamic::guard_values(self, mode, Enclosure::variable(s), &along, &mut values);
        for (rate, value) in rates.iter_mut().zip(values) {
            *rate = value.slope;
        }
    }
    fn transition_condition(&self, mode: S::Mode, guard: usize, s: f64, y: &[f64]) -> f64 {
        ReadableDynamic::transition_condition(self, mode, guard, s, y)
    }
    fn transition(&self, mode: S::Mode, guard: usize, s: f64, y: &mut [f64]) -> S::Mode {
        ReadableDynamic::transition(self, mode, guard, s, y)
    }
}

/// Where a run of a [`DynamicSystem`] starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DynamicStart<'a, Mode> {
    /// The first mode.
    pub mode: Mode,
    /// The independent variable at the start.
    pub s: f64,
    /// The state at the start. Its length is the dimension of the run, and may be 0: then only the
    /// time passes.
    pub state: &'a [f64],
}
