//! Errors of time steps.

use serde_json::Value;

use crate::{Workspace, reference, stickslip};

/// α of a homogeneous sphere.
const ALPHA: f64 = 2.0 / 7.0;

/// The example of two steel spheres.
const STEEL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/steel_spheres.json");

/// The example of two grains with a linear force.
const HOOKE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/hooke_spheres.json");

fn json(line: &str) -> Value {
    let ran = stickslip(&format!("timestep {line} --format json"));
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""), "{line}");
    serde_json::from_str(&ran.stdout).expect("JSON")
}

/// A collision of LAMMPS by its own keywords, and the errors of its steps.
#[test]
fn errors_are_those_of_lammps() {
    let cases = reference("lammps_laws.json", "cases");
    let case = cases.iter().find(|case| case["law"] == "hertz/history damp1").expect("a case");
    let number = |name: &str| case["scaled"][name].as_f64().expect("a number");
    let found = json(&format!(
        "--kappa {} --psi {} --damping {} --tangential-damping {} --law gran/hertz/history \
         --steps 50,20",
        number("kappa") / ALPHA,
        number("g0") * ALPHA / number("mu"),
        number("cn"),
        number("xt") / ALPHA
    ));
    assert_eq!(found["schema"], "stickslip.timestep/1");
    assert_eq!((&found["scheme"], &found["phases"]), (&"lammps".into(), &16.into()));
    for (row, name) in ["20", "50"].into_iter().enumerate() {
        let errors = &found["rows"][row]["eps_t"];
        for (found, expected) in
            [(&errors["root_mean_square"], "rms"), (&errors["worst"]["error"], "max")]
        {
            let expected = case["time_step"][name][expected].as_f64().expect("a number");
            let found = found.as_f64().expect("a number");
            assert!((found / expected - 1.0).abs() < 2e-3, "{name}: {found} {expected}");
        }
    }
}

#[test]
fn intervals_stand_for_grids() {
    let found = json("--kappa 1:16 --psi 0.1:1 --grid 5 --steps 20 --threads 2");
    let contacts = found["contacts"].as_array().expect("contacts");
    assert_eq!(contacts.len(), 25);
    assert_eq!((&contacts[0]["kappa"], &contacts[0]["psi"]), (&1.0.into(), &0.1.into()));
    assert_eq!((&contacts[24]["kappa"], &contacts[24]["psi"]), (&16.0.into(), &1.0.into()));
    let one = json("--kappa 1:16 --psi 0.1:1 --grid 5 --steps 20 --threads 1");
    assert_eq!(found, one);
    assert_eq!(json("--kappa 2 --psi 0.1:1 --steps 20")["contacts"].as_array().unwrap().len(), 8);
}

#[test]
fn an_impact_in_si_units_has_steps_in_seconds() {
    let found = json(&format!("--bodies {STEEL} --steps 100,2000 --error 0.01"));
    let seconds = &found["seconds"];
    let number = |value: &Value| value.as_f64().expect("a number");
    let contact_time = number(&seconds["contact_time_s"]);
    // The contact lasts as long as that of the collision without damping.
    let impact = stickslip(&format!("impact {STEEL} --format json")).stdout;
    let impact: Value = serde_json::from_str(&impact).expect("JSON");
    assert!((contact_time / number(&impact["contact_time_s"]) - 1.0).abs() < 1e-9);
    assert_eq!(number(&seconds["steps_s"][1]), contact_time / 2000.0);
    assert!((number(&seconds["rayleigh_time_s"]) - 21.164e-6).abs() < 1e-9);
    assert_eq!(found["rows"][0]["status"], "unstable");
    assert_eq!(found["largest_step"]["eps_t"], 5e-4);
    let table = stickslip(&format!("timestep --bodies {STEEL} --steps 100,2000 --error 0.01"));
    for part in ["Rayleigh time [s]", "unstable: 16 of 16", "0.0005, dt = 3.3047e-8 s"] {
        assert!(table.stdout.contains(part), "no {part:?} in {}", table.stdout);
    }
}

#[test]
fn an_impact_in_si_units_may_have_any_law() {
    let found = json(&format!("--bodies {HOOKE} --law gran/hooke/history --steps 50"));
    let mass = 0.5 * 4.0 / 3.0 * std::f64::consts::PI * 1e-9 * 2500.0;
    let expected = std::f64::consts::PI * f64::sqrt(mass / 50000.0);
    let contact_time = found["seconds"]["contact_time_s"].as_f64().expect("a number");
    assert!((contact_time / expected - 1.0).abs() < 1e-12);
    assert_eq!(found["contacts"][0]["law"]["normal"], "linear");
    // The same impact in scaled units.
    let contact = &found["contacts"][0];
    let scaled = json(&format!(
        "--kappa {} --psi {} --damping {} --tangential-damping {} --law gran/hooke/history \
         --mu 0.3 --steps 50",
        contact["kappa"], contact["psi"], contact["damping"], contact["tangential_damping"]
    ));
    assert_eq!(scaled["rows"][0]["eps_t"], found["rows"][0]["eps_t"]);
    let unknown = stickslip(&format!("timestep --bodies {HOOKE} --steps 50"));
    assert_eq!(unknown.code, 2, "{}", unknown.stderr);
}

