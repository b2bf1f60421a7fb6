//! Normal restitution ε_n of damped spheres as a series and as a Padé approximant.
//!
//! [`Collision::eps_n`](crate::Collision::eps_n) is the integrated value. These formulas are
//! functions of the scaled damping a = A β^{2/5} g_n^{1/5}. The force is ρ(ξ^{3/2} + A √ξ ξ̇), and
//! the contact ends when the force returns to zero. **Many sources write (3/2)A for this A and
//! expand in (3/2)A β^{2/5} g_n^{1/5}.** That is the same a: the coefficients agree, and their A is
//! two thirds of this one.
//!
//! Sources: Schwager and Pöschel, Phys. Rev. E 57, 650 (1998) and 78, 051304 (2008); Ramírez et
//! al., Phys. Rev. E 60, 4465 (1999); Müller and Pöschel, Phys. Rev. E 84, 021302 (2011).

/// C₁ = (4/5)(5/4)^{3/5} B(3/5, 3/2), with B the beta function.
pub const C1: f64 = 1.153448858095288799;

/// Coefficients of a³ and a⁴ in the series, computed with 40 digits from the equations of motion
/// expanded in a.
const C3: f64 = -0.522882568088414964;
const C4: f64 = 0.348742675260385035;

/// ε_n to the order a^{9/2}. The error is below 0.34 a⁵ up to a = 1, where the series is useless.
///
/// A contact that lasts until ξ = 0 has ε_n = 1 − C₁a + (3/5)C₁²a² + C₃a³ + C₄a⁴. The earlier end
/// at F_n = 0 adds (4/15) a^{5/2} times the power 3/2 of that.
///
/// ```
/// assert!((stickslip_model::limits::normal::series(0.01) - 0.988547439643).abs() < 2e-11);
/// ```
pub fn series(damping: f64) -> f64 {
    let a = damping;
    let late_end = 1.0 + a * (-C1 + a * (0.6 * C1 * C1 + a * (C3 + a * C4)));
    // (1 − C₁a + (3/5)C₁²a²)^{3/2} to second order.
    let power = 1.0 + a * C1 * (-1.5 + a * 1.275 * C1);
    late_end + 4.0 / 15.0 * a * a * a.sqrt() * power
}

/// ε_n by the Padé approximant [1/4] in √a of Müller and Pöschel (2011), within 0.009 for every a.
///
/// Its coefficients follow from the series up to a^{5/2}: with d = √a,
/// (1 + b₁d)/(1 + b₁d + C₁d² + b₁C₁d³ + (2/5)C₁²d⁴), b₁ = 2/(3C₁²).
///
/// ```
/// assert!((stickslip_model::limits::normal::pade(0.2) - 0.800965).abs() < 3e-4);
/// ```
pub fn pade(damping: f64) -> f64 {
    let d = damping.sqrt();
    let b1 = 2.0 / (3.0 * C1 * C1);
    let denominator = 1.0 + d * (b1 + d * (C1 + d * (b1 * C1 + d * (0.4 * C1 * C1))));
    (1.0 + b1 * d) / denominator
}
