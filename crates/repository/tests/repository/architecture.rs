//! Crates depend on each other only along the arrows of docs/architecture.md.

use std::collections::BTreeSet;

use cargo_metadata::MetadataCommand;

use crate::root;

/// All arrows: a crate, and what it may use. They point down only, a crate may use any crate below.
const ARROWS: [(&str, &[&str]); 9] = [
    ("stickslip-solver", &[]),
    ("stickslip-model", &["stickslip-solver"]),
    ("stickslip-tracer", &["stickslip-solver"]),
    ("stickslip-plane", &["stickslip-model", "stickslip-solver", "stickslip-tracer"]),
    (
        "stickslip-figure",
        &["stickslip-model", "stickslip-plane", "stickslip-solver", "stickslip-tracer"],
    ),
    (
        "stickslip-studies",
        &[
            "stickslip-figure",
            "stickslip-model",
            "stickslip-plane",
            "stickslip-solver",
            "stickslip-tracer",
        ],
    ),
    (
        "stickslip",
        &[
            "stickslip-figure",
            "stickslip-model",
            "stickslip-plane",
            "stickslip-solver",
            "stickslip-studies",
            "stickslip-tracer",
        ],
    ),
    (
        "stickslip-cli",
        &[
            "stickslip-figure",
            "stickslip-model",
            "stickslip-plane",
            "stickslip-solver",
            "stickslip-studies",
            "stickslip-tracer",
        ],
    ),
    // Tests alone.
    ("repository", &["stickslip-cli", "stickslip-model"]),
];

/// Crates of programs, which no library may use: files, formats of the terminal, progress bars.
const PROGRAM_ONLY: [&str; 6] = ["clap", "csv", "indicatif", "tempfile", "rawzip", "askama"];

#[test]
fn crates_keep_to_the_arrows() {
    let metadata = MetadataCommand::new().current_dir(root()).no_deps().exec().expect("metadata");
    let names: BTreeSet<&str> = metadata.packages.iter().map(|package| &**package.name).collect();
    assert_eq!(names, ARROWS.iter().map(|arrow| arrow.0).collect());
    for package in &metadata.packages {
        let arrows = ARROWS.iter().find(|arrow| arrow.0 == &**package.name).expect("a crate");
        for dependency in &package.dependencies {
            let (from, to) = (&package.name, dependency.name.as_str());
            if names.contains(to) {
                assert!(arrows.1.contains(&to), "{from} must not depend on {to}");
            }
            if &***from != "stickslip-cli" && &***from != "repository" {
                assert!(!PROGRAM_ONLY.contains(&to), "{from} must not depend on {to}");
            }
        }
    }
}
