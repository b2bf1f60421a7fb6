//! One collision, integrated in ways that keep accuracy or lose it.

use stickslip_model::{Collider, CollisionError, Contact, Damping, Law, Normal};
use stickslip_solver::{Dopri5, EmbeddedPair, Options, StepSize};
use stickslip_studies::StudyError;
use stickslip_studies::convergence::{
    ConvergenceSettings, Formulation, LocationSettings, integrate, measure, reference,
};

const FIXED: Options = Options {
    rtol: 1e-10,
    atol: 1e-10,
    step_size: StepSize::Fixed(0.01),
    first_step: None,
    max_step: f64::INFINITY,
    max_steps: 100_000,
    max_switches: 100,
    max_at_one_instant: 1000,
    guard_scale: None,
    zeno: 0.0,
};

fn contacts() -> impl Iterator<Item = Contact> {
    let all = [(18.0, 0.4, 0.0), (63.0, 0.5, 0.0), (63.0, 0.5, 0.1), (18.0, 1.0, 0.3)];
    all.into_iter().map(|(kappa, psi, damping)| Contact::new(kappa, psi, damping).unwrap())
}

#[test]
fn regularised_and_located_is_what_the_collider_does() {
    for contact in contacts() {
        let located = LocationSettings::Located { options: FIXED };
        let found =
            integrate(EmbeddedPair::Dopri5, contact, Formulation::Regularized, &located).unwrap();
        let expected = Collider::unrefined(Dopri5, FIXED).collide(contact).unwrap();
        let error = found.deviation(&expected);
        assert_eq!((error.velocity, error.switch_times.unwrap().iter().sum()), (0.0, 0.0));
    }
}

#[test]
fn both_coordinates_and_both_ways_to_switch_tell_the_same_story() {
    let located = LocationSettings::Located { options: FIXED };
    let coarse = LocationSettings::AtStepEnds { step_size: 5e-4, max_steps: 100_000 };
    for contact in contacts() {
        let truth = reference(contact).unwrap();
        for (coordinates, switching, velocity, time) in [
            (Formulation::PlainTime, &located, 1e-7, 1e-6),
            (Formulation::PlainTime, &coarse, 2e-6, 5e-4),
            (Formulation::Regularized, &coarse, 5e-6, 1.1e-3),
        ] {
            let found = integrate(EmbeddedPair::Dop853, contact, coordinates, switching).unwrap();
            let error = found.deviation(&truth);
            assert!(error.velocity < velocity, "{contact:?} {coordinates:?} {error:?}");
            let times = error.switch_times.unwrap();
            assert!(times.iter().all(|t| *t < time), "{contact:?} {coordinates:?} {times:?}");
        }
    }
}

#[test]
fn other_laws_are_refused() {
    let law = Law { normal: Normal::Linear, damping: Damping::Linear, ..Law::PAPER };
    let contact = Contact::new(18.0, 0.4, 0.1).unwrap().with_law(law, 0.0).unwrap();
    let located = LocationSettings::Located { options: FIXED };
    for coordinates in [Formulation::Regularized, Formulation::PlainTime] {
        let found = integrate(EmbeddedPair::Dopri5, contact, coordinates, &located);
        assert!(matches!(found, Err(CollisionError::Law(_))));
    }
    let settings = ConvergenceSettings { contacts: vec![contact] };
    assert!(matches!(settings.validate(), Err(StudyError::Law(_))));
}

#[test]
fn other_switches_and_failures_are_counted() {
    let references: Vec<_> = contacts().map(|contact| reference(contact).unwrap()).collect();
    let coarse = LocationSettings::AtStepEnds { step_size: 0.2, max_steps: 100 };
    let errors = measure(EmbeddedPair::Dopri5, &references, Formulation::PlainTime, &coarse);
    assert!(errors.failed == 0 && errors.other_switches > 0 && !errors.comparable());
    assert!(errors.velocity.largest >= errors.velocity.root_mean_square);
    let short = LocationSettings::AtStepEnds { step_size: 0.2, max_steps: 3 };
    let errors = measure(EmbeddedPair::Dopri5, &references, Formulation::PlainTime, &short);
    assert!(errors.failed == 4 && errors.velocity.largest.is_nan() && !errors.comparable());
}
