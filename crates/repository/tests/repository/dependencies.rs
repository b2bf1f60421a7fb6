//! What the workspace depends on: under which licences, and with which Rust it builds.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use cargo_metadata::semver::Version;
use cargo_metadata::{DependencyKind, Metadata, MetadataCommand, Package, PackageId};
use expect_test::expect_file;
use spdx::{Expression, LicenseItem, ParseMode};

use crate::root;

/// Licences that ask for nothing but that their text goes along.
const ACCEPTED: [&str; 9] = [
    "0BSD",
    "Apache-2.0",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "MIT",
    "MIT-0",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
];

const ABOUT: &str = "\
# Licences of the dependencies

Every crate in `Cargo.lock`, on whatever platform it is used, with the SPDX expression that it states. Made by

    UPDATE_EXPECT=1 cargo test -p repository

which fails where an expression cannot be met with licences that ask for nothing but that their text goes along.
";

#[test]
fn licences_are_accepted_and_listed() {
    let metadata = metadata();
    let shipped = shipped(&metadata);
    let mut lists = [BTreeMap::new(), BTreeMap::new()];
    for package in foreign(&metadata) {
        let stated = package.license.as_deref();
        let stated = stated.unwrap_or_else(|| panic!("{} states no licence", package.name));
        // Some crates separate alternatives by a slash.
        let expression = Expression::parse_mode(stated, ParseMode::LAX);
        let expression = expression.unwrap_or_else(|error| panic!("{}: {error}", package.name));
        let accepted = expression.evaluate(|requirement| {
            let LicenseItem::Spdx { id, .. } = &requirement.license else { return false };
            ACCEPTED.contains(&id.name)
        });
        assert!(accepted, "{} {} is under {stated}", package.name, package.version);
        let list = &mut lists[usize::from(!shipped.contains(&package.id))];
        let stated = stated.replace('/', " OR ").replace("  ", " ");
        let names: &mut BTreeSet<_> = list.entry(stated).or_default();
        names.insert(package.name.as_str());
    }
    let mut text = ABOUT.to_owned();
    let titles = ["In the libraries and the program", "To build and to test only"];
    for (title, list) in titles.into_iter().zip(lists) {
        assert!(list.len() > 5, "{title}: {list:?}");
        write!(text, "\n## {title}\n\n| licence | crates |\n|---|---|\n").expect("a text");
        for (licence, names) in list {
            let names = Vec::from_iter(names).join(", ");
            writeln!(text, "| {licence} | {names} |").expect("a text");
        }
    }
    expect_file!["../../../../docs/licences.md"].assert_eq(&text);
}

#[test]
fn no_dependency_needs_a_newer_rust() {
    let metadata = metadata();
    let ours: BTreeSet<&Version> =
        metadata.workspace_packages().iter().filter_map(|p| p.rust_version.as_ref()).collect();
    assert_eq!(ours.len(), 1, "{ours:?}");
    for package in foreign(&metadata) {
        let needed = package.rust_version.as_ref();
        assert!(needed <= ours.first().copied(), "{} needs {needed:?}, not {ours:?}", package.name);
    }
}

/// All packages that `Cargo.lock` names.
fn metadata() -> Metadata {
    let mut command = MetadataCommand::new();
    command.current_dir(root()).other_options(vec!["--locked".to_owned()]);
    command.exec().unwrap_or_else(|error| panic!("cargo metadata: {error}"))
}

/// Those that are not of this workspace.
fn foreign(metadata: &Metadata) -> impl Iterator<Item = &Package> {
    metadata.packages.iter().filter(|package| package.source.is_some())
}

/// Those that become part of a library or the program.
fn shipped(metadata: &Metadata) -> BTreeSet<PackageId> {
    let nodes = &metadata.resolve.as_ref().expect("a resolution").nodes;
    let mut found = BTreeSet::new();
    let mut next = metadata.workspace_members.clone();
    while let Some(id) = next.pop() {
        let node = nodes.iter().find(|node| node.id == id).expect("a node for each package");
        for dependency in &node.deps {
            let normal =
                dependency.dep_kinds.iter().any(|kind| kind.kind == DependencyKind::Normal);
            if normal && found.insert(dependency.pkg.clone()) {
                next.push(dependency.pkg.clone());
            }
        }
    }
    found
}
