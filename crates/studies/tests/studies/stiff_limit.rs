//! The limit of stiff springs: full collisions against the inner problem and against 40-digit
//! references.

use stickslip_model::limits::inner;
use stickslip_model::{Contact, exact};
use stickslip_studies::stiff_springs::limit;

/// F, computed with 50 digits in mpmath as the largest final velocity of the map of onsets, its
/// derivative solved for 0 by secants; the closed form is not used.
const CONSTANT: f64 = 4.4848423519475425884;

/// κ^{5/4} times the largest |w_final| at κ.
fn scaled(kappa: f64, psi: f64) -> f64 {
    limit::envelope(kappa, psi).unwrap().velocity * kappa.powf(1.25)
}

#[test]
fn the_velocity_falls_with_the_power_of_five_quarters() {
    for psi in [0.3, 1.0, 1.7] {
        let velocity = |kappa| limit::envelope(kappa, psi).unwrap().velocity;
        for kappa in [1e4, 1e5, 1e6, 1e7] {
            let exponent = (velocity(kappa) / velocity(10.0 * kappa)).log10();
            // F₁ κ^{−5/4}/F on a decade; measured: 2.5e-5, 1.4e-6, 7.9e-8, 4.5e-9.
            let tolerance = 5e-5 * (kappa / 1e4).powf(-1.25);
            assert!((exponent - 1.25).abs() < tolerance, "{kappa} {psi}: {exponent}");
        }
    }
}

#[test]
fn full_collisions_and_the_inner_problem_have_the_same_constant() {
    let peak = inner::peak();
    assert!((peak.velocity - CONSTANT).abs() < 1e-14, "{}", peak.velocity);
    for psi in [0.3, 1.0, 1.7] {
        // Two stiffnesses give the constant and the coefficient of κ^{−5/4}.
        let [soft, stiff]: [f64; 2] = [1e4, 1e6];
        let [a, b] = [soft, stiff].map(|kappa| kappa.powf(-1.25));
        let (at_soft, at_stiff) = (scaled(soft, psi), scaled(stiff, psi));
        let correction = (at_soft - at_stiff) / (a - b);
        let constant = at_stiff - correction * b;
        // Measured: 8.4e-11, which is the next order, and 2.6e-3.
        assert!((constant - CONSTANT).abs() < 2e-10, "{psi}: {constant}");
        assert!((correction - peak.correction).abs() < 6e-3, "{psi}: {correction}");
        // At κ = 1e8 the next order is 3e-18: the rest is the exact engine's error.
        let rest = scaled(1e8, psi) - peak.velocity - peak.correction * 1e-10;
        assert!(rest.abs() < 1e-13, "{psi}: {rest}");
    }
}

/// κ, ψ, number of switches, w_final, √κ·(time left) at the last onset; computed with 40 digits
/// from the closed form, in the angle q of v = −cos q, every root by Newton's method.
const REFERENCES: [(f64, f64, usize, f64, f64); 5] = [
    (1e4, 1.3, 84, 0.000036789826920423817368, 2.3847238648142821695),
    (1e6, 1.3, 852, 1.4168454146507563223e-7, 3.6532480198181226644),
    (1e8, 1.3, 8540, 1.7958885247189574527e-10, 1.0175932090994335157),
    (1e8, 1.00001, 10242, -1.1423203361360500194e-10, 0.52126514816806298682),
    // The top of an oscillation.
    (1e8, 1.699900956529854, 5830, -4.4848423492602077538e-10, 3.5743058496363252182),
];

#[test]
fn the_exact_engine_is_right_where_springs_are_stiff() {
    for (kappa, psi, count, velocity, onset) in REFERENCES {
        let collision = exact::collide(Contact::new(kappa, psi, 0.0).unwrap()).unwrap();
        assert_eq!(collision.switches.len(), count, "{kappa} {psi}");
        let last = kappa.sqrt() * collision.switches[count - 2].time_left;
        // Rounding of √κ t; measured: up to 1.0e-10 and 1.3e-10 at κ = 1e8, and 1e-14 of w at the
        // top of an oscillation.
        let tolerance = 3e-14 * kappa.sqrt();
        assert!((last / onset - 1.0).abs() < tolerance, "{kappa} {psi}: {last}");
        let off = (collision.final_velocity / velocity - 1.0).abs();
        assert!(off < tolerance, "{kappa} {psi}: {off:e}");
    }
}
