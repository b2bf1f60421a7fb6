//! Every switch of the reference collisions, by the integrator and by the exact engine.
//!
//! Bounds are about twice the measured errors, except where the documentation promises a number.

use crate::common::{Case, cases, file, number};
use stickslip_model::{Collider, Collision, exact};
use stickslip_solver::{Dop853, Dopri5};

const UNDAMPED: [&str; 3] = ["undamped_paper", "undamped_random", "undamped_hard"];

/// The largest errors over a set of reference collisions.
#[derive(Debug, Default)]
struct Errors {
    velocity: f64,
    velocity_stiff: f64,
    time: f64,
    time_near_graze: f64,
    time_left: f64,
    time_left_near_graze: f64,
    contact_time: f64,
    eps_n: f64,
    unbalanced: f64,
}

/// The largest errors of `collide` over a whole set, in which every count and itinerary must be
/// right. `error_of_velocity` is the error that the engine may make in w.
fn errors(name: &str, error_of_velocity: f64, collide: impl Fn(&Case) -> Collision) -> Errors {
    let mut errors = Errors::default();
    for case in cases(name) {
        let collision = collide(&case);
        assert!(case.same_itinerary(&collision), "{name}, {:?}", case.contact);
        let error = (collision.final_velocity - case.number("w_final")).abs();
        let of_its_kind = if case.contact.kappa() > 400.0 {
            &mut errors.velocity_stiff
        } else {
            &mut errors.velocity
        };
        *of_its_kind = of_its_kind.max(error);
        errors.unbalanced = errors
            .unbalanced
            .max(collision.energy.tangential_unbalanced().abs())
            .max(collision.energy.normal_unbalanced().abs());
        if case.expected.get("contact_time").is_some() {
            let error = (collision.contact_time - case.number("contact_time")).abs();
            errors.contact_time = errors.contact_time.max(error);
            errors.eps_n = errors.eps_n.max((collision.eps_n - case.number("eps_n")).abs());
        }
        let grazes = case.expected["kind"].as_str().is_some_and(|kind| kind.ends_with("graze"));
        for (expected, switch) in case.switches().iter().zip(&collision.switches) {
            let error = (number(&expected["time"]) - switch.time).abs();
            let of_its_kind = if grazes { &mut errors.time_near_graze } else { &mut errors.time };
            *of_its_kind = of_its_kind.max(error);
            if let Some(time_left) = expected.get("time_left").map(number) {
                let relative = (switch.time_left / time_left - 1.0).abs();
                // Near the end time_left ≈ (2κw/3)²: with every method, an error δ of w becomes a
                // relative error 2δ/w.
                let of_velocity = 2.0 * error_of_velocity / number(&expected["w"]).abs();
                let of_its_kind =
                    if grazes { &mut errors.time_left_near_graze } else { &mut errors.time_left };
                *of_its_kind = of_its_kind.max(relative - of_velocity);
            }
        }
    }
    println!("{name}: {errors:?}");
    errors
}

#[test]
fn dop853_at_its_default_tolerance() {
    let collider = Collider::default();
    for name in UNDAMPED.into_iter().chain(["damped_random"]) {
        let errors =
            errors(name, 1e-12, |case| collider.collide(case.contact).expect("a collision"));
        assert!(errors.velocity <= 1e-12 && errors.velocity_stiff <= 2e-13, "{name}: {errors:?}");
        assert!(errors.time.max(errors.time_near_graze) <= 1e-11, "{name}: {errors:?}");
        assert!(errors.time_left.max(errors.time_left_near_graze) <= 1e-7, "{name}: {errors:?}");
        assert!(errors.contact_time <= 2e-12 && errors.eps_n <= 1e-12, "{name}: {errors:?}");
        assert!(errors.unbalanced <= 1e-12, "{name}: {errors:?}");
    }
}

#[test]
fn exact_engine() {
    for name in UNDAMPED {
        let errors = errors(name, 1e-15, |case| exact::collide(case.contact).expect("a collision"));
        assert!(errors.velocity <= 1e-15 && errors.velocity_stiff <= 1e-16, "{name}: {errors:?}");
        assert!(errors.time.max(errors.time_near_graze) <= 1e-11, "{name}: {errors:?}");
        assert!(errors.time_left <= 1e-11, "{name}: {errors:?}");
        assert!(errors.unbalanced <= 4e-15, "{name}: {errors:?}");
    }
}

#[test]
fn exact_engine_with_damping() {
    let errors =
        errors("damped_random", 1e-15, |case| exact::collide(case.contact).expect("a collision"));
    assert!(errors.velocity <= 1e-14 && errors.velocity_stiff <= 1e-14, "{errors:?}");
    assert!(errors.time.max(errors.time_left) <= 1e-13, "{errors:?}");
    assert!(errors.contact_time <= 1e-15 && errors.eps_n <= 1e-15, "{errors:?}");
    assert!(errors.unbalanced <= 4e-15, "{errors:?}");
}

#[test]
fn dopri5_at_1e_10() {
    let collider = Collider::with_tolerances(Dopri5, 1e-10, 1e-10);
    for name in ["undamped_paper", "undamped_random", "damped_random"] {
        let errors =
            errors(name, 1e-8, |case| collider.collide(case.contact).expect("a collision"));
        assert!(errors.velocity.max(errors.velocity_stiff) <= 1e-8, "{name}: {errors:?}");
        assert!(errors.time <= 7e-9, "{name}: {errors:?}");
    }
}

/// The error is proportional to the tolerance down to rounding, and smaller, from 1e-8 to 1e-14.
#[test]
fn the_error_falls_with_the_tolerance() {
    for exponent in 8..=14 {
        let tolerance = 0.1_f64.powi(exponent);
        let collider = Collider::with_tolerances(Dop853, tolerance, tolerance);
        let errors = errors("undamped_random", tolerance, |case| {
            collider.collide(case.contact).expect("a collision")
        });
        let largest = errors.velocity;
        assert!(largest <= tolerance + 4e-15, "{tolerance:e}: {largest:e}");
        assert!(largest >= 0.01 * tolerance, "{tolerance:e}: {largest:e}");
    }
}

/// The number of switches is right on both sides of every reference boundary.
#[test]
fn counts_across_the_boundaries() {
    let boundaries = file("boundaries");
    for boundary in boundaries["boundaries"].as_array().expect("an array") {
        let (kappa, psi) = (number(&boundary["kappa"]), number(&boundary["psi"]));
        for (factor, key) in [(1.0 - 1e-11, "below"), (1.0 + 1e-11, "above")] {
            let contact = stickslip_model::Contact::new(kappa, psi * factor, 0.0).expect("valid");
            let count = boundary[key].as_u64();
            let integrated = Collider::with_tolerances(Dop853, 1e-15, 1e-15).collide(contact);
            assert_eq!(integrated.map(|c| c.switches.len() as u64).ok(), count, "{boundary}");
            let exact = exact::collide(contact).map(|c| c.switches.len() as u64);
            assert_eq!(exact.ok(), count, "{boundary}");
        }
    }
}
