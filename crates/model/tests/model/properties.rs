//! Properties of every collision, checked for a number of random ones.
//!
//! A fuzz target (`fuzz/fuzz_targets/collisions.rs`) checks them for as long as it runs, and
//! `cargo run --release -p validation --example full_range -- 1000000` for a million collisions.

use proptest::prelude::*;
use proptest::test_runner::{RngAlgorithm, TestError, TestRng, TestRunner};
use stickslip_model::{Collider, CollisionError, Contact};
use stickslip_solver::Dopri5;

use crate::checks;

/// Runs `check` on `cases` values, which are the same in every run.
fn hold<S: Strategy>(cases: u32, strategy: &S, check: impl Fn(S::Value) -> Result<(), String>) {
    let config = ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() };
    let rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let ran = TestRunner::new_with_rng(config, rng)
        .run(strategy, |value| check(value).map_err(TestCaseError::fail));
    if let Err(TestError::Fail(reason, value)) = ran {
        panic!("{reason}\nminimal: {value:?}");
    }
}

/// Numbers whose logarithm is uniform between two powers of 10.
fn logarithmic(powers: std::ops::Range<f64>) -> impl Strategy<Value = f64> {
    powers.prop_map(|power| 10_f64.powf(power))
}

/// Contacts over the range of everyday use, half of them without damping.
fn contacts(kappa: std::ops::Range<f64>) -> impl Strategy<Value = Contact> {
    let damping = prop_oneof![Just(0.0), logarithmic(-12.0..3.0)];
    (logarithmic(kappa), logarithmic(-12.0..12.0), damping)
        .prop_filter_map("a contact", |(kappa, psi, damping)| {
            Contact::new(kappa, psi, damping).ok()
        })
}

#[test]
fn collisions_over_the_whole_range() {
    hold(1000, &contacts(-12.0..5.0), checks::every_engine);
}

#[test]
#[ignore = "long; .ci/run --long runs it"]
fn more_collisions_over_the_whole_range() {
    hold(4000, &contacts(-12.0..5.0), checks::every_engine);
}

#[test]
fn collisions_of_stiff_springs() {
    hold(6, &contacts(5.0..8.0), checks::every_engine);
}

#[test]
fn collisions_of_any_bit_pattern() {
    let any = any::<[u64; 3]>().prop_map(|bits| bits.map(f64::from_bits));
    hold(20_000, &any, |[kappa, psi, damping]| {
        // Collisions of the stiffest springs take seconds.
        let contact = Contact::new(kappa, psi, damping).or(Contact::new(kappa, psi, 0.0));
        contact.map_or(Ok(()), |contact| {
            if (1e6..1e17).contains(&kappa) { Ok(()) } else { checks::every_engine(contact) }
        })
    });
}

/// Contacts found by fuzzing, each with a fault at the time.
#[test]
fn faults_found_before() {
    // A slip that turns round so close to the end of contact that rounding hides it.
    let contact = Contact::new(0.45739746090475863, 3.5193950124344e-23, 0.0).unwrap();
    checks::every_engine(contact).unwrap();
    // With damping: a contact that does not end.
    let endless = Contact::new(1.9704603153077205, 2853343.992432598, 393262.591084441).unwrap();
    let refused = Collider::new(Dopri5).collide(endless);
    assert!(matches!(refused, Err(CollisionError::Domain(_))), "{refused:?}");
    // The others: a last slip on the wrong side, where the spring is rounding alone; no last slip;
    // a first stick phase too short for a step.
    let near = Contact::new(1.8127441000105495, 1.3735892388069372e-19, 4.5484799780780684e-10);
    checks::every_engine(near.unwrap()).unwrap();
    for (kappa, psi, damping) in [
        (4.528382313822378e-11, 1.2650261948417832e-11, 0.14066568840160276),
        (9.231192025160803e-12, 3.493996029379889e-12, 74.88341304204822),
        (412.9473860211958, 2.091379436460536e7, 5.2526582745142626e-8),
    ] {
        let contact = Contact::new(kappa, psi, damping).unwrap();
        let held = checks::integrated(&Collider::default(), contact).unwrap();
        assert!(held.is_ok(), "{contact:?}: {held:?}");
    }
}
