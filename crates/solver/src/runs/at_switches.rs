//! A function that is called at every switch.

use crate::events::Note;
use crate::runs::runner::Watcher;
use crate::system::System;

/// Calls a function at every switch. The function says whether the run stops there.
pub(crate) struct AtSwitches<F> {
    stops: bool,
    at_switch: F,
}

impl<F> AtSwitches<F> {
    /// A run that `stops` does so after its first step.
    pub(crate) fn new<S: System>(stops: bool, at_switch: F) -> Self
    where
        F: FnMut(&Note<S>) -> bool,
    {
        Self { stops, at_switch }
    }
}

impl<S: System, F: FnMut(&Note<S>) -> bool> Watcher<S> for AtSwitches<F> {
    const WANTS_SEGMENTS: bool = false;

    fn on_switch(&mut self, event: &Note<S>) {
        self.stops |= (self.at_switch)(event);
    }
    fn stops(&self, _: f64) -> bool {
        self.stops
    }
}
