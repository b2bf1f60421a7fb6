//! Results that are beyond the range of doubles.

use super::{Collision, EnergyLedger};

/// A result is beyond the range of doubles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{name} is not a finite number")]
pub struct NotFinite {
    /// The name of the result.
    pub name: &'static str,
}

impl NotFinite {
    /// Refuses results, given with their names, of which one is not a finite number.
    ///
    /// # Errors
    /// [`NotFinite`] names the first.
    pub fn among(values: impl IntoIterator<Item = (&'static str, f64)>) -> Result<(), Self> {
        match values.into_iter().find(|(_, value)| !value.is_finite()) {
            Some((name, _)) => Err(Self { name }),
            None => Ok(()),
        }
    }
}

impl Collision {
    /// Refuses a collision with a result that is not a finite number; energies do not count.
    ///
    /// # Errors
    /// [`NotFinite`] names the first.
    pub fn require_finite(&self) -> Result<(), NotFinite> {
        let results = [
            ("eps_n", self.eps_n),
            ("eps_t", self.eps_t()),
            ("w_final", self.final_velocity),
            ("contact_time", self.contact_time),
        ];
        let switches = self.switches.iter().flat_map(|switch| {
            [
                ("the time of a switch", switch.time),
                ("the time left at a switch", switch.time_left),
                ("the spring at a switch", switch.spring),
                ("the velocity at a switch", switch.velocity),
            ]
        });
        NotFinite::among(results.into_iter().chain(switches))
    }
}

impl EnergyLedger {
    /// Refuses a ledger with an entry that is not a finite number.
    ///
    /// # Errors
    /// [`NotFinite`] names the first.
    pub fn require_finite(&self) -> Result<(), NotFinite> {
        NotFinite::among([
            ("tangential_initial", self.tangential_initial),
            ("tangential_final", self.tangential_final),
            ("sliding", self.sliding),
            ("spring_left", self.spring_left),
            ("normal_initial", self.normal_initial),
            ("normal_final", self.normal_final),
            ("damping", self.damping),
            ("compression_left", self.compression_left),
        ])
    }
}
