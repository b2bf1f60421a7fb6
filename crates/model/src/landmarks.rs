//! Landmarks of the (κ, ψ) plane without damping, in closed form.

use crate::contact::{Collision, Regime};
use crate::exact;

/// Duration of the contact, (4/5)(5/4)^{2/5} B(2/5, 1/2), in scaled time.
pub const CONTACT_TIME: f64 = exact::CONTACT_TIME;

/// The largest normal force, (5/4)^{3/5}, in scaled units: κ times the largest elongation of the spring.
pub const LARGEST_FORCE: f64 = 1.1432626298183158660;

/// The ψ from which on a collision with stiffness `kappa` slides without a switch.
///
/// It is 2, that is g_t/g_n = 2μ/α, for κ ≥ 0.5701023788; below, where the spring may stick before the sliding has
/// come to its end, it is ψ_g = 1 − cos q (1 − B sin^{2/5} q) with B = (3/(2κ))(5/4)^{1/5} and σ = sin^{1/5} q the larger
/// root of (7/5)Bσ¹⁰ − σ⁸ − (2/5)B in (0, 1), which rises as 1.0318/κ.
///
/// ```
/// use stickslip_model::{Contact, exact, landmarks};
///
/// assert_eq!(landmarks::pure_sliding(18.0), 2.0);
/// let psi = landmarks::pure_sliding(0.1);
/// assert!((psi - 10.4779732741472).abs() < 1e-12);
/// let switches = |psi| Ok::<_, Box<dyn std::error::Error>>(exact::collide(Contact::new(0.1, psi, 0.0)?)?.switches.len());
/// assert_eq!((switches(psi * (1.0 - 1e-12))?, switches(psi * (1.0 + 1e-12))?), (2, 0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn pure_sliding(kappa: f64) -> f64 {
    let bend = 1.5 / kappa * 1.25_f64.powf(0.2);
    let stationary = |sine: f64| 1.4 * bend * sine * sine - sine.powf(1.6) - 0.4 * bend;
    if stationary(1.0) <= 0.0 {
        return 2.0;
    }
    // From −(2/5)B at 0 it falls and then rises to the one zero before 1.
    let (mut low, mut high) = (0.0, 1.0);
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if stationary(middle) < 0.0 { low = middle } else { high = middle }
    }
    let graze = 1.0 - (1.0 - low * low).sqrt() * (1.0 - bend * low.powf(0.4));
    graze.max(2.0)
}

/// The stiffness κ_n = (nπ/(2t_c))² into which boundaries run as ψ → 0.
///
/// There the spring sticks during all of the contact but its ends, and swings through n quarter turns. Between κ_{2m} and
/// κ_{2m+1} two switches remain, between κ_{2m+1} and κ_{2m+2} four.
///
/// ```
/// let kappa = stickslip_model::landmarks::small_impact_stiffness(3);
/// assert!((kappa - 2.144334).abs() < 1e-6);
/// ```
#[must_use]
pub fn small_impact_stiffness(n: u32) -> f64 {
    let quarter_turns = f64::from(n) * std::f64::consts::FRAC_PI_2 / CONTACT_TIME;
    quarter_turns * quarter_turns
}

/// The largest |y| during `collision`; none with damping, whose largest force has no closed form.
///
/// While sliding the spring is at its limit, which is largest in the middle of the contact; while sticking it is longest where
/// the velocity vanishes.
///
/// ```
/// use stickslip_model::{Contact, exact, landmarks};
///
/// let collision = exact::collide(Contact::new(18.0, 1.5, 0.0)?)?;
/// let largest = landmarks::largest_spring(&collision).ok_or("damped")?;
/// assert!((18.0 * largest - landmarks::LARGEST_FORCE).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn largest_spring(collision: &Collision) -> Option<f64> {
    if collision.contact.damping() > 0.0 {
        return None;
    }
    let kappa = collision.contact.kappa();
    let middle = 0.5 * collision.contact_time;
    let mut largest = 0.0_f64;
    let (mut regime, mut since, mut start) = (collision.start, 0.0, None);
    let mut close = |regime, since: f64, start: Option<(f64, f64)>, time: f64, end: (f64, f64)| {
        let ends = start.map_or(0.0, |(spring, _): (f64, f64)| spring.abs()).max(end.0.abs());
        let inside = match (regime, start) {
            (Regime::Slip, _) if since <= middle && middle <= time => LARGEST_FORCE / kappa,
            (Regime::Stick, Some((spring, velocity))) => {
                let half_turn = kappa.sqrt() * (time - since) >= std::f64::consts::PI;
                if half_turn || (velocity < 0.0) != (end.1 < 0.0) {
                    spring.hypot(velocity / kappa.sqrt())
                } else {
                    0.0
                }
            }
            _ => 0.0,
        };
        largest = largest.max(ends).max(inside);
    };
    for switch in &collision.switches {
        let here = (switch.spring, switch.velocity);
        close(regime, since, start, switch.time, here);
        (regime, since, start) = (switch.to, switch.time, Some(here));
    }
    close(regime, since, start, collision.contact_time, (0.0, collision.final_velocity));
    Some(largest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Collider, Contact};

    #[test]
    fn the_largest_force_is_that_of_the_largest_compression() {
        assert_eq!(LARGEST_FORCE, 1.25_f64.powf(0.6));
    }

    /// κψ_g tends to (3/2)(5/4)^{1/5} √(5/7) (2/7)^{1/5} as κ falls.
    #[test]
    fn pure_sliding_rises_as_the_inverse_of_the_stiffness() {
        assert!((pure_sliding(0.3) - 3.6107667429891).abs() < 1e-12);
        assert!((1e-6 * pure_sliding(1e-6) - 1.03180041953648911535).abs() < 1e-14);
        let limit = 1.5 * 1.25_f64.powf(0.2) * (5.0_f64 / 7.0).sqrt() * (2.0_f64 / 7.0).powf(0.2);
        assert!((1e-12 * pure_sliding(1e-12) - limit).abs() < 1e-11);
        assert_eq!(pure_sliding(0.5701023788418933), 2.0);
        assert!(pure_sliding(0.5701023788418930) > 2.0 - 1e-15);
        assert!(pure_sliding(0.57) > 2.0);
    }

    #[test]
    fn below_the_mark_the_count_of_small_impacts_changes() {
        for n in 1..12 {
            let count = |factor: f64| {
                let contact = Contact::new(factor * small_impact_stiffness(n), 1e-7, 0.0).unwrap();
                exact::collide(contact).unwrap().switches.len()
            };
            let expected = if n % 2 == 1 { (2, 4) } else { (4, 2) };
            assert_eq!((count(1.0 - 1e-3), count(1.0 + 1e-3)), expected, "{n}");
        }
    }

    #[test]
    fn the_largest_elongation_is_that_of_the_course_in_time() {
        for (kappa, psi) in [(0.3, 0.5), (1.56, 1.0), (18.0, 0.3), (18.0, 0.8), (63.0, 0.1)] {
            let contact = Contact::new(kappa, psi, 0.0).unwrap();
            let largest = largest_spring(&exact::collide(contact).unwrap()).unwrap();
            let history = Collider::default().history(contact).unwrap();
            let springs = history.phases().flat_map(|phase| {
                phase.samples(2000).map(|moment| moment.spring.abs()).collect::<Vec<_>>()
            });
            let sampled = springs.fold(0.0, f64::max);
            // A sample misses a maximum by the square of its distance.
            assert!((largest / sampled - 1.0).abs() < 3e-6, "{kappa} {psi}: {largest} {sampled}");
        }
    }
}
