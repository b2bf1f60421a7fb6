//! The surfaces of two bodies.

use stickslip_contact::InvalidValue;

use super::quantity;

/// The properties of the two surfaces together.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Surface {
    /// Coulomb's coefficient of friction μ.
    pub friction: f64,
    /// Stiffness k_t of the tangential spring in kg/s².
    pub tangential_stiffness_kg_per_s2: f64,
    /// Damping time A in s in F_n = ρ(ξ^{3/2} + A √ξ ξ̇). Many papers write (3/2) A for this A.
    pub damping_time_s: f64,
}

impl Surface {
    /// Checks all quantities.
    ///
    /// # Errors
    /// [`InvalidValue`] names the first that is out of its range.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        quantity::FRICTION.check(self.friction)?;
        quantity::TANGENTIAL_STIFFNESS.check(self.tangential_stiffness_kg_per_s2)?;
        quantity::DAMPING_TIME.check(self.damping_time_s)?;
        Ok(())
    }
}
