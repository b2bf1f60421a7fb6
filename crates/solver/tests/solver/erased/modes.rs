//! Modes of any type as numbers.

use std::cell::RefCell;

use stickslip_solver::{Grazing, hybrid::Pole};

/// The modes that a run has had, in the order of their first use.
pub struct Modes<Mode>(RefCell<Vec<Mode>>);

impl<Mode> Default for Modes<Mode> {
    fn default() -> Self {
        Self(RefCell::default())
    }
}

impl<Mode: Copy + PartialEq> Modes<Mode> {
    /// The number of a mode.
    pub fn number(&self, mode: Mode) -> usize {
        let mut seen = self.0.borrow_mut();
        seen.iter().rposition(|one| *one == mode).unwrap_or_else(|| {
            seen.push(mode);
            seen.len() - 1
        })
    }

    /// The mode with a number.
    pub fn mode(&self, number: usize) -> Mode {
        self.0.borrow()[number]
    }

    pub fn grazing(&self, grazing: &Grazing<usize>) -> Grazing<Mode> {
        let Grazing { s, mode, guard, margin } = *grazing;
        Grazing { s, mode: self.mode(mode), guard, margin }
    }

    pub fn pole(&self, pole: &Pole<usize>) -> Pole<Mode> {
        let Pole { s, mode, guard } = *pole;
        Pole { s, mode: self.mode(mode), guard }
    }
}