#[test]
fn what_fails_is_said() {
    let endless = "--kappa 1 --psi 1 --damping 1.99 --law gran/hooke/history --steps 20";
    let found = json(&format!("{endless} --error 0.1"));
    assert_eq!(found["rows"][0]["status"], "unfinished");
    assert_eq!(found["rows"][0]["eps_t"], Value::Null);
    assert_eq!(found["largest_step"]["eps_t"], Value::Null);
    let table = stickslip(&format!("timestep {endless} --error 0.1")).stdout;
    assert!(table.contains("unfinished: 16 of 16") && table.contains("ε_t     none"), "{table}");
    let overturned = "--kappa 3 --psi 0.5 --damping 0.3 --tangential-damping 4 \
                      --law granular/hertz/tsuji/mindlin --steps 20";
    let table = stickslip(&format!("timestep {overturned}")).stdout;
    assert!(table.contains("Badly conditioned: in 1 of the impacts"), "{table}");
}

#[test]
fn errors_are_drawn() {
    let workspace = Workspace::new();
    let line = "timestep --kappa 1:1e5 --psi 0.5 --grid 3";
    let ran = workspace.run(&format!("{line} --plot errors.svg"));
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    assert_eq!(ran.stdout, workspace.run(line).stdout);
    let svg = workspace.read("errors.svg");
    for part in ["largest error", "median", "a spring is not resolved", "3 impacts"] {
        assert!(svg.contains(part), "no {part:?}");
    }
    let ran = workspace.run(&format!("{line} --plot none/errors.svg"));
    assert_eq!((ran.code, ran.stdout.as_str()), (1, ""));
}

/// What a turning normal changes does not vanish with the step.
#[test]
fn a_normal_that_turns_is_in_the_errors() {
    let line = "--kappa 3 --psi 2 --law gran/hooke/history --steps 20,20000 --phases 1";
    let worst = |found: &Value| found["rows"][1]["eps_t"]["worst"]["error"].as_f64().unwrap();
    let still = json(line);
    assert!(still.get("overlap").is_none() && worst(&still) < 1e-3);
    for scheme in ["lammps", "synchronized_verlet"] {
        let turns = format!("{line} --overlap 0.01 --scheme {scheme}");
        let found = json(&turns);
        assert_eq!((&found["overlap"], &found["scheme"]), (&0.01.into(), &scheme.into()));
        assert!((worst(&found) - 0.136_061).abs() < 1e-3, "{found}");
        assert!(
            stickslip(&format!("timestep {turns}"))
                .stdout
                .contains("overlap 0.01 of the distance of the centres")
        );
    }
}

#[test]
fn bad_input_is_refused() {
    let workspace = Workspace::new();
    workspace.write("central.json", central());
    for (line, code, parts) in [
        ("", 2, &["--kappa is missing", "--bodies"][..]),
        ("--kappa 1", 2, &["--psi is missing"]),
        ("--kappa 0 --psi 1", 2, &["--kappa", "'0'", "above 0"]),
        ("--kappa 0:1 --psi 1", 2, &["--kappa", "'0:1'", "LO > 0"]),
        ("--kappa 1 --psi 1 --grid 5", 2, &["--grid has no effect"]),
        ("--kappa 1 --psi 1 --steps 0.5", 2, &["--steps = 0.5", "from 1.0 to 10000000.0"]),
        ("--kappa 1 --psi 1 --steps 20,nan", 2, &["--steps", "'nan'"]),
        ("--kappa 1 --psi 1 --phases 4097", 2, &["--phases", "1..=4096"]),
        ("--kappa 1 --psi 1 --error 0", 2, &["--error = 0.0", "above 0"]),
        ("--kappa 1 --psi 1 --scheme verlet", 2, &["--scheme", "lammps, elapsed"]),
        ("--kappa 1 --psi 1 --overlap 0.6", 2, &["overlap = 0.6", "from 0 to 0.5"]),
        ("--bodies central.json --overlap 0.1", 2, &["--overlap", "cannot be used with"]),
        ("--kappa 1 --psi 1 --bodies central.json", 2, &["--bodies", "cannot be used with"]),
        ("--bodies central.json", 2, &["central.json: the impact is central"]),
        ("--bodies none.json", 2, &["none.json: cannot be read"]),
        (
            "--kappa 1 --psi 1 --damping 2 --law gran/hooke/history",
            2,
            &["damping = 2", "never end"],
        ),
        ("--kappa 1 --psi 1e-300 --law gran/hooke/history", 1, &["psi = 1e-300", "expected 1e-13"]),
    ] {
        let ran = workspace.run(&format!("timestep {line}"));
        assert_eq!((ran.code, ran.stdout.as_str()), (code, ""), "{line}: {}", ran.stderr);
        for part in parts {
            assert!(ran.stderr.contains(part), "{line}: no {part:?} in {}", ran.stderr);
        }
    }
}

/// The steel spheres without tangential velocity.
fn central() -> String {
    let text = std::fs::read_to_string(STEEL).expect("a text");
    let mut file: Value = serde_json::from_str(&text).expect("JSON");
    file["spheres"][0]["motion"]["velocity_m_per_s"][0] = 0.into();
    file.as_object_mut().expect("an object").remove("$schema");
    file.to_string()
}
