//! The study of convergence: its files and its numbers, which do not depend on threads.

use std::sync::LazyLock;

use roxmltree::Document;
use serde_json::Value;

use crate::{Ran, Workspace, rows, stickslip};

const TIMES: &str = "convergence_time.csv";
const FILES: [&str; 11] = [
    "convergence.json",
    "convergence_collisions.csv",
    "convergence_orders.csv",
    "convergence_steps.csv",
    "convergence_steps_switches.svg",
    "convergence_steps_velocity.svg",
    TIMES,
    "convergence_tolerances.csv",
    "convergence_tolerances_switches.svg",
    "convergence_tolerances_velocity.svg",
    "convergence_work.svg",
];

fn json(workspace: &Workspace, name: &str) -> Value {
    serde_json::from_str(&workspace.read(name)).expect("JSON")
}

/// The orders of the velocity and of the switch times in one series.
fn orders(study: &Value, series: [&str; 4]) -> [f64; 2] {
    let keys = ["method", "coordinates", "switches", "control"];
    let all = study["series"].as_array().expect("series");
    let found = all.iter().find(|one| keys.iter().zip(series).all(|(key, name)| one[*key] == name));
    let found = found.expect("the series");
    ["velocity_order", "switch_time_order"].map(|quantity| {
        let error = found[quantity]["standard_error"].as_f64().expect("an error");
        assert!(error < 0.1, "{series:?}: {error}");
        found[quantity]["order"].as_f64().expect("an order")
    })
}

/// The usual study, which `notebooks_data` reads too: its directory and the run.
pub static USUAL: LazyLock<(Workspace, Ran)> = LazyLock::new(|| {
    let workspace = Workspace::new();
    let ran = workspace.run("converge --out new/study");
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    (workspace, ran)
});

#[test]
#[ignore = "long; .ci/run --long runs it"]
fn the_usual_collisions_have_the_orders_of_the_methods() {
    let (workspace, ran) = &*USUAL;
    assert_eq!(workspace.names_in("new/study"), FILES);
    let study = json(workspace, "new/study/convergence.json");
    assert_eq!(study["schema"], "stickslip.convergence/1");
    assert_eq!(study["reference"], "the exact solution");
    let findings: Vec<_> = ran.stdout.lines().collect();
    assert_eq!(study["findings"], Value::from(findings));
    let collisions = "Errors are those of 38 collisions with 2 to 8 switches";
    assert!(ran.stdout.lines().any(|line| line.starts_with(collisions)), "{}", ran.stdout);

    let near = |found: [f64; 2], expected: [f64; 2], within: f64| {
        let off = found.iter().zip(expected).any(|(a, b)| (a - b).abs() >= within);
        assert!(!off, "{found:?} {expected:?}");
    };
    near(orders(&study, ["dopri5", "regularised", "located", "step"]), [5.0; 2], 0.1);
    near(orders(&study, ["dop853", "regularised", "located", "step"]), [8.0; 2], 0.2);
    for method in ["dopri5", "dop853"] {
        near(orders(&study, [method, "plain time", "located", "step"]), [2.5; 2], 0.1);
        for coordinates in ["regularised", "plain time"] {
            let series = [method, coordinates, "at step ends", "step"];
            near(orders(&study, series), [2.0, 1.0], 0.15);
        }
        let series = [method, "regularised", "located", "tolerance"];
        near(orders(&study, series), [0.95; 2], 0.06);
    }
    for collision in study["collisions"].as_array().expect("collisions") {
        let error = &collision["dop853"];
        assert!(error["velocity_error"].as_f64().expect("a number") < 2e-13, "{collision}");
        assert!(error["switch_time_error"].as_f64().expect("a number") < 3e-12, "{collision}");
    }
}

