//! Tables of the restitution.

use serde_json::Value;

use crate::impact::example;
use crate::{Workspace, stickslip};

const WINDOW: &str = "--kappa 1:2 --psi 0.5:1.5 --bound 1e-4";

#[test]
fn one_run_writes_all_formats() {
    let workspace = Workspace::new();
    let path = |name: &str| workspace.path(name).display().to_string();
    let (json, npz, header) = (path("t.json"), path("t.npz"), path("t.h"));
    let ran = stickslip(&format!(
        "table {WINDOW} --regions --prefix gas --out {json} --out {npz} --out {header}"
    ));
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    for part in ["bound of the errors", "points compared", "ε_n"] {
        assert!(ran.stdout.contains(part), "{part}: {}", ran.stdout);
    }
    let table: Value = serde_json::from_str(&workspace.read("t.json")).expect("JSON");
    assert_eq!((&table["schema"], &table["bound"]), (&"stickslip.table/1".into(), &1e-4.into()));
    assert!(table["verification"]["largest_error"].as_f64().expect("a number") <= 1e-4);
    assert!(table["regions"].as_array().expect("regions").contains(&"+o-".into()));
    let text = workspace.read("t.h");
    for part in ["double gas_eps_t(double", "int gas_region(double", "GAS_EPS_N 1.0", "\"+o-\""] {
        assert!(text.contains(part), "{part}");
    }
    let archive = std::fs::read(workspace.path("t.npz")).expect("an archive");
    let rows = b"rows.npy";
    assert!(archive.windows(rows.len()).any(|part| part == rows));
    // Any number of threads writes the same bytes.
    let other = path("o.json");
    let ran = stickslip(&format!("table {WINDOW} --regions --threads 1 --out {other}"));
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert_eq!(workspace.read("o.json"), workspace.read("t.json"));
    // The damping is given by the normal restitution that it makes.
    let ran = stickslip(&format!("table {WINDOW} --e-n 0.8 --out {other}"));
    assert!(ran.stdout.contains("0.8"), "{}{}", ran.stdout, ran.stderr);
}

#[test]
fn what_cannot_be_is_refused() {
    let workspace = Workspace::new();
    let out = workspace.path("t.json").display().to_string();
    for (line, expected) in [
        ("--bound 1e-13 --out", "1e-12 to 1e-3"),
        ("--bound nan --out", "nan"),
        ("--kappa 2:1 --out", "kappa"),
        ("--psi 0:1 --out", "psi"),
        ("--damping -1 --out", "damping"),
        ("--damping 1 --e-n 0.5 --out", "--e-n"),
        ("--prefix 1a --out", "prefix"),
        ("--out x.csv --out", "FILE.json, FILE.npz or FILE.h"),
        ("--out ./t.json --out t.json --out", "t.json"),
    ] {
        let window = ["--kappa 1:2", "--psi 0.5:1.5"];
        let missing = window.iter().filter(|it| !line.contains(&it[..5])).copied();
        let window = missing.collect::<Vec<_>>().join(" ");
        let ran = stickslip(&format!("table {window} {line} {out}"));
        assert_eq!(ran.code, 2, "{line}: {}", ran.stderr);
        assert!(ran.stderr.contains(expected), "{line}: {}", ran.stderr);
        assert!(!workspace.path("t.json").exists(), "{line}");
    }
    let ran = stickslip(&format!("table --kappa 1:1.000000001 --psi 0.5:1.5 --out {out}"));
    assert_eq!(ran.code, 2, "{}", ran.stderr);
    assert!(ran.stderr.contains("too narrow") && !workspace.path("t.json").exists());
}

#[test]
fn velocities_of_two_bodies() {
    let workspace = Workspace::new();
    let path = |name: &str| workspace.path(name).display().to_string();
    let bodies = example("glass_on_wall.json").display().to_string();
    let (json, npz, header) = (path("t.json"), path("t.npz"), path("t.h"));
    let window = format!("--bodies {bodies} --normal 1:2 --tangential 1:3 --bound 1e-4");
    let ran = stickslip(&format!("table {window} --out {json} --out {npz} --out {header}"));
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    assert!(ran.stdout.contains("largest error of ε_n") && ran.stdout.contains(" m/s"));
    let table: Value = serde_json::from_str(&workspace.read("t.json")).expect("JSON");
    let of = &table["window"]["velocities"];
    assert_eq!(of["normal_m_per_s"]["high"], 2.0);
    assert_eq!(of["pair"]["surface"]["friction"], 0.3);
    assert!(table["constant_eps_n"].is_null());
    let text = workspace.read("t.h");
    for part in ["eps_t(double g_n, double g_t)", "eps_n(double g_n)", "STICKSLIP_G_N_LOW 1.0"] {
        assert!(text.contains(part), "{part}");
    }
    let archive = std::fs::read(workspace.path("t.npz")).expect("an archive");
    for name in [&b"normals.npy"[..], b"tangential_m_per_s.npy", b"pair.npy"] {
        assert!(archive.windows(name.len()).any(|part| part == name));
    }
}

#[test]
fn windows_of_velocities_that_cannot_be_are_refused() {
    let workspace = Workspace::new();
    let out = workspace.path("t.json").display().to_string();
    let bodies = format!("--bodies {}", example("glass_on_wall.json").display());
    let other = format!("--bodies {}", example("hooke_spheres.json").display());
    for (window, expected) in [
        (format!("{bodies} --normal 1:2"), "--tangential"),
        ("--normal 1:2 --tangential 1:2".to_owned(), "--bodies"),
        (format!("{bodies} --normal 1:2 --tangential 1:2 --kappa 1:2"), "--kappa"),
        (format!("{bodies} --normal 1:2 --tangential 1:2 --damping 1"), "--damping"),
        (format!("{bodies} --normal 0:2 --tangential 1:2"), "LO > 0"),
        (format!("{bodies} --normal 1:2 --tangential 2:1"), "LO < HI"),
        (format!("{bodies} --normal 1:2 --tangential 1e-20:1"), "expected 1e-13 to 1e12"),
        (format!("{bodies} --normal 1:1.000000001 --tangential 1:2"), "ln(normal_m_per_s)"),
        (format!("{other} --normal 1:2 --tangential 1:2"), "surface"),
        ("--bodies nowhere.json --normal 1:2 --tangential 1:2".to_owned(), "nowhere.json"),
        (String::new(), "--kappa"),
    ] {
        let ran = stickslip(&format!("table {window} --out {out}"));
        assert_eq!(ran.code, 2, "{window}: {}", ran.stderr);
        assert!(ran.stderr.contains(expected), "{window}: {}", ran.stderr);
        assert!(!workspace.path("t.json").exists(), "{window}");
    }
}
