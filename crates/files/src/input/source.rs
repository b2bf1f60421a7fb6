//! Files that are read, and standard input, whose name is `-`.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use crate::error::FileError;

/// Something to read.
pub struct Source {
    /// Its bytes.
    pub bytes: Box<dyn Read + Send>,
    /// How many there are, if that is known.
    pub size: Option<u64>,
}

/// Opens the file at `path`.
///
/// # Errors
/// [`FileError::Input`]: it cannot be opened.
pub fn open(path: &Path) -> Result<Source, FileError> {
    if is_standard_input(path) {
        return Ok(Source { bytes: Box::new(io::stdin()), size: None });
    }
    let opened = File::open(path).and_then(|file| Ok((file.metadata()?, file)));
    let (metadata, file) = opened.map_err(|error| unreadable(path, &error))?;
    let size = metadata.is_file().then_some(metadata.len());
    Ok(Source { bytes: Box::new(file), size })
}

/// Reads the file at `path`, which may have so many bytes.
///
/// # Errors
/// [`FileError::Input`]: it cannot be read, or is longer.
pub fn read(path: &Path, most: u64) -> Result<Vec<u8>, FileError> {
    let Source { bytes, .. } = open(path)?;
    let mut text = Vec::new();
    bytes.take(most + 1).read_to_end(&mut text).map_err(|error| unreadable(path, &error))?;
    if text.len() as u64 > most {
        let reason = format!("is longer than {most} bytes; expected a shorter file");
        return Err(FileError::input(shown(path), reason));
    }
    Ok(text)
}

/// The failure to read the file at `path`.
pub fn unreadable(path: &Path, error: &io::Error) -> FileError {
    FileError::input(shown(path), format!("cannot be read: {error}"))
}

/// The name of the file at `path` in messages.
pub fn shown(path: &Path) -> &Path {
    if is_standard_input(path) { Path::new("standard input") } else { path }
}

/// Whether `path` stands for standard input.
pub fn is_standard_input(path: &Path) -> bool {
    path == Path::new("-")
}
