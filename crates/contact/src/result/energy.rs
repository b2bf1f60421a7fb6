//! The energy ledger of a collision.

use super::NotFinite;

/// The energy ledger of a collision, in reduced variables: where its energy went.
///
/// Normal motion and tangential motion exchange no energy; each has entries of its own. Normal
/// energies are in units of m g_n² (½ at impact), tangential ones in units of α m g_n² (μ/α)² (ψ²/2
/// at impact).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct EnergyLedger {
    /// Tangential energy at impact, ψ²/2.
    pub tangential_initial: f64,
    /// Tangential kinetic energy at the end, w²/2.
    pub tangential_final: f64,
    /// Tangential energy taken by Coulomb sliding, ∫ F (s w − dL/dt) dt over all slip phases. In
    /// other laws than the paper's, where what the spring holds is not always finite: the kinetic
    /// energy lost in slip, ∫ |F| s w dt, to friction.
    pub sliding: f64,
    /// Tangential energy taken by the dashpot in stick, ∫ b η w² dt; 0 in the paper's law. In slip
    /// all is taken by friction.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "is_zero"))]
    pub tangential_damping: f64,
    /// Tangential energy left in the spring at the end, κ y²/2. In other laws than the paper's: the
    /// kinetic energy lost in stick to the spring; part of it comes back in slip.
    pub spring_left: f64,
    /// Normal energy at impact, ½.
    pub normal_initial: f64,
    /// Normal kinetic energy at the end, ε_n²/2.
    pub normal_final: f64,
    /// Normal energy taken by damping, ∫ a √x ẋ² dt, or by hysteresis, also that of pull-off.
    pub damping: f64,
    /// Normal energy left in the compression at the end, (2/5) x^{5/2}; 0 without damping. Of
    /// bodies that stay together: what it is beyond that where they touched.
    pub compression_left: f64,
}

#[cfg(feature = "serde")]
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

impl EnergyLedger {
    /// Tangential energy that the ledger does not explain.
    pub fn tangential_unbalanced(&self) -> f64 {
        self.tangential_initial
            - self.tangential_final
            - self.sliding
            - self.tangential_damping
            - self.spring_left
    }

    /// Normal energy that the ledger does not explain.
    pub fn normal_unbalanced(&self) -> f64 {
        self.normal_initial - self.normal_final - self.damping - self.compression_left
    }

    /// Checks that all entries are finite numbers.
    ///
    /// # Errors
    /// [`NotFinite`] names the first that is not.
    pub fn require_finite(&self) -> Result<(), NotFinite> {
        NotFinite::among([
            ("tangential_initial", self.tangential_initial),
            ("tangential_final", self.tangential_final),
            ("sliding", self.sliding),
            ("tangential_damping", self.tangential_damping),
            ("spring_left", self.spring_left),
            ("normal_initial", self.normal_initial),
            ("normal_final", self.normal_final),
            ("damping", self.damping),
            ("compression_left", self.compression_left),
        ])
    }
}
