//! Files that options name: an output replaces neither an input nor another output.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::builder::{PathBufValueParser, TypedValueParser};
use same_file::Handle;
use serde::Serialize;
use stickslip_files::input::source::is_standard_input;
use stickslip_files::output::file::{OutputFile, StoredFile, target};
use stickslip_files::output::json;
use stickslip_files::output::picture::{AnimationFile, PictureFile};

use crate::error::Failure;

/// An option that names a file, and the file, if it is given.
pub type Named<'a> = (&'a str, Option<&'a Path>);

/// Refuses an output that is the same file as an input, or as an output before it.
pub fn require_different<'a>(outputs: &[Named<'a>], inputs: &[Named<'a>]) -> Result<(), Failure> {
    let given = |named: &[Named<'a>]| -> Vec<_> {
        named.iter().filter_map(|&(option, path)| Some((option, path?))).collect()
    };
    let (outputs, inputs) = (given(outputs), given(inputs));
    for (index, (option, path)) in outputs.iter().enumerate() {
        let others = inputs.iter().filter(|(_, input)| !is_standard_input(input));
        let mut others = others.chain(&outputs[..index]);
        if let Some((other, _)) = others.find(|(_, other)| Place::of(other) == Place::of(path)) {
            return Err(Failure::Usage(format!(
                "{option} {} is the same file as {other}; expected a file of its own",
                path.display()
            )));
        }
    }
    Ok(())
}

/// Refuses two inputs that are both standard input.
pub fn require_one_standard_input(one: Named<'_>, other: Named<'_>) -> Result<(), Failure> {
    let is_standard = |(_, path): Named<'_>| path.is_some_and(is_standard_input);
    if !(is_standard(one) && is_standard(other)) {
        return Ok(());
    }
    let (one, other) = (one.0, other.0);
    let message = format!("{one} - and {other} - are both standard input; expected one of them");
    Err(Failure::Usage(message))
}

/// Reads the file of a picture, whose name tells its format.
pub fn picture() -> impl TypedValueParser<Value = PictureFile> {
    PathBufValueParser::new().try_map(PictureFile::new)
}

/// Reads the file of an animation.
pub fn animation() -> impl TypedValueParser<Value = AnimationFile> {
    PathBufValueParser::new().try_map(AnimationFile::new)
}

/// The file of a picture as an output.
pub fn plotted(plot: Option<&PictureFile>) -> Named<'_> {
    ("--plot", plot.map(PictureFile::path))
}

/// Writes a document as JSON on one line, with digests, completely except for the name of the file.
pub fn write_json(file: OutputFile, content: &impl Serialize) -> Result<StoredFile, Failure> {
    let line = json::sealed_line(content).map_err(|error| file.failure(error))?;
    Ok(file.finish(&line)?)
}

/// Where a file is, whether it exists or not.
#[derive(Debug)]
struct Place {
    /// The file, if it exists and is a regular one.
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
            // To open a pipe is to wait for its writer, and to lose what it has written.
            file: path.is_file().then(|| Handle::from_path(&path).ok()).flatten(),
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
