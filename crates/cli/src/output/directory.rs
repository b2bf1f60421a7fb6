//! Directories for the files of a result.

use std::fs;
use std::path::Path;

use super::file::OutputFile;
use crate::error::Failure;

/// Makes sure that files can be written into `directory`, before there is work to lose. Creates the
/// directory if it is missing.
///
/// # Errors
/// [`Failure::Usage`]: it is not a directory. [`Failure::Output`]: it cannot be created or written.
pub fn prepare(directory: &Path) -> Result<(), Failure> {
    if directory.exists() && !directory.is_dir() {
        let directory = directory.display();
        return Err(Failure::Usage(format!(
            "--out {directory} is not a directory; expected a directory, or a name that is not taken"
        )));
    }
    fs::create_dir_all(directory).map_err(|error| Failure::output(directory, error))?;
    // The user knows the directory, but not the file that is tried.
    OutputFile::create_in(directory, &directory.join("probe")).map(drop).map_err(|failure| {
        match failure {
            Failure::Output { source, .. } => Failure::output(directory, source),
            other => other,
        }
    })
}
