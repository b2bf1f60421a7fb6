//! Files that options name: an output replaces neither an input nor another output.

use std::fs;
use std::path::{Path, PathBuf};

use crate::error::Failure;

/// Refuses two options with their paths, of which the first is an output, if they name the same
/// file.
///
/// # Errors
/// [`Failure::Usage`]: they do.
pub fn require_different(output: (&str, &Path), other: (&str, &Path)) -> Result<(), Failure> {
    if identity(output.1) != identity(other.1) {
        return Ok(());
    }
    Err(Failure::Usage(format!(
        "{} {} is the same file as {}; expected a file of its own",
        output.0,
        output.1.display(),
        other.0
    )))
}

/// The file that `path` names, whether it exists or not.
fn identity(path: &Path) -> PathBuf {
    if let Ok(existing) = fs::canonicalize(path) {
        return existing;
    }
    let parent = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    match (fs::canonicalize(parent), path.file_name()) {
        (Ok(parent), Some(name)) => parent.join(name),
        _ => path.to_owned(),
    }
}
