//! Files that `impact` refuses. The exit code is 2, nothing is on standard output, and the message
//! names the field or the line and what is expected. Wrong values of single fields are tested
//! together with the schema of the files.

use serde_json::{Value, json};

use crate::impact::example_value;
use crate::{Ran, Workspace};

fn run(text: impl AsRef<[u8]>) -> Ran {
    let workspace = Workspace::new();
    workspace.write("bodies.json", text);
    workspace.run("impact bodies.json")
}

/// Runs `impact` with a file of `text`, which must be refused with a message that contains all of
/// `parts`.
fn refused(text: impl AsRef<[u8]>, parts: &[&str]) {
    let ran = run(text);
    assert_eq!((ran.code, ran.stdout.as_str()), (2, ""), "{parts:?}: {}", ran.stderr);
    for part in ["error: bodies.json: "].iter().chain(parts) {
        assert!(ran.stderr.contains(part), "no {part:?} in {}", ran.stderr);
    }
    assert_eq!(ran.stderr.lines().count(), 1, "{}", ran.stderr);
}

/// A copy of `file` in which the field at `path` is `value`.
fn with(file: &Value, path: &str, value: Value) -> Value {
    let mut file = file.clone();
    *file.pointer_mut(path).expect("a field") = value;
    file
}

#[test]
fn numbers_beyond_the_range_of_doubles() {
    let pair = example_value("steel_spheres.json");
    let text = pair.to_string();
    assert!(text.contains("0.4"));
    refused(text.replacen("0.4", "1e400", 1), &["number out of range", "line 1 column"]);
    refused(text.replacen("0.4", "NaN", 1), &["line 1 column"]);
    refused(text.replacen("0.4", "-Infinity", 1), &["line 1 column"]);
    // κ is beyond the range of numbers.
    let stiff = with(&pair, "/surface/tangential_stiffness_kg_per_s2", json!(1e308));
    let light = with(&stiff, "/spheres/0/material/density_kg_per_m3", json!(1e-300));
    refused(light.to_string(), &["expected a finite number above 0"]);
    // The file is accepted, but the energy is infinite.
    let fast = with(&pair, "/spheres/0/motion/velocity_m_per_s", json!([1e200, 0, -1e200]));
    let workspace = Workspace::new();
    workspace.write("fast.json", fast.to_string());
    let ran = workspace.run("impact fast.json --method exact");
    assert_eq!((ran.code, ran.stdout.as_str()), (1, ""), "{}", ran.stderr);
    assert!(ran.stderr.contains("kinetic_before_j is not a finite number"), "{}", ran.stderr);
}

#[test]
fn broken_files() {
    refused("", &["line 1 column 0"]);
    refused("{\n  \"spheres\": [\n  }\n", &["line 3 column 3"]);
    refused("{\"spheres\": []} x", &["trailing characters", "line 1 column 17"]);
    refused("[]", &["expected an object", "line 1 column"]);
    refused(b"{\"comment\": \"\xff\"}", &["line 1 column"]);
    refused(
        "{\"comment\": \"\", \"comment\": \"\"}",
        &["duplicate field `comment`", "line 1 column"],
    );
    refused(format!("{}{}", "[".repeat(1000), "]".repeat(1000)), &["line 1 column"]);
}

#[test]
fn files_that_cannot_be_read() {
    let workspace = Workspace::new();
    for (line, parts) in [
        ("impact none.json", ["none.json: cannot be read", "No such file"]),
        ("impact .", [".: cannot be read", "directory"]),
    ] {
        let ran = workspace.run(line);
        assert_eq!((ran.code, ran.stdout.as_str()), (2, ""), "{line}");
        assert!(parts.iter().all(|part| ran.stderr.contains(part)), "{}", ran.stderr);
    }
    let ran = workspace.run("impact");
    assert!(ran.code == 2 && ran.stderr.contains("FILE.json"), "{}", ran.stderr);
}

#[test]
fn options_that_do_not_fit_the_file() {
    let workspace = Workspace::new();
    let damped = with(&example_value("steel_spheres.json"), "/surface/damping_time_s", json!(1e-6));
    workspace.write("bodies.json", damped.to_string());
    for (options, parts) in [
        ("--method exact --rtol 1e-9", ["--rtol", "exact"]),
        ("--rtol 2", ["--rtol", "1e-15 to 0.1"]),
        ("--format xml", ["xml", "json"]),
    ] {
        let ran = workspace.run(&format!("impact bodies.json {options}"));
        assert_eq!((ran.code, ran.stdout.as_str()), (2, ""), "{options}");
        assert!(parts.iter().all(|part| ran.stderr.contains(part)), "{}", ran.stderr);
    }
}
