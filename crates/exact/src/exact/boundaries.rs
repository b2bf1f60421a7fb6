//! Boundaries on which the number of switches changes, as far as they have closed forms.

use super::normal::undamped::{CONTACT_TIME, Undamped};
use super::slide::Slide;

/// The largest ψ with a switch at stiffness `kappa` > 0, without damping. Above it the whole
/// contact is sliding, and ε_t = 1 − 2/ψ.
///
/// It is max(2, ψ_g). At ψ = 2 sliding ends with w = 0 at the end of contact. At ψ_g the spring
/// almost sticks in the compression: ψ_g = 1 − v(1 − B (1 − v²)^{1/5}) with B = (3/(2κ))(5/4)^{1/5}
/// and the v at which this is stationary. The boundary is exactly 2, g_t/g_n = 2μ/α, for κ ≥
/// 0.57010237884189. For κ → 0 it grows as (3/2)(5/14)^{1/5}(5/7)^{1/2}/κ = 1.03180026469/κ. The
/// relative error is below 3e-14.
///
/// ```
/// use stickslip_contact::Contact;
/// use stickslip_exact::exact;
///
/// let top = exact::top_boundary(0.3);
/// let above = exact::collide(Contact::new(0.3, top * (1.0 + 1e-13), 0.0)?)?;
/// let below = exact::collide(Contact::new(0.3, top * (1.0 - 1e-13), 0.0)?)?;
/// assert_eq!((above.switches.len(), below.switches.len()), (0, 2));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn top_boundary(kappa: f64) -> f64 {
    Slide::new(&Undamped, kappa).highest().map_or(2.0, |height| height.max(2.0))
}

/// κ_n = (nπ/(2 t_c))², at which the `n`-th boundary ends as ψ → 0, without damping.
///
/// Almost all of such a contact is stick, and the spring swings through n quarters of its period.
/// For odd n a switch coincides with the end of contact; for even n the spring touches its limit.
/// As ψ → 0 there are two switches below κ₁ and between κ_{2m} and κ_{2m+1}, and four elsewhere.
///
/// ```
/// use stickslip_exact::exact;
///
/// assert!((exact::small_impact_boundary(4) - 3.812150).abs() < 1e-6);
/// ```
pub fn small_impact_boundary(n: u32) -> f64 {
    (f64::from(n) * std::f64::consts::PI / (2.0 * CONTACT_TIME)).powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::collide;
    use stickslip_contact::Contact;

    fn switches(kappa: f64, psi: f64) -> usize {
        collide(Contact::new(kappa, psi, 0.0).unwrap()).unwrap().switches.len()
    }

    #[test]
    fn the_top_boundary_has_the_digits_of_independent_programs() {
        for (kappa, expected) in [(0.1, 10.4779732741472), (0.3, 3.6107667429891)] {
            assert!((top_boundary(kappa) / expected - 1.0).abs() < 3e-14, "{kappa}");
        }
        // At the corner ψ_g passes 2.
        let corner = 0.5701023788418932873;
        assert_eq!(top_boundary(corner * (1.0 + 1e-14)), 2.0);
        let slope = (top_boundary(corner * (1.0 - 1e-9)) - 2.0) / 1e-9;
        assert!((1.0..3.0).contains(&slope), "{slope}");
        assert_eq!(top_boundary(1e4), 2.0);
        // κψ_g → (3/2)(5/14)^{1/5}(5/7)^{1/2}, from above as 0.155 κ.
        let limit = 1.5 * (5.0_f64 / 14.0).powf(0.2) * (5.0_f64 / 7.0).sqrt();
        assert!((1e-14 * top_boundary(1e-14) / limit - 1.0).abs() < 1e-13);
    }

    #[test]
    fn above_the_top_boundary_there_is_no_switch() {
        for i in 0..400 {
            let kappa = 1e-4 * 1.05_f64.powi(i);
            let top = top_boundary(kappa);
            assert_eq!(switches(kappa, top * (1.0 + 1e-13)), 0, "{kappa}");
            assert_eq!(switches(kappa, top * (1.0 - 1e-13)), 2, "{kappa}");
        }
    }

    #[test]
    fn small_impacts_have_two_and_four_switches_in_turn() {
        for (n, expected) in [(1, 0.238259), (2, 0.953038), (3, 2.144334), (4, 3.812150)] {
            assert!((small_impact_boundary(n) - expected).abs() < 5e-7, "{n}");
        }
        for n in 1..40 {
            // The boundaries bend towards larger κ; far from them this ψ is small enough.
            let middle = small_impact_boundary(n).midpoint(small_impact_boundary(n + 1));
            assert_eq!(switches(middle, 1e-9), if n % 2 == 0 { 2 } else { 4 }, "{n}");
        }
        assert_eq!(switches(0.5 * small_impact_boundary(1), 1e-9), 2);
    }
}
