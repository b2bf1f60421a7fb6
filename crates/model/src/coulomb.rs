//! Tangential restitution without a spring: the laws to which the collision is compared.
//!
//! Source: Schwager, Becker and Pöschel, Eur. Phys. J. E 27, 107 (2008), equations (15), (16) and the end of section 4.

/// ε_t of pure Coulomb sliding, max(0, 1 − (1 + ε_n)/ψ), which is max(0, 1 − μ(1 + ε_n)/α · g_n/g_t).
///
/// It holds for every law of the normal force; sliding that comes to rest stays at rest.
///
/// ```
/// use stickslip_model::coulomb;
///
/// assert_eq!(coulomb::restitution(4.0, 1.0), 0.5);
/// assert_eq!(coulomb::restitution(1.0, 1.0), 0.0);
/// ```
#[must_use]
pub fn restitution(psi: f64, eps_n: f64) -> f64 {
    pragmatic(psi, eps_n, 0.0)
}

/// ε_t of the pragmatic model max(`floor`, 1 − (1 + ε_n)/ψ), in which a constant stands for all that is not sliding.
///
/// ```
/// use stickslip_model::coulomb;
///
/// assert_eq!(coulomb::pragmatic(1.0, 1.0, -0.2), -0.2);
/// ```
#[must_use]
pub fn pragmatic(psi: f64, eps_n: f64, floor: f64) -> f64 {
    (1.0 - (1.0 + eps_n) / psi).max(floor)
}
