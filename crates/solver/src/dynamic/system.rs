//! What a user writes: a system whose dimension is known at run time.

use std::fmt;

use crate::hybrid::{Guard, Schedule};
use stickslip_number::{Enclosure, Number};

/// A piecewise-smooth ODE whose number of components is known at run time only.
///
/// The dimension is the length of the state from which a run starts. The slices that a run passes
/// have these lengths: states and slopes that of the state, values that of [`Self::guards`]. So
/// nothing can have a wrong length, unless a system expects another dimension than that of its
/// start.
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

    /// The guards of `mode`: as many as it has, also none. Their number must be the same whenever
    /// the same mode is asked for.
    fn guards(&self, mode: Self::Mode) -> &[Guard];

    /// Writes the values of the guards of `mode` to `values`, which has the length of
    /// [`Self::guards`]. Values of guards that are [off](Guard::OFF) are ignored.
    fn guard_values(&self, mode: Self::Mode, s: f64, y: &[f64], values: &mut [f64]);

    /// Whether [`Self::enclose_guard`] bounds the guards.
    const READABLE: bool = false;

    /// The components that the guards read.
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

    /// As [`HybridSystem::schedule`](crate::HybridSystem::schedule).
    fn schedule(&self, _mode: Self::Mode, _guard: usize) -> Schedule<'_> {
        Schedule::NEVER
    }

    /// The mode in which the run goes on behind the place `s` at which its switches accumulate, if it
    /// does. The state `y` after the last switch, of `guard` into `mode`, is changed to that from
    /// which it goes on. The provided version lets the run end there.
    fn rest(
        &self,
        _mode: Self::Mode,
        _guard: usize,
        _s: f64,
        _y: &mut [f64],
    ) -> Option<Self::Mode> {
        None
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

    /// The components that the guards read. (To be found by the solver.)
    fn reads(&self, mode: Self::Mode) -> &[usize];

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

    /// As [`DynamicSystem::transition`].
    fn transition(&self, mode: Self::Mode, _guard: usize, _s: f64, _y: &mut [f64]) -> Self::Mode {
        mode
    }
}

impl<S: ReadableDynamic> DynamicSystem for S {
    type Mode = S::Mode;
    const READABLE: bool = true;

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
    fn schedule(&self, mode: S::Mode, guard: usize) -> Schedule<'_> {
        ReadableDynamic::schedule(self, mode, guard)
    }
    fn rest(&self, mode: S::Mode, guard: usize, s: f64, y: &mut [f64]) -> Option<S::Mode> {
        ReadableDynamic::rest(self, mode, guard, s, y)
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
