//! Directories for the files of a result.

use std::fs;
use std::path::Path;

use super::file::OutputFile;
use crate::error::FileError;

/// Makes sure that files can be written into `directory`, before there is work to lose. Creates the
/// directory if it is missing.
///
/// # Errors
/// [`FileError::Option`]: it is not a directory. [`FileError::Output`]: it cannot be created or
/// written.
pub fn prepare(directory: &Path) -> Result<(), FileError> {
    if directory.exists() && !directory.is_dir() {
        let directory = directory.display();
        return Err(FileError::Option(format!(
            "--out {directory} is not a directory; expected a directory, or a name that is not taken"
        )));
    }
    fs::create_dir_all(directory).map_err(|error| FileError::output(directory, error))?;
    // The user knows the directory, but not the file that is tried.
    OutputFile::create_in(directory, &directory.join("probe")).map(drop).map_err(|failure| {
        match failure {
            FileError::Output { source, .. } => FileError::output(directory, source),
            other => other,
        }
    })
}
