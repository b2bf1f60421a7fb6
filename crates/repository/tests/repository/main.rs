//! What must hold of the repository as a whole: the arrows between crates and between files, names
//! of public types, licences of dependencies, what packages carry, the schema of the files that
//! `impact` reads, and the docs.

mod architecture;
mod circles;
mod dependencies;
mod docs;
mod impact_files;
mod names;
mod packages;
mod rust;

use std::path::{Path, PathBuf};

/// The repository.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}
