//! One collision.

use std::process::{Command, Stdio};

use assert_cmd::cargo::cargo_bin;
use serde_json::Value;
use stickslip_model::{Collider, Collision, Contact, Engine, Tolerances, exact};
use stickslip_solver::{Dop853, Dopri5};

use crate::{Ran, decimal, reference, stickslip};

/// The JSON object that `collide` prints with `line`.
fn json(line: &str) -> Value {
    let ran = stickslip(&format!("collide --format json {line}"));
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""), "{line}");
    serde_json::from_str(&ran.stdout).expect("standard output is one JSON value and nothing else")
}

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().expect("an object").keys().map(String::as_str).collect()
}

fn bits(value: &Value) -> u64 {
    value.as_f64().expect("a number").to_bits()
}

/// Checks that `object` says the same as `collision`, bit for bit.
fn assert_same(object: &Value, collision: &Collision) {
    for (key, expected) in [
        ("eps_n", collision.eps_n),
        ("eps_t", collision.eps_t()),
        ("w_final", collision.final_velocity),
        ("contact_time", collision.contact_time),
    ] {
        assert_eq!(bits(&object[key]), expected.to_bits(), "{key}");
    }
    assert_eq!(object["switch_count"], collision.switches.len());
    assert_eq!(object["reversals"], collision.reversals);
    assert_eq!(object["itinerary"], collision.itinerary());
    let switches = object["switches"].as_array().expect("an array");
    assert_eq!(switches.len(), collision.switches.len());
    for (shown, switch) in switches.iter().zip(&collision.switches) {
        for (key, expected) in [
            ("time", switch.time),
            ("time_left", switch.time_left),
            ("spring", switch.spring),
            ("velocity", switch.velocity),
        ] {
            assert_eq!(bits(&shown[key]), expected.to_bits(), "{key}");
        }
        assert_eq!(shown["to"], switch.to.to_string());
        assert_eq!(shown["side"].as_f64(), Some(switch.side.sign()));
    }
    let ledger = &collision.energy;
    for (key, expected) in [
        ("tangential_initial", ledger.tangential_initial),
        ("tangential_final", ledger.tangential_final),
        ("sliding", ledger.sliding),
        ("spring_left", ledger.spring_left),
        ("normal_initial", ledger.normal_initial),
        ("normal_final", ledger.normal_final),
        ("damping", ledger.damping),
        ("compression_left", ledger.compression_left),
    ] {
        assert_eq!(bits(&object["energy"][key]), expected.to_bits(), "{key}");
    }
}

#[test]
fn json_has_the_documented_keys_in_order() {
    let object = json("--kappa 63 --psi 0.5 --method dop853");
    assert_eq!(
        keys(&object),
        [
            "schema",
            "parameters",
            "method",
            "eps_n",
            "eps_t",
            "w_final",
            "contact_time",
            "switch_count",
            "reversals",
            "itinerary",
            "switches",
            "energy",
            "statistics"
        ]
    );
    assert_eq!(object["schema"], "stickslip.collision/1");
    assert_eq!(keys(&object["parameters"]), ["kappa", "psi", "damping"]);
    assert_eq!(keys(&object["method"]), ["name", "rtol", "atol"]);
    assert_eq!(
        keys(&object["switches"][0]),
        ["time", "time_left", "to", "side", "spring", "velocity"]
    );
    assert_eq!(
        keys(&object["energy"]),
        [
            "tangential_initial",
            "tangential_final",
            "sliding",
            "spring_left",
            "normal_initial",
            "normal_final",
            "damping",
            "compression_left"
        ]
    );
    assert_eq!(
        keys(&object["statistics"]),
        [
            "accepted",
            "rejected",
            "too_coarse",
            "field",
            "guards",
            "resteps",
            "isolations",
            "enclosures",
            "switches",
            "grazings"
        ]
    );
    assert_eq!(object["statistics"]["switches"], object["switch_count"]);

    let object = json("--kappa 63 --psi 0.5");
    assert_eq!(object["method"], serde_json::json!({"name": "exact"}));
    assert_eq!(object["statistics"], serde_json::json!({}));
}

#[test]
fn json_reads_back_as_the_library_computes() {
    let contact = Contact::new(63.0, 0.5, 0.0).unwrap();
    let collision = Collider::new(Dop853).collide(contact).unwrap();
    assert_same(&json("--kappa 63 --psi 0.5 --method dop853"), &collision);
    assert_same(&json("--kappa 63 --psi 0.5"), &exact::collide(contact).unwrap());

    let contact = Contact::new(18.0, 2.0 / 7.0, 0.05).unwrap();
    let collision = Collider::with_tolerances(Dopri5, 1e-9, 1e-11).collide(contact).unwrap();
    let line = "--kappa 1.8e1 --psi 2/7 --damping 0.05 --method dopri5 --rtol 1e-9 --atol 1e-11";
    let object = json(line);
    assert_same(&object, &collision);
    assert_eq!(bits(&object["parameters"]["psi"]), (2.0_f64 / 7.0).to_bits());
    assert_eq!(bits(&object["method"]["rtol"]), 1e-9_f64.to_bits());
    assert_eq!(bits(&object["method"]["atol"]), 1e-11_f64.to_bits());
}

#[test]
fn a_ratio_becomes_psi() {
    let psi = |line: &str| bits(&json(line)["parameters"]["psi"]);
    assert_eq!(psi("--kappa 18 --ratio 1.4"), (1.4_f64 * (2.0 / 7.0) / 0.4).to_bits());
    assert_eq!(psi("--kappa 18 --ratio 1.4 --mu 0.5 --alpha 1"), (1.4_f64 / 0.5).to_bits());
}

