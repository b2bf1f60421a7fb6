//! The result of examining a step: the guard that fires, or none.

use crate::method::{StepOf, Store};
use crate::system::{PerGuard, System};

/// A guard fires on a step.
#[derive(Clone, Debug)]
pub(crate) struct Event<V: Store> {
    pub(crate) guard: usize,
    /// Further guards that are zero where the step ends, one bit each.
    pub(crate) simultaneous: u64,
    /// The absolute slope of the guard where it fires.
    pub(crate) slope: f64,
    /// The time from the start of the step to the event.
    pub(crate) elapsed: f64,
    /// The state on the guard.
    pub(crate) state: V,
    /// The absolute value of the guard at that state, which is zero up to rounding.
    pub(crate) residual: f64,
    /// The sign of the guard before it fired.
    pub(crate) sign: f64,
    /// The time from the start of the step to a place behind the event, up to which the guard does
    /// not cross zero again.
    pub(crate) beyond: f64,
    /// Whether the guard jumps over zero.
    pub(crate) jump: bool,
    /// The step that ends at the event.
    pub(crate) step: StepOf<V>,
}

/// The bit of a guard in a mask, or 0 for guards beyond the 64 that a mask can hold.
pub(crate) fn bit(guard: usize) -> u64 {
    if guard < 64 { 1 << guard } else { 0 }
}

/// The result of examining a step.
pub(crate) enum Found<S: System> {
    /// No guard fires. These are the values of the guards at the end of the step.
    Nothing(PerGuard<S, f64>),
    /// A guard fires. The event has been written to the place that was passed for it.
    Event,
    /// This guard is not resolved, so that a shorter step is needed.
    TooCoarse(usize),
}
