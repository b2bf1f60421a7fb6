//! What the solver takes for a mode: a mode with the values that the variables have in it.

use std::collections::HashMap;

/// The regimes that a run has had, by their numbers.
pub struct Regimes {
    modes: Vec<usize>,
    /// The values of the variables, one row after another.
    values: Vec<f64>,
    /// The number of variables.
    width: usize,
    /// The numbers of regimes, by mode and bits of the values.
    numbers: HashMap<(usize, Vec<u64>), usize>,
}

impl Regimes {
    pub fn new(width: usize) -> Self {
        Self { modes: Vec::new(), values: Vec::new(), width, numbers: HashMap::new() }
    }

    /// The number of a mode with these values.
    pub fn number(&mut self, mode: usize, values: &[f64]) -> usize {
        let bits = values.iter().map(|value| value.to_bits()).collect();
        *self.numbers.entry((mode, bits)).or_insert_with(|| {
            self.modes.push(mode);
            self.values.extend_from_slice(values);
            self.modes.len() - 1
        })
    }

    pub fn mode(&self, regime: usize) -> usize {
        self.modes[regime]
    }

    pub fn values(&self, regime: usize) -> &[f64] {
        &self.values[regime * self.width..(regime + 1) * self.width]
    }
}
