//! Ranges of parameters for which an engine computes collisions, and the error for all others.

use crate::contact::Contact;

/// A contact is out of the range of an engine.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{quantity} = {value:?} is out of the range of {engine}; expected {least:e} to {most:e}")]
pub struct OutOfDomain {
    /// The engine in words.
    pub engine: &'static str,
    /// The quantity that is out of its range.
    pub quantity: &'static str,
    /// The value of the quantity.
    pub value: f64,
    /// The least value of the range.
    pub least: f64,
    /// The largest value of the range.
    pub most: f64,
}

/// The ranges of one engine, with both ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Domain {
    /// The engine in words.
    pub engine: &'static str,
    /// Range of κ.
    pub kappa: (f64, f64),
    /// Range of ψ.
    pub psi: (f64, f64),
    /// Range of κψ, which decides the spring's force at the first switch and at the end.
    pub pull: (f64, f64),
    /// Range of the damping.
    pub damping: (f64, f64),
}

impl Domain {
    /// Checks that `contact` is in these ranges.
    ///
    /// # Errors
    /// [`OutOfDomain`] names the first quantity that is not.
    pub fn check(&self, contact: &Contact) -> Result<(), OutOfDomain> {
        let (kappa, psi) = (contact.kappa(), contact.psi());
        // Without a spring κ has no effect.
        let any = (f64::NEG_INFINITY, f64::INFINITY);
        let of_spring = |range| if contact.law().remembers() { range } else { any };
        [
            ("kappa", kappa, of_spring(self.kappa)),
            ("psi", psi, self.psi),
            ("kappa·psi", kappa * psi, of_spring(self.pull)),
            ("damping", contact.damping(), self.damping),
        ]
        .into_iter()
        .find(|(_, value, (least, most))| !(least..=most).contains(&value))
        .map_or(Ok(()), |(quantity, value, (least, most))| {
            Err(OutOfDomain { engine: self.engine, quantity, value, least, most })
        })
    }
}
