//! A guard that fires on a dynamic step.

use crate::dynamic::results::DynamicEvent;

/// A guard fires on a step. The fields are those of [`crate::events::Event`].
#[derive(Clone, Debug)]
pub(crate) struct Event {
    pub(crate) guard: usize,
    pub(crate) simultaneous: Vec<usize>,
    pub(crate) slope: f64,
    pub(crate) elapsed: f64,
    pub(crate) state: Vec<f64>,
    pub(crate) residual: f64,
    pub(crate) sign: f64,
    pub(crate) beyond: f64,
    pub(crate) jump: bool,
}

impl Event {
    /// The event with the guards of another one, which fires together with it.
    pub(crate) fn together_with(mut self, other: &Self) -> Self {
        let others = other.simultaneous.iter().copied().chain([other.guard]);
        self.simultaneous.extend(others);
        self.simultaneous.sort_unstable();
        self
    }

    /// The guard's `largest` value in the phase over its slope.
    pub(crate) fn flatness(&self, largest: f64) -> f64 {
        // A guard that has always been zero has no size.
        if largest == 0.0 { 0.0 } else { largest / self.slope }
    }

    /// The event as an observer sees it.
    pub(crate) fn shown<'a, Mode: Copy>(
        &'a self,
        s: f64,
        largest: f64,
        (from, to): (Mode, Mode),
        after: &'a [f64],
    ) -> DynamicEvent<'a, Mode> {
        DynamicEvent {
            s,
            guard: self.guard,
            simultaneous: &self.simultaneous,
            flatness: self.flatness(largest),
            jump: self.jump,
            from,
            to,
            before: &self.state,
            after,
        }
    }
}

/// The result of examining a step.
pub(crate) enum Found {
    /// No guard that changes something fires. The values at the end are in [`Tables::ends`].
    Nothing,
    /// This guard fires.
    Event(Event),
    /// This guard is not resolved, so that a shorter step is needed. If another guard fires before
    /// the end of the step, a step to that place is enough.
    TooCoarse(usize, Option<f64>),
}