#[test]
fn methods_agree_with_the_reference_values() {
    let cases = reference("undamped_paper.json", "cases");
    let paper = cases.iter().filter(|case| decimal(&case["psi"]) > 0.1).take(20);
    let mut compared = 0;
    for case in paper {
        let (kappa, psi) = (case["kappa"].as_str().unwrap(), case["psi"].as_str().unwrap());
        for method in ["dop853", "exact"] {
            let object = json(&format!("--kappa {kappa} --psi {psi} --method {method}"));
            assert_eq!(object["switch_count"], case["switch_count"], "{method} {kappa} {psi}");
            let error = object["eps_t"].as_f64().unwrap() - decimal(&case["eps_t"]);
            assert!(error.abs() * decimal(&case["psi"]) < 1e-12, "{method} {kappa} {psi}: {error}");
            compared += 1;
        }
    }
    assert_eq!(compared, 40);
}

#[test]
fn the_table_shows_switches_results_energy_and_work() {
    let Ran { code, stdout, stderr, .. } =
        stickslip("collide --kappa 63 --psi 0.5 --method dop853 --verbose");
    assert_eq!((code, stderr.as_str()), (0, ""));
    let line = |start: &str| {
        stdout.lines().find(|line| line.starts_with(start)).unwrap_or_else(|| panic!("{start}"))
    };
    assert!(line("Collision").contains("κ = 63.0, ψ = 0.5, damping a = 0.0, by dop853"));
    assert!(line("tangential restitution ε_t").ends_with("-0.04165220748"));
    assert!(line("itinerary").contains(" +o-o+o-  (a character a phase"));
    assert!(line("reversals").ends_with(" 5"));
    assert!(line("unbalanced").contains("e-1"), "the ledger balances to rounding");
    assert!(line("evaluations of the right-hand side").ends_with(|c: char| c.is_ascii_digit()));
    // There are a header and six rows, all equally wide.
    let switches: Vec<_> = stdout.lines().skip(2).take_while(|line| !line.is_empty()).collect();
    assert_eq!(switches.len(), 7);
    assert!(switches.iter().all(|row| row.chars().count() == switches[0].chars().count()));

    for line in ["--kappa 63 --psi 2.5", "--kappa 63 --psi 2.5 --method dop853"] {
        let quiet = stickslip(&format!("collide {line}")).stdout;
        assert!(quiet.contains("No switch.") && !quiet.contains("evaluations"), "{quiet}");
    }
}

#[test]
fn what_cannot_be_computed_fails_with_its_numbers() {
    let ran = stickslip("collide --kappa 1e17 --psi 1 --method exact");
    assert_eq!((ran.code, ran.stdout.as_str()), (1, ""));
    assert!(ran.stderr.contains("kappa = 1e17"), "{}", ran.stderr);

    // ψ²/2 would be beyond the range of doubles. Infinity is never printed.
    let ran = stickslip("collide --kappa 1 --psi 1e200 --method exact --format json");
    assert_eq!((ran.code, ran.stdout.as_str()), (1, ""));
    assert!(
        ran.stderr.contains(
            "psi = 1e200 is out of the range of the exact solution; expected 1e-100 to 1e100"
        ),
        "{}",
        ran.stderr
    );
}

#[test]
fn a_reader_that_leaves_early_is_not_a_failure() {
    let mut child = Command::new(cargo_bin!("stickslip"))
        .args("collide --kappa 1e8 --psi 1 --method exact".split(' '))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // The table has ten thousand rows, more than a pipe holds.
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), output.stderr.as_slice()), (Some(0), &b""[..]));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_output_is_a_failure() {
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = Command::new(cargo_bin!("stickslip"))
        .args("collide --kappa 63 --psi 0.5".split(' '))
        .stdout(full)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8(output.stderr).unwrap().contains("standard output"));
}

#[test]
fn estimates_are_those_of_the_library() {
    let line = "--kappa 18 --psi 1.99 --method dopri5 --estimate";
    let object = json(line);
    let contact = Contact::new(18.0, 1.99, 0.0).unwrap();
    let engine = Engine::Dopri5(Tolerances::DOPRI5);
    let expected = engine.estimate(&engine.collide(contact).unwrap().0).unwrap();
    let estimate = &object["estimate"];
    assert_eq!(bits(&estimate["eps_t_error"]), expected.eps_t_error.to_bits());
    assert_eq!(bits(&estimate["distance"]), expected.distance.to_bits());
    assert_eq!(estimate["certain"], true);
    // ψ = 2 is a boundary.
    assert!((expected.distance - 0.01 / 1.99).abs() < 1e-5);
    let table = stickslip(&format!("collide {line}")).stdout;
    assert!(table.contains("distance from other switches  5.0e-3"), "{table}");
    assert!(json("--kappa 18 --psi 1.99").get("estimate").is_none());
}

#[test]
fn the_best_engine_answers_unless_another_one_is_asked_for() {
    // The integrators begin at a damping of 1e-8.
    let line = "--kappa 18 --psi 1 --damping 1e-9";
    let object = json(line);
    assert_eq!(object["method"]["name"], "exact");
    let contact = Contact::new(18.0, 1.0, 1e-9).unwrap();
    assert_same(&object, &exact::collide(contact).unwrap());
    let ran = stickslip(&format!("collide {line} --method dop853"));
    assert_eq!(ran.code, 1);
    assert!(ran.stderr.contains("out of the range of the integrator"), "{}", ran.stderr);
    for (more, name) in [("--rtol 1e-9", "dop853"), ("--law gran/hertz/history", "dop853")] {
        let object = json(&format!("--kappa 18 --psi 1 --damping 0.1 {more}"));
        assert_eq!(object["method"]["name"], name, "{more}");
    }
}