#[test]
fn one_collision_has_the_same_files_with_any_number_of_threads() {
    let workspace = Workspace::new();
    for threads in [1, 2] {
        let line = format!("converge --kappa 63 --psi 0.5 --threads {threads} --out {threads}");
        let ran = workspace.run(&line);
        assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    }
    for name in FILES.iter().filter(|name| **name != TIMES) {
        let [one, two] = [1, 2].map(|threads| workspace.read(&format!("{threads}/{name}")));
        assert!(one == two, "{name}");
        match name.rsplit_once('.').expect("an extension").1 {
            "svg" => assert!(Document::parse(&one).expect("XML").descendants().count() > 100),
            "csv" => {
                let described = &json(&workspace, "1/convergence.json")["files"][name]["columns"];
                let described = described.as_object().expect("columns").keys();
                assert!(described.eq(&rows(&one)[0]), "{name}");
                assert!(rows(&one).len() > 2 && !one.contains("NaN"), "{name}");
            }
            _ => assert_eq!(
                json(&workspace, "1/convergence.json")["collisions"][0]["itinerary"],
                "+o-o+o-"
            ),
        }
    }
    for (method, order) in [("dopri5", 5.0), ("dop853", 8.0)] {
        let found = &json(&workspace, "1/convergence.json");
        let [velocity, _] = orders(found, [method, "regularised", "located", "step"]);
        assert!((velocity - order).abs() < 0.3, "{method}: {velocity}");
    }
    let times = rows(&workspace.read(&format!("1/{TIMES}")));
    assert_eq!(times[0].last().map(String::as_str), Some("microseconds"));
    assert!(times[1..].iter().all(|row| row[6].parse::<f64>().is_ok_and(|time| time > 0.0)));
}

#[test]
fn damped_collisions_have_a_reference_that_is_named() {
    let workspace = Workspace::new();
    let ran = workspace.run("converge --kappa 18 --ratio 1.4 --mu 0.5 --damping 0.3 --out d");
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    assert!(
        ran.stdout.contains("against dop853 in regularised coordinates at a tolerance of 1e-15")
    );
    let study = json(&workspace, "d/convergence.json");
    assert_eq!(study["collisions"][0]["psi"], 1.4 * (2.0 / 7.0) / 0.5);
    assert_eq!(study["collisions"][0]["damping"], 0.3);
}

#[test]
fn a_collision_without_switches_has_no_order_of_switch_times() {
    let workspace = Workspace::new();
    let ran = workspace.run("converge --kappa 18 --psi 2.5 --out none");
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    let study = json(&workspace, "none/convergence.json");
    assert_eq!(study["series"][0]["switch_time_order"], Value::Null);
    assert!(study["series"][0]["velocity_order"]["order"].is_number());
}

#[test]
fn bad_input_is_refused() {
    let workspace = Workspace::new();
    for (line, parts) in [
        ("--out d --kappa 0 --psi 1", &["--kappa", "'0'", "a finite number above 0"][..]),
        ("--out d --kappa 2e6 --psi 1", &["--kappa = 2000000.0", "at most 1000000"]),
        ("--out d --psi 1", &["--kappa is missing"]),
        ("--out d --mu 0.3", &["--kappa is missing"]),
        ("--out d --kappa 1", &["--psi", "--ratio", "exactly one"]),
        ("--out d --kappa 1 --psi 1 --ratio 1", &["--psi", "--ratio", "exactly one"]),
        ("--out d --kappa 1 --psi 1 --alpha 1/2", &["--alpha", "--ratio only"]),
        ("--out d --damping -1", &["--damping", "'-1'", "0 or above"]),
        ("--out d --threads 0", &["--threads", "1..=1024"]),
        ("--out d --method exact", &["--method"]),
        ("", &["--out"]),
    ] {
        let ran = workspace.run(&format!("converge {line}"));
        assert_eq!((ran.code, ran.stdout.as_str()), (2, ""), "{line}: {}", ran.stderr);
        for part in parts {
            assert!(ran.stderr.contains(part), "{line}: no {part:?} in {}", ran.stderr);
        }
        assert!(workspace.names().is_empty(), "{line}");
    }
}

