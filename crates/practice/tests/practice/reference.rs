//! Errors of time steps, against those of LAMMPS.

use std::collections::BTreeSet;
use std::fs;

use serde_json::Value;
use stickslip_model::Engine;
use stickslip_plane::progress;
use stickslip_practice::time_steps::{self, TimeStepErrors, TimeStepSettings};

use crate::lammps::contact;

/// The cases of the reference file.
fn cases() -> Vec<Value> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/lammps_laws.json");
    let text = fs::read_to_string(path).expect("a text");
    let file: Value = serde_json::from_str(&text).expect("JSON");
    file["cases"].as_array().expect("cases").clone()
}

/// The errors of ε_t of a case at `steps` steps a contact.
fn errors(case: &Value, steps: f64) -> TimeStepErrors {
    let settings = TimeStepSettings {
        contacts: vec![contact(case)],
        steps_per_contact: vec![steps],
        ..TimeStepSettings::default()
    };
    let result = time_steps::run(&settings, progress::SILENT).expect("errors");
    result.rows[0].eps_t.expect("errors of eps_t")
}

/// How far the limit of small steps that LAMMPS' results were extrapolated to is from the exact
/// ε_t. LAMMPS' spheres overlap by 1e-7 of their radius, which changes ε_t by several times as
/// much.
fn offset(case: &Value) -> f64 {
    let (exact, _) = Engine::Auto.collide(contact(case)).expect("a collision");
    // Their coefficient has the other sign.
    (exact.eps_t() + case["eps_t"].as_f64().expect("a number")).abs()
}

#[test]
fn errors_are_those_of_lammps() {
    // The largest relative differences measured: 0.0027, 0.025 and 0.0305 where the error is large
    // beside the offset; the errors of LAMMPS have four digits.
    let tolerances = [("20", 20.0, 0.005), ("50", 50.0, 0.05), ("100", 100.0, 0.05)];
    let mut laws = BTreeSet::new();
    let mut small = 0;
    for case in cases() {
        for (name, steps, tolerance) in tolerances {
            let expected = &case["time_step"][name];
            let [rms, worst] = ["rms", "max"].map(|key| expected[key].as_f64().expect("a number"));
            let found = errors(&case, steps);
            let difference = (found.root_mean_square - rms).abs();
            if difference > tolerance * rms {
                // Two root mean squares differ by no more than what they are measured against.
                assert!(difference <= offset(&case) + 5e-4 * rms, "{difference:e} {case}");
                assert!(rms < 4e-6, "{rms:e} {case}");
                small += 1;
            }
            let difference = (found.worst.error - worst).abs();
            let allowed = tolerance * worst + offset(&case);
            assert!(difference <= allowed, "{difference:e} {case}");
        }
        laws.insert(case["law"].to_string());
    }
    assert_eq!(laws.len(), 28);
    // Elastic contacts that slide all the time, at t_c/100.
    assert_eq!(small, 5);
}
