//! What a step brings: the guard that fires, or none.

use crate::method::{State, Step};

/// A guard fires on a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Event<const N: usize> {
    pub(crate) guard: usize,
    pub(crate) simultaneous: u32,
    /// Guards that crossed as well, at the same place or a hair before, and gave way to this one.
    pub(crate) passed: u32,
    /// Absolute slope of the guard there.
    pub(crate) slope: f64,
    /// From the start of the step.
    pub(crate) elapsed: f64,
    /// The state on the guard.
    pub(crate) state: State<N>,
    /// What is left of the guard's value there.
    pub(crate) residual: f64,
    /// The sign of the guard before it fired.
    pub(crate) sign: f64,
    /// The step that ends there.
    pub(crate) step: Step<N>,
}

impl<const N: usize> Event<N> {
    pub(crate) fn pass(&mut self, guard: usize) {
        self.passed |= bit(guard);
    }

    pub(crate) fn has_passed(&self, guard: usize) -> bool {
        self.passed & bit(guard) != 0
    }
}

/// 0 for guards that are too many to be told apart.
pub(crate) fn bit(guard: usize) -> u32 {
    if guard < 32 { 1 << guard } else { 0 }
}

/// The result of examining a step.
pub(crate) enum Found<const G: usize> {
    /// No guard fires; their values at the step's end.
    Nothing([f64; G]),
    /// A guard fires; the event is in its place.
    Event,
    /// This guard is not resolved: a shorter step is needed.
    TooCoarse(usize),
}