#[test]
fn a_directory_that_cannot_be_written_is_a_failure_before_the_work() {
    let workspace = Workspace::new();
    workspace.write("file", "");
    for (out, code, why) in [
        ("file", 2, "is not a directory"),
        ("file/below", 1, "cannot be written"),
        ("/proc/none", 1, "cannot be written"),
    ] {
        let ran = workspace.run(&format!("converge --out {out}"));
        assert_eq!((ran.code, ran.stdout.as_str()), (code, ""), "{out}");
        assert!(ran.stderr.contains(out) && ran.stderr.contains(why), "{out}");
    }
    assert_eq!(workspace.names(), ["file"]);
}

#[test]
fn help_names_every_file() {
    let ran = stickslip("converge --help");
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    for name in FILES.iter().filter(|name| !name.contains(".svg")) {
        assert!(ran.stdout.contains(name), "{name}");
    }
}

#[test]
fn a_system_has_errors_in_proportion_to_the_tolerance() {
    let workspace = Workspace::new();
    // The state is cos s, whose zeros are counted.
    let text = "parameter until = 8\nstate x = 1, v = 0\nx' = v\nv' = -x\nwhen x crosses 0 \
                \"zero\"\nend = until\n";
    workspace.write("swing.slip", text);
    let ran = workspace.run("converge swing.slip --set until=10 --out study");
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    let names = ["", "_events", "_tolerances", "_tolerances", "_work"];
    let endings = ["json", "csv", "csv", "svg", "svg"];
    let files =
        names.iter().zip(endings).map(|(name, ending)| format!("convergence{name}.{ending}"));
    assert_eq!(workspace.names_in("study"), files.collect::<Vec<_>>());
    let study = json(&workspace, "study/convergence.json");
    assert_eq!(study["schema"], "stickslip.system-convergence/1");
    let findings: Vec<_> = ran.stdout.lines().collect();
    assert_eq!(study["findings"], Value::from(findings));
    assert!(ran.stdout.contains("dop853 finds the same events at every tolerance."));
    let state: [f64; 2] = serde_json::from_value(study["reference"]["end_state"].clone()).unwrap();
    assert!((state[0] - 10_f64.cos()).abs() < 1e-14 && (state[1] + 10_f64.sin()).abs() < 1e-14);
    let events = rows(&workspace.read("study/convergence_events.csv"));
    for (index, row) in events[1..].iter().enumerate() {
        let right = (index as f64 + 0.5) * std::f64::consts::PI;
        assert!(row[0] == "zero" && (row[1].parse::<f64>().unwrap() - right).abs() < 1e-14);
    }
    assert_eq!(events.len(), 1 + 3);
    let errors = rows(&workspace.read("study/convergence_tolerances.csv"));
    assert_eq!(errors.len(), 1 + 2 * 12);
    for row in &errors[1..] {
        let [tolerance, state, time] = [1, 5, 6].map(|column| row[column].parse::<f64>().unwrap());
        assert!(state.max(time) < 30.0 * tolerance && row[4] == "1", "{row:?}");
    }
    // One thread finds the same.
    workspace.run("converge swing.slip --set until=10 --out again --threads 1");
    assert!(workspace.read("study/convergence.json") == workspace.read("again/convergence.json"));
    for (option, message) in [
        ("--kappa 3", "cannot be used with"),
        ("--set unknown=1", "it has until"),
        ("--end -1", "expected an end after 0"),
    ] {
        let ran = workspace.run(&format!("converge swing.slip {option} --out other"));
        assert!(ran.code == 2 && ran.stderr.contains(message), "{option}: {}", ran.stderr);
    }
    let ran = workspace.run("converge --set until=1 --out other");
    assert!(ran.code == 2 && ran.stderr.contains("SYSTEM.slip"), "{}", ran.stderr);
}
