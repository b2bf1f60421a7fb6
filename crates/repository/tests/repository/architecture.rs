//! Crates depend on each other only along the arrows of docs/architecture.md.

use std::collections::BTreeSet;

use cargo_metadata::MetadataCommand;

use crate::root;

/// The layers of docs/architecture.md from below. A crate may use the crates of all lower layers.
const LAYERS: [&[&str]; 8] = [
    &["stickslip-solver"],
    &["stickslip-model", "stickslip-tracer"],
    &["stickslip-plane"],
    &["stickslip-figure"],
    &["stickslip-practice", "stickslip-studies"],
    &["stickslip-reproduction"],
    &["stickslip", "stickslip-cli", "stickslip-python"],
    // Tests and long batteries alone.
    &["repository", "validation"],
];

/// Crates of programs, which no library may use: files, formats of the terminal, progress bars.
const PROGRAM_ONLY: [&str; 6] = ["clap", "csv", "indicatif", "tempfile", "rawzip", "askama"];

#[test]
fn crates_keep_to_the_arrows() {
    let metadata = MetadataCommand::new().current_dir(root()).no_deps().exec().expect("metadata");
    let names: BTreeSet<&str> = metadata.packages.iter().map(|package| &**package.name).collect();
    let named: BTreeSet<&str> = LAYERS.into_iter().flatten().copied().collect();
    assert_eq!(names, named);
    let layer = |name: &str| LAYERS.iter().position(|layer| layer.contains(&name));
    for package in &metadata.packages {
        let from = &**package.name;
        for to in package.dependencies.iter().map(|dependency| dependency.name.as_str()) {
            if names.contains(to) {
                assert!(layer(to) < layer(from), "{from} must not depend on {to}");
            }
            if !matches!(from, "stickslip-cli" | "repository") {
                assert!(!PROGRAM_ONLY.contains(&to), "{from} must not depend on {to}");
            }
        }
    }
}
