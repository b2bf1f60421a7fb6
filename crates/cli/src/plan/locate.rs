//! What `locate` is to do.

use std::path::PathBuf;

use stickslip_files::input::source::is_standard_input;

use super::files::require_different;
use crate::args::LocateArguments;
use crate::error::Failure;

/// Points to be located in an atlas.
#[derive(Clone, Debug, PartialEq)]
pub struct LocatePlan {
    /// The file of the atlas.
    pub atlas: PathBuf,
    /// The file of the points.
    pub input: PathBuf,
    /// The file for the results.
    pub out: PathBuf,
}

impl LocatePlan {
    /// The plan that `arguments` make.
    ///
    /// # Errors
    /// [`Failure::Usage`]: the output is one of the inputs.
    pub fn new(arguments: &LocateArguments) -> Result<Self, Failure> {
        let LocateArguments { atlas, batch, out } = arguments;
        if is_standard_input(atlas) && is_standard_input(batch) {
            let both = "--atlas - and --batch - are both standard input; expected one of them";
            return Err(Failure::Usage(both.to_owned()));
        }
        let inputs = [("--batch", Some(&**batch)), ("--atlas", Some(&**atlas))];
        require_different(&[("--out", Some(out))], &inputs)?;
        Ok(Self { atlas: atlas.clone(), input: batch.clone(), out: out.clone() })
    }
}
