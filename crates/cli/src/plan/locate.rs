//! What `locate` is to do.

use std::path::PathBuf;

use crate::args::LocateArguments;
use crate::error::Failure;
use crate::plan::require_different;

/// Points to be located.
#[derive(Clone, Debug, PartialEq)]
pub struct LocatePlan {
    /// The atlas.
    pub atlas: PathBuf,
    /// Where the points are.
    pub input: PathBuf,
    /// Where the results go.
    pub out: PathBuf,
}

impl LocatePlan {
    /// The plan that `arguments` make.
    ///
    /// # Errors
    /// [`Failure::Usage`]: the output is one of the inputs.
    pub fn new(arguments: &LocateArguments) -> Result<Self, Failure> {
        let LocateArguments { atlas, batch, out } = arguments;
        require_different(("--out", out), ("--batch", batch))?;
        require_different(("--out", out), ("--atlas", atlas))?;
        Ok(Self { atlas: atlas.clone(), input: batch.clone(), out: out.clone() })
    }
}
