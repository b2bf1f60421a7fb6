//! Files that options name: an output replaces neither an input nor another output.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use same_file::Handle;

use crate::error::Failure;
use crate::input::source::is_standard_input;
use crate::output::file::target;

/// Refuses two options with their paths, of which the first is an output, if they name the same
/// file.
///
/// # Errors
/// [`Failure::Usage`]: they do.
pub fn require_different(output: (&str, &Path), other: (&str, &Path)) -> Result<(), Failure> {
    if is_standard_input(other.1) || Place::of(output.1) != Place::of(other.1) {
        return Ok(());
    }
    Err(Failure::Usage(format!(
        "{} {} is the same file as {}; expected a file of its own",
        output.0,
        output.1.display(),
        other.0
    )))
}

/// Where a file is, whether it exists or not.
#[derive(Debug)]
struct Place {
    /// The file, if it exists.
    file: Option<Handle>,
    /// Its directory, if that exists.
    directory: Option<Handle>,
    name: Option<OsString>,
    path: PathBuf,
}

impl Place {
    fn of(path: &Path) -> Self {
        let path = target(path);
        let directory = match path.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        Self {
            file: Handle::from_path(&path).ok(),
            directory: Handle::from_path(directory).ok(),
            name: path.file_name().map(OsString::from),
            path,
        }
    }
}

impl PartialEq for Place {
    fn eq(&self, other: &Self) -> bool {
        if let (Some(one), Some(other)) = (&self.file, &other.file) {
            return one == other;
        }
        match (&self.directory, &other.directory) {
            (Some(one), Some(another)) => one == another && self.name == other.name,
            _ => self.path == other.path,
        }
    }
}
