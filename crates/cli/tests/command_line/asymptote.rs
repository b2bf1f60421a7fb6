//! The study of stiff springs.

use std::sync::OnceLock;

use serde_json::Value;

use crate::{Workspace, rows, stickslip};

/// The files of one study and what it printed, which all tests share.
fn study() -> &'static (Workspace, String) {
    static STUDY: OnceLock<(Workspace, String)> = OnceLock::new();
    STUDY.get_or_init(|| {
        let workspace = Workspace::new();
        let ran = workspace.run("asymptote --kappa 1e3:1e6 --psi 0.4,1.6 --threads 2 --out out");
        assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
        (workspace, ran.stdout)
    })
}

fn json() -> Value {
    serde_json::from_str(&study().0.read("out/asymptote.json")).expect("JSON")
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is a number"))
}

/// A column of a table, as numbers.
fn column(table: &str, name: &str) -> Vec<f64> {
    let rows = rows(&study().0.read(&format!("out/asymptote_{table}.csv")));
    let index = rows[0].iter().position(|column| column == name).expect("the column");
    rows[1..].iter().map(|row| row[index].parse().expect("a number")).collect()
}

#[test]
fn all_files_are_there_and_nothing_else() {
    assert_eq!(
        study().0.names_in("out"),
        [
            "asymptote.json",
            "asymptote_collisions.csv",
            "asymptote_convergence.csv",
            "asymptote_correction.svg",
            "asymptote_counts.csv",
            "asymptote_counts.svg",
            "asymptote_envelope.csv",
            "asymptote_envelope.svg",
            "asymptote_profile.csv",
            "asymptote_profile.svg",
            "asymptote_restitution.csv",
        ]
    );
    for name in ["correction", "counts", "envelope", "profile"] {
        let text = study().0.read(&format!("out/asymptote_{name}.svg"));
        roxmltree::Document::parse(&text).expect("XML");
    }
}

#[test]
fn exponent_and_constant() {
    let json = json();
    assert_eq!(json["schema"], "stickslip.asymptote/1");
    let (fits, inner) = (&json["fits"], &json["inner_problem"]);
    for (name, expected, limit) in [
        ("exponent_plain", 1.25, 2e-4),
        ("exponent", 1.25, 1e-9),
        ("constant", number(&inner["largest"]), 1e-9),
        ("correction", number(&inner["correction"]), 1e-3),
        ("power_of_correction", 1.25, 1e-3),
    ] {
        let off = (number(&fits[name]["value"]) - expected).abs();
        assert!(off < limit, "{name}: {off}");
        assert!(off < 3.0 * number(&fits[name]["uncertainty"]), "{name}: {off}");
    }
    assert!((number(&inner["largest"]) - 4.4848423519475426).abs() < 1e-14);
    assert!(number(&fits["relative_spread_over_psi"]) < 1e-13);
}

#[test]
fn tables_hold_what_is_claimed() {
    let kappa = column("envelope", "kappa");
    assert_eq!(kappa.len(), 2 * 13);
    assert_eq!((kappa[0], kappa[12], kappa[13]), (1e3, 1e6, 1e3));
    let velocity = column("envelope", "w_final");
    let tables =
        ["w_integrated", "w_theory", "bound_corrected"].map(|name| column("envelope", name));
    for (i, w) in velocity.iter().enumerate() {
        assert!((tables[0][i] - w).abs() < 1e-13);
        assert!((tables[1][i] / w - 1.0).abs() < 7.0 * kappa[i].powf(-1.25));
        assert!(*w < tables[2][i]);
    }
    // Collisions are close to F(phase).
    let (f, scaled) = (column("collisions", "f"), column("collisions", "w_scaled"));
    let stiffness = column("collisions", "kappa");
    assert_eq!(f.len(), 2 * 48);
    for i in 0..f.len() {
        assert!((f[i] - scaled[i]).abs() < 150.0 * stiffness[i].powf(-1.25), "{i}");
    }
    let profile = column("profile", "f");
    assert!(profile.iter().all(|f| (0.0..4.4848424).contains(f)));
    assert!(profile.iter().copied().fold(0.0, f64::max) > 4.484);
    // Numbers of switches differ by less than four from the expected ones.
    let (kappa, ratio) = (column("counts", "kappa"), column("counts", "ratio"));
    for (i, expected) in column("counts", "ratio_expected").iter().enumerate() {
        let switches = kappa[i].sqrt() * 3.2180654597190 / std::f64::consts::PI;
        assert!((ratio[i] - expected).abs() * switches < 4.0, "{i}");
    }
}

#[test]
fn findings_are_printed_and_kept() {
    let json = json();
    let kept = json["findings"].as_array().expect("a list").iter();
    let kept: Vec<&str> = kept.map(|finding| finding.as_str().expect("words")).collect();
    assert_eq!(study().1.lines().collect::<Vec<_>>(), kept);
    for part in ["4.484842351947542", "1.119909", "1.143263"] {
        assert!(kept.iter().any(|finding| finding.contains(part)), "{part}");
    }
}

#[test]
fn files_do_not_depend_on_the_number_of_threads() {
    let (workspace, printed) = study();
    let ran = workspace.run("asymptote --kappa 1e3:1e6 --psi 0.4,1.6 --threads 1 --out again");
    assert_eq!(ran.stdout, *printed);
    for name in workspace.names_in("out") {
        assert_eq!(
            workspace.read(&format!("out/{name}")),
            workspace.read(&format!("again/{name}"))
        );
    }
}

#[test]
fn few_stiffnesses_have_no_fit() {
    let workspace = Workspace::new();
    let ran = workspace.run("asymptote --kappa 3:50 --psi 1 --out out");
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(ran.stdout.contains("are not fitted"), "{}", ran.stdout);
    let json: Value = serde_json::from_str(&workspace.read("out/asymptote.json")).expect("JSON");
    assert_eq!(json["fits"], Value::Null);
}

#[test]
fn options_that_are_refused() {
    let workspace = Workspace::new();
    for (line, parts) in [
        ("--kappa 2:10", ["--kappa 2.0:10.0", "3.0 <= LO < HI <= 10000000000.0"]),
        ("--kappa 10:1e11", ["--kappa 10.0:100000000000.0", "3.0 <= LO"]),
        ("--kappa 10", ["--kappa", "LO:HI"]),
        ("--psi 1,2", ["--psi 2.0", "below 2"]),
        ("--psi 1,0", ["--psi", "above 0"]),
        ("--psi 1,0.5,1", ["--psi has 1.0 twice", "once"]),
        ("--psi 0.1,0.2,0.3,0.4,0.5", ["--psi has 5 values", "expected 1 to 4"]),
        ("--threads 0", ["--threads", "1..=1024"]),
    ] {
        let ran = workspace.run(&format!("asymptote --out nowhere {line}"));
        assert_eq!((ran.code, ran.stdout.as_str()), (2, ""), "{line}");
        assert!(parts.iter().all(|part| ran.stderr.contains(part)), "{line}: {}", ran.stderr);
    }
    assert!(workspace.names().is_empty());
    assert_eq!(stickslip("asymptote").code, 2);
}

#[test]
fn a_directory_that_cannot_be_created() {
    let workspace = Workspace::with_input("");
    let ran = workspace.run("asymptote --out in.csv/out");
    assert_eq!(ran.code, 1);
    assert!(ran.stderr.contains("in.csv/out: cannot be written"), "{}", ran.stderr);
    assert_eq!(workspace.names(), ["in.csv"]);
}
