//! The crates depend on each other only along the arrows of docs/architecture.md.

use std::process::Command;

use serde_json::Value;

#[test]
fn crates_keep_to_the_arrows() {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--no-deps", "--offline"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo metadata");
    let metadata: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let mut edges: Vec<(String, String)> = Vec::new();
    for package in metadata["packages"].as_array().expect("packages") {
        for dependency in package["dependencies"].as_array().expect("dependencies") {
            let (from, to) = (package["name"].as_str(), dependency["name"].as_str());
            if let (Some(from), Some(to)) = (from, to)
                && to.starts_with("stickslip")
            {
                edges.push((from.to_owned(), to.to_owned()));
            }
        }
    }
    let allowed = [
        ("stickslip", "stickslip-solver"),
        ("stickslip", "stickslip-model"),
        ("stickslip", "stickslip-tracer"),
        ("stickslip-cli", "stickslip"),
        ("stickslip-cli", "stickslip-solver"),
        ("stickslip-cli", "stickslip-model"),
        ("stickslip-cli", "stickslip-tracer"),
        ("stickslip-model", "stickslip-solver"),
        ("stickslip-tracer", "stickslip-solver"),
    ];
    // As many are those of the facade, which a published package has alone.
    assert!(edges.len() >= 3, "{edges:?}");
    for (from, to) in &edges {
        assert!(allowed.contains(&(from, to)), "{from} must not depend on {to}");
    }
}
