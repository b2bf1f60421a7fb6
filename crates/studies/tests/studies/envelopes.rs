//! Envelopes and bounds of the limit of stiff springs, compared with many full collisions.

use std::f64::consts::FRAC_PI_2;

use stickslip_model::exact::{self, ExactError};
use stickslip_model::limits::inner;
use stickslip_model::{Collision, Contact};
use stickslip_studies::StudyError;
use stickslip_studies::stiff_springs::limit::{
    BOUND_FACTOR, envelope, excess, largest_restitution,
};

fn collide(kappa: f64, psi: f64) -> Collision {
    exact::collide(Contact::new(kappa, psi, 0.0).unwrap()).unwrap()
}

#[test]
fn the_factor_is_the_largest_force() {
    assert!((BOUND_FACTOR - 1.25_f64.powf(0.6)).abs() < 1e-15);
}

#[test]
fn oscillations_are_equally_high_and_end_with_a_quarter_swing() {
    for kappa in [30.0, 1e3, 1e4, 1e6] {
        let reference = envelope(kappa, 1.0).unwrap();
        for psi in [0.3, 0.7, 1.3, 1.7, 1.99] {
            let found = envelope(kappa, psi).unwrap();
            assert!((found.velocity / reference.velocity - 1.0).abs() < 1e-15, "{kappa} {psi}");
            assert!((found.last_stick - FRAC_PI_2).abs() < 2e-8, "{kappa} {psi}: {found:?}");
            // It is the oscillation around ψ: no zero lies between.
            let between = (0..=50).map(|i| psi + (found.psi - psi) * f64::from(i) / 50.0);
            let side = |psi| collide(kappa, psi).final_velocity > 0.0;
            assert!(between.map(side).all(|above| above == side(psi)), "{kappa} {psi}");
        }
    }
}

#[test]
fn envelopes_tend_to_the_inner_problem() {
    let peak = inner::peak();
    for kappa in [1e2_f64, 1e3, 1e4, 1e5, 1e6] {
        let power = kappa.powf(-1.25);
        let scaled = envelope(kappa, 1.0).unwrap().velocity / power;
        let rest = scaled - peak.velocity - peak.correction * power;
        // Measured: 276 at 100, falling to 263.
        assert!(rest.abs() < 300.0 * power * power + 4e-15, "{kappa}: {}", rest / power / power);
    }
}

#[test]
fn restitutions_are_the_largest_of_their_range() {
    for (kappa, lowest) in
        [(3.0, 0.1), (3.0, 1.0), (10.0, 0.316), (10.0, 0.3), (300.0, 0.3), (1e4, 0.01), (1e4, 0.3)]
    {
        let best = largest_restitution(kappa, lowest).unwrap();
        let eps_t = best.velocity / best.psi;
        let sample = (0..10_000).map(|i| lowest + (2.0 - lowest) * f64::from(i) / 10_000.0);
        let seen = sample.map(|psi| collide(kappa, psi).eps_t().abs()).fold(0.0, f64::max);
        assert!(seen <= eps_t && seen > 0.98 * eps_t, "{kappa} {lowest}: {eps_t} {seen}");
    }
}

#[test]
fn the_printed_bound_is_exceeded_and_the_corrected_one_is_not() {
    let found = excess().unwrap();
    // The place of the kink by bisection of the itinerary at twelve κ, and a polynomial through
    // what is there.
    assert!((found.ratio - 1.11990925531666).abs() < 1e-12, "{found:?}");
    assert!(
        (found.worst.kappa - 1.5204226).abs() < 1e-6 && (found.worst.psi - 0.9996859).abs() < 1e-6
    );
    assert!(
        (found.kappa.0 - 1.190122603).abs() < 1e-8 && (found.kappa.1 - 2.941721294).abs() < 1e-8
    );
    // All collisions of the plane that have a switch.
    let mut largest = 0.0_f64;
    for i in 0..400 {
        let kappa = 0.05 * 1.03_f64.powi(i);
        for j in 1..400 {
            let collision = collide(kappa, 0.005 * f64::from(j));
            if !collision.switches.is_empty() {
                largest = largest.max(kappa.sqrt() * collision.final_velocity.abs());
            }
        }
    }
    assert!(largest <= found.ratio && largest > 0.99 * found.ratio, "{largest}");
    assert!(found.ratio < BOUND_FACTOR);
}

#[test]
fn parameters_are_checked() {
    for psi in [0.0, -1.0, 2.0, f64::NAN] {
        assert!(matches!(envelope(10.0, psi), Err(StudyError::Settings(_))), "{psi}");
        assert!(matches!(largest_restitution(10.0, psi), Err(StudyError::Settings(_))), "{psi}");
    }
    assert!(matches!(envelope(0.0, 1.0), Err(StudyError::Settings(_))));
    let stiff = envelope(2e16, 1.0).unwrap_err();
    assert!(matches!(stiff, StudyError::Exact(ExactError::Domain(_))), "{stiff}");
}
