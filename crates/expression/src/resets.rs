//! What a rule makes of the state.

use std::sync::Arc;

use smallvec::SmallVec;

use crate::program::Program;

/// New values of components.
#[derive(Clone, Debug)]
pub(crate) struct Resets {
    pub(crate) changed: Arc<[usize]>,
    pub(crate) values: Program,
}

impl Resets {
    pub(crate) fn apply(&self, s: f64, y: &mut [f64]) {
        let mut values: SmallVec<[f64; 16]> = SmallVec::from_elem(0.0, self.changed.len());
        self.values.run(s, y, &mut values);
        for (&component, value) in self.changed.iter().zip(values) {
            y[component] = value;
        }
    }
}
