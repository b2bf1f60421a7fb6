//! Observed orders in fixed steps, through all switches of a collision.
//!
//! In the regularised coordinates both methods keep their order. In plain time the contact law
//! lowers it, and without located switches the order of the method does not matter. [`fit_order`]
//! chooses the steps.

use stickslip_model::{Collision, Contact};
use stickslip_plane::progress::SILENT;
use stickslip_solver::method::{Order, fit_order};
use stickslip_solver::{EmbeddedPair, Options, StepSize};
use stickslip_studies::convergence::{
    self, ConvergenceSettings, Formulation, LocationSettings, measure, reference,
};

/// Collisions with two to eight switches, three to seven with damping.
fn references(damping: f64) -> Vec<Collision> {
    let contacts = [18.0, 63.0].map(|kappa| {
        (1..20).map(move |i| Contact::new(kappa, 0.1 * f64::from(i), damping).expect("valid"))
    });
    contacts.into_iter().flatten().map(|contact| reference(contact).expect("a reference")).collect()
}

fn located(h: f64) -> LocationSettings {
    let options = Options { step_size: StepSize::Fixed(h), ..Options::default() };
    LocationSettings::Located { options }
}

fn at_step_ends(step_size: f64) -> LocationSettings {
    LocationSettings::AtStepEnds { step_size, max_steps: 1_000_000 }
}

/// The orders of the final velocity and of the switch times over steps from 1/4 down by `octaves`
/// octaves.
fn orders(
    pair: EmbeddedPair,
    damping: f64,
    coordinates: Formulation,
    (switching, octaves): (fn(f64) -> LocationSettings, i32),
) -> [Order; 2] {
    let references = references(damping);
    let steps = (0..=4 * octaves).map(|i| 0.25 * 0.5_f64.powf(f64::from(i) / 4.0));
    let (mut velocities, mut times) = (Vec::new(), Vec::new());
    for h in steps {
        let errors = measure(pair, &references, coordinates, &switching(h));
        let or_nan = |error| if errors.comparable() { error } else { f64::NAN };
        velocities.push((h, or_nan(errors.velocity.root_mean_square)));
        times.push((h, or_nan(errors.switch_time.root_mean_square)));
    }
    [velocities, times].map(|errors| {
        let order = fit_order(&errors, 4.0).expect("a range");
        println!("{pair}, {coordinates:?}: {order:?}");
        order
    })
}

fn assert_orders(found: [Order; 2], expected: [f64; 2], within: f64) {
    for (found, expected) in found.iter().zip(expected) {
        assert!((found.order - expected).abs() < within, "{found:?}");
        assert!(found.standard_error < 0.1, "{found:?}");
    }
}

#[test]
fn regularised_coordinates_keep_the_order() {
    use Formulation::Regularized;
    for damping in [0.0, 0.1] {
        // 5.033 ± 0.002, 5.016 ± 0.001; 5.039 ± 0.003, 5.031 ± 0.003
        assert_orders(
            orders(EmbeddedPair::Dopri5, damping, Regularized, (located, 10)),
            [5.0; 2],
            0.1,
        );
        // 7.830 ± 0.019, 7.932 ± 0.007; 7.818 ± 0.024, 7.914 ± 0.012
        assert_orders(
            orders(EmbeddedPair::Dop853, damping, Regularized, (located, 6)),
            [8.0; 2],
            0.2,
        );
    }
}

#[test]
fn plain_time_loses_it() {
    // 2.532 ± 0.018, 2.501 ± 0.000; 2.487 ± 0.007, 2.500 ± 0.000
    let found = orders(EmbeddedPair::Dopri5, 0.0, Formulation::PlainTime, (located, 10));
    assert_orders(found, [2.5; 2], 0.1);
    let found = orders(EmbeddedPair::Dop853, 0.0, Formulation::PlainTime, (located, 9));
    assert_orders(found, [2.5; 2], 0.1);
}

/// Contact then starts with a force like √t, and the steps must be shorter than the stick phase
/// with which it starts.
#[test]
fn damping_in_plain_time_takes_away_another_order() {
    let reference = [reference(Contact::new(18.0, 0.1, 1.0).expect("valid")).expect("a reference")];
    let steps = (0..40).map(|i| 0.02 * 0.5_f64.powf(f64::from(i) / 4.0));
    let errors = steps.map(|h| {
        let errors = measure(EmbeddedPair::Dop853, &reference, Formulation::PlainTime, &located(h));
        assert!(errors.comparable(), "{h}");
        (h, errors.velocity.root_mean_square)
    });
    let order = fit_order(&errors.collect::<Vec<_>>(), 4.0).expect("a range");
    println!("{order:?}");
    assert!((order.order - 1.5).abs() < 0.01, "{order:?}");
}

#[test]
fn steps_over_switches_leave_order_two_of_the_velocity_and_one_of_the_times() {
    for coordinates in [Formulation::Regularized, Formulation::PlainTime] {
        // 1.99 ± 0.03, 1.00 ± 0.01; 2.09 ± 0.04, 1.02 ± 0.01
        let found = orders(EmbeddedPair::Dopri5, 0.0, coordinates, (at_step_ends, 10));
        assert_orders(found, [2.0, 1.0], 0.15);
        let better = orders(EmbeddedPair::Dop853, 0.0, coordinates, (at_step_ends, 10));
        for (found, better) in found.iter().zip(better) {
            assert!((found.order - better.order).abs() < 1e-3, "{found:?} {better:?}");
        }
    }
}

#[test]
fn a_study_of_nothing_is_refused() {
    let error =
        convergence::run(&ConvergenceSettings { contacts: Vec::new() }, SILENT).unwrap_err();
    assert_eq!(error.to_string(), "a study of 0 collisions; expected at least one");
    let stiff = Contact::new(2e6, 1.0, 0.0).unwrap();
    let error =
        convergence::run(&ConvergenceSettings { contacts: vec![stiff] }, SILENT).unwrap_err();
    assert!(error.to_string().contains("at most 1000000.0"), "{error}");
}
