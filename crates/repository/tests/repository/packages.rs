//! Each package says what a registry shows of it, and carries its licences.

use std::fs;
use std::path::Path;

use cargo_metadata::{MetadataCommand, Package};

use crate::root;

#[test]
fn every_package_is_complete() {
    let root = root();
    let metadata = MetadataCommand::new().current_dir(&root).no_deps().exec().expect("metadata");
    // A package that is published nowhere has an empty list of registries.
    let published = |package: &&Package| package.publish.as_ref().is_none_or(|to| !to.is_empty());
    assert_eq!(metadata.packages.iter().filter(published).count(), 18);
    for package in metadata.packages.iter().filter(published) {
        let name = package.name.as_str();
        assert!(package.description.as_ref().is_some_and(|text| text.len() > 20), "{name}");
        assert_eq!(package.license.as_deref(), Some("MIT OR Apache-2.0"), "{name}");
        assert_eq!(package.documentation, Some(format!("https://docs.rs/{name}")), "{name}");
        // As many as crates.io takes.
        assert!((1..=5).contains(&package.keywords.len()), "{name}");
        assert!((1..=5).contains(&package.categories.len()), "{name}");
        assert!(package.rust_version.is_some() && !package.authors.is_empty(), "{name}");
        assert!(package.metadata["docs"]["rs"]["targets"].is_array(), "{name}");
        let folder = package.manifest_path.parent().expect("the manifest's folder");
        let readme = fs::read_to_string(folder.join(package.readme.as_ref().expect("a README")));
        assert!(readme.expect("a README").starts_with(&format!("# {name}\n")), "{name}");
        for file in ["LICENSE-MIT", "LICENSE-APACHE"] {
            let read = |folder: &Path| fs::read(folder.join(file)).expect("a licence");
            assert!(read(folder.as_std_path()) == read(&root), "{name}: {file}");
        }
    }
}
