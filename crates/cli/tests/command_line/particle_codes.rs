//! The page for users of particle codes: its numbers, and what its commands write.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::Workspace;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

#[test]
#[ignore = "long; .ci/run --long runs it"]
fn gases_of_the_page_cool() {
    // The gases have lost energy, the one with the constant more.
    if has_compiler() {
        let workspace = run();
        let last = |name: &str| {
            let text = workspace.read(name);
            let line = text.lines().last().expect("a line").to_owned();
            line.split(',').nth(2).and_then(|cell| cell.parse::<f64>().ok()).expect("an energy")
        };
        let (table, constant) = (last("table.csv"), last("constant.csv"));
        assert!(constant < table && table < 1e-3, "{table} {constant}");
        for (name, time, spins) in [("table.csv", 0.33, 0.44), ("constant.csv", 0.28, 0.38)] {
            let text = workspace.read(name);
            let rows = text.lines().skip(2).map(|line| {
                line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect::<Vec<f64>>()
            });
            let row = rows.into_iter().find(|row| row[2] < 0.01).expect("a cold gas");
            assert!((row[1] / time - 1.0).abs() < 0.05, "{name} {row:?}");
            assert!((row[3] / row[2] / spins - 1.0).abs() < 0.08, "{name} {row:?}");
        }
    }
}

/// The numbers in the text of the page.
#[test]
fn numbers_of_the_page_are_computed() {
    let number = |command: &str, name: &str| {
        let ran = crate::stickslip(&format!("{command} --format json"));
        let found: serde_json::Value = serde_json::from_str(&ran.stdout).expect("JSON");
        found[name].as_f64().unwrap_or_else(|| panic!("{command}: {}", ran.stderr))
    };
    let spheres = Path::new(ROOT).join("examples/hooke_spheres.json");
    let impact = format!("impact {} --law gran/hooke/history", spheres.display());
    let law = "--law granular/hertz/tsuji/mindlin";
    for (command, expected, accuracy) in [
        (format!("{impact} --normal 0.5 --tangential 0.05"), -0.83, 0.005),
        (format!("collide --kappa 5.157 --psi 0.187 {law}"), 1.06, 0.005),
        (format!("collide --kappa 1.266 --psi 0.005 {law}/force"), -1.05, 0.005),
        (format!("collide --kappa 1.48 --psi 1 {law}_rescale/force"), -0.8414, 5e-5),
    ] {
        let found = number(&command, "eps_t");
        assert!((found - expected).abs() < accuracy, "{command}: {found}");
    }
    // Grazing impacts tend to 1 with every law.
    let grazing = |psi: f64| {
        number(&format!("collide --kappa 1.48 --psi {psi} {law}_rescale/force"), "eps_t")
    };
    assert!(grazing(200.0) > 0.98 && grazing(200.0) < 1.0 && grazing(20.0) < grazing(200.0));
    let ratio =
        number("collide --kappa 1 --psi 0.1 --law gran/hooke/history --damping 0.2", "eps_n");
    assert!((ratio - 0.729).abs() < 5e-4, "{ratio}");
    let older =
        number("collide --kappa 1 --psi 0.1 --law gran/hooke/history --damping 0.1", "eps_n");
    assert!((older - 0.854).abs() < 5e-4, "{older}");
    let examples = |name: &str| Path::new(ROOT).join("examples").join(name).display().to_string();
    let (data, bodies) = ("oblique_impacts.csv", "aluminium_oxide_on_glass.json");
    let [data, bodies] = [data, bodies].map(examples);
    let ran = crate::stickslip(&format!("fit {data} --bodies {bodies} --speed 3.9 --format json"));
    let fit: serde_json::Value = serde_json::from_str(&ran.stdout).expect("JSON");
    let square = |minimum: &serde_json::Value| {
        minimum["root_mean_squares"][0]["value"].as_f64().expect("a number")
    };
    let worse = square(&fit["mindlin"]["best"]) / square(&fit["minima"][0]);
    assert!((worse - 3.0).abs() < 0.5, "{worse}");
    let ran = crate::stickslip("laws granular/hertz/tsuji/mindlin --e-n 0.8 --format json");
    let tsuji: serde_json::Value = serde_json::from_str(&ran.stdout).expect("JSON");
    for (keyword, expected) in [(0, 0.853), (1, 0.799), (2, 0.8)] {
        let found = tsuji["keywords"][keyword]["e_n"].as_f64().expect("a number");
        assert!((found - expected).abs() < 5e-4, "{found}");
    }
}

fn has_compiler() -> bool {
    Command::new("cc").arg("--version").output().is_ok()
}

/// Runs the commands of the page with which a gas cools, in a workspace with the examples.
fn run() -> Workspace {
    let workspace = Workspace::new();
    let folder = workspace.path("examples");
    fs::create_dir_all(&folder).expect("a folder");
    for entry in fs::read_dir(Path::new(ROOT).join("examples")).expect("the examples") {
        let path = entry.expect("an example").path();
        if path.is_file() {
            fs::copy(&path, folder.join(path.file_name().expect("a name"))).expect("a copy");
        }
    }
    let page = fs::read_to_string(Path::new(ROOT).join("docs/particle-codes.md")).expect("a page");
    let own = ["stickslip table ", "cc ", "./gas "];
    let lines = page.lines().filter_map(|line| line.strip_prefix("$ "));
    let commands: Vec<_> = lines.filter(|it| own.iter().any(|own| it.starts_with(own))).collect();
    assert_eq!(commands.len(), 4, "{commands:?}");
    let program = Path::new(env!("CARGO_BIN_EXE_stickslip")).parent().expect("a folder");
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap_or_default());
    for command in commands {
        let mut shell = Command::new("sh");
        let shell = shell.args(["-c", command]).env("PATH", &path);
        let ran = shell.current_dir(workspace.path(".")).output().expect("a shell");
        let stderr = String::from_utf8_lossy(&ran.stderr);
        assert!(ran.status.success(), "{command}: {stderr}");
    }
    workspace
}
