//! Crates depend on each other only along the arrows of docs/architecture.md, and assert the same
//! in every build.

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

use cargo_metadata::MetadataCommand;

use crate::root;
use crate::rust::{code, is_word};

/// The layers of docs/architecture.md from below. A crate may use the crates of all lower layers.
const LAYERS: [&[&str]; 12] = [
    &["stickslip-number", "stickslip-page"],
    &["stickslip-solver"],
    &["stickslip-contact", "stickslip-tracer"],
    &["stickslip-exact", "stickslip-expression"],
    &["stickslip-model", "stickslip-orbits"],
    &["stickslip-plane"],
    &["stickslip-explorer", "stickslip-practice", "stickslip-studies"],
    &["stickslip-figure"],
    &["stickslip-files", "stickslip-reproduction"],
    &["stickslip", "stickslip-cli"],
    &["stickslip-python"],
    // Tests, benches and long batteries alone.
    &["benches", "repository", "validation"],
];

/// Crates that are parts of the program. No library may use them.
const PROGRAM: [&str; 2] = ["stickslip-cli", "stickslip-files"];

/// What has the program in it: the Python package, tests and long batteries.
const WITH_PROGRAM: [&str; 3] = ["repository", "stickslip-python", "validation"];

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
            if !PROGRAM.contains(&from) && !WITH_PROGRAM.contains(&from) {
                assert!(!PROGRAM_ONLY.contains(&to), "{from} must not depend on {to}");
                assert!(!PROGRAM.contains(&to), "{from} must not depend on {to}");
            }
        }
    }
}

/// All sources of a folder.
pub fn sources(folder: PathBuf) -> Vec<PathBuf> {
    let (mut sources, mut folders) = (Vec::new(), vec![folder]);
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                sources.push(path);
            }
        }
    }
    sources
}

/// Tests are compiled without debug assertions (`[profile.dev]`), which would not be seen to fail.
#[test]
fn nothing_is_asserted_in_debug_builds_alone() {
    let crates = fs::read_dir(root().join("crates")).expect("the crates");
    let folders = crates.map(|entry| entry.expect("a crate").path().join("src"));
    let sources: Vec<PathBuf> = folders
        .chain([root().join("src")])
        .filter(|folder| folder.is_dir())
        .flat_map(sources)
        .collect();
    assert!(sources.len() > 100, "{sources:?}");
    for path in sources {
        let text = fs::read_to_string(&path).expect("a source");
        assert!(!text.contains("debug_assert"), "{}", path.display());
    }
}

/// The lint of the workspace is let through there: exports of a page, arrays and addresses that
/// Python hands over, and what the loader calls before the program.
#[test]
fn unsafe_code_stands_in_few_files() {
    let crates = root().join("crates");
    let mut found: Vec<String> = sources(crates.clone())
        .into_iter()
        .filter(|path| {
            let text = code(&fs::read_to_string(path).expect("a source"));
            text.split(|c| !is_word(c)).any(|word| word == "unsafe")
        })
        .map(|path| path.strip_prefix(&crates).expect("below").display().to_string())
        .collect();
    found.sort();
    let expected = [
        "cli/src/main.rs",
        "explorer/examples/unpack.rs",
        "explorer/src/lib.rs",
        "explorer/src/page.rs",
        "python/src/hybrid/function.rs",
        "python/src/hybrid/numbers.rs",
    ];
    assert_eq!(found, expected);
}
