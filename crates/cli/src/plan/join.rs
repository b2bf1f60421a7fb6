//! What `join` is to do.

use std::path::PathBuf;

use stickslip_files::input::source::is_standard_input;
use stickslip_files::output::picture::PictureFile;

use super::files::require_different;
use super::map::MapFormat;
use crate::args::JoinArguments;
use crate::error::Failure;

/// Parts of a map that are to be joined.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JoinPlan {
    /// The files of the parts, at least one.
    pub parts: Vec<PathBuf>,
    /// The file of the map.
    pub out: PathBuf,
    /// The format of that file.
    pub format: MapFormat,
    /// The file of a picture, if the map is drawn.
    pub plot: Option<PictureFile>,
}

impl JoinPlan {
    /// The plan that `arguments` make.
    ///
    /// # Errors
    /// [`Failure::Usage`]: an output is one of the parts or has no format, or a part is standard
    /// input.
    pub fn new(arguments: &JoinArguments) -> Result<Self, Failure> {
        let JoinArguments { parts, out, plot } = arguments;
        if parts.iter().any(|part| is_standard_input(part)) {
            let message = "PART -: a part is not read from standard input; expected a file";
            return Err(Failure::Usage(message.to_owned()));
        }
        let picture = plot.as_ref().map(PictureFile::path);
        let inputs: Vec<_> = parts.iter().map(|part| ("PART", Some(&**part))).collect();
        require_different(&[("--out", Some(out)), ("--plot", picture)], &inputs)?;
        let format = MapFormat::of(out)?;
        Ok(Self { parts: parts.clone(), out: out.clone(), format, plot: plot.clone() })
    }
}
