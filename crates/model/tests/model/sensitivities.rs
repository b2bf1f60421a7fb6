//! Derivatives of collisions against differences of references with 60 digits.

use crate::common::{cases, number};
use serde_json::Value;
use stickslip_model::sensitivity::Derived;
use stickslip_model::{Collider, Contact};
use stickslip_solver::Dopri5;

/// The largest error of results and of their derivatives, relative to the largest of the same kind
/// in the collision, or to 1.
fn error(expected: &[&Value], found: &[Derived]) -> f64 {
    assert_eq!(expected.len(), found.len());
    let part = |derived: &Derived| [derived.value, derived.kappa, derived.psi, derived.damping];
    let names = ["value", "kappa", "psi", "damping"];
    let errors = names.iter().enumerate().map(|(i, name)| {
        let size = found.iter().map(|derived| part(derived)[i].abs()).fold(1.0, f64::max);
        let off = expected
            .iter()
            .zip(found)
            .map(|(expected, found)| (number(&expected[*name]) - part(found)[i]).abs() / size);
        off.fold(0.0, f64::max)
    });
    errors.fold(0.0, f64::max)
}

/// The largest errors over all references: of final states, and of times.
fn largest(sensitivity: impl Fn(Contact) -> stickslip_model::sensitivity::Sensitivity) -> [f64; 2] {
    let mut largest = [0.0_f64; 2];
    for case in cases("sensitivities") {
        let found = sensitivity(case.contact);
        let expected = &case.expected;
        let ends = error(
            &[&expected["eps_n"], &expected["final_velocity"]],
            &[found.eps_n, found.final_velocity],
        );
        let times: Vec<&Value> =
            expected["switch_times"].as_array().expect("times").iter().collect();
        let times = error(
            &[times, vec![&expected["contact_time"]]].concat(),
            &[found.switch_times, vec![found.contact_time]].concat(),
        );
        largest = [largest[0].max(ends), largest[1].max(times)];
    }
    largest
}

#[test]
fn derivatives_agree_with_differences_of_references() {
    let dop853 = largest(|contact| Collider::default().sensitivity(contact).expect("derivatives"));
    let dopri5 = Collider::with_tolerances(Dopri5, 1e-12, 1e-12);
    let dopri5 = largest(|contact| dopri5.sensitivity(contact).expect("derivatives"));
    for (name, [ends, times]) in [("dop853", dop853), ("dopri5", dopri5)] {
        println!("{name}: {ends:.1e} in states, {times:.1e} in times");
    }
    assert!(dop853[0] < 1.2e-12 && dop853[1] < 1.5e-12, "{dop853:?}");
    assert!(dopri5[0] < 1.2e-11 && dopri5[1] < 2.5e-11, "{dopri5:?}");
}
