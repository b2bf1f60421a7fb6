//! What a user writes: a system whose dimension is known at run time.

use std::fmt;

use crate::hybrid::Guard;

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

    /// Changes the state `y` on `guard` of `mode` to the one that follows when the guard fires, and
    /// returns the mode that follows.
    ///
    /// The provided version changes nothing. It is for guards that end the run, and for guards that
    /// only report a crossing. A run may call this function more than once for an event.
    fn transition(&self, mode: Self::Mode, _guard: usize, _s: f64, _y: &mut [f64]) -> Self::Mode {
        mode
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

/// A guard of a mode as a function of time and state, with a sign.
#[derive(Clone, Copy)]
pub(crate) struct SignedGuard<'a, S: DynamicSystem> {
    pub(crate) system: &'a S,
    pub(crate) mode: S::Mode,
    pub(crate) guard: usize,
    pub(crate) sign: f64,
}

impl<S: DynamicSystem> SignedGuard<'_, S> {
    /// The guard's value. All `values` are written.
    pub(crate) fn value(&self, s: f64, y: &[f64], values: &mut [f64]) -> f64 {
        self.system.guard_values(self.mode, s, y, values);
        self.sign * values[self.guard]
    }
}
