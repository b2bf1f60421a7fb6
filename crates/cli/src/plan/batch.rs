//! The files of a batch.

use std::path::PathBuf;

use super::files::{Named, require_different};
use crate::args::BatchArguments;
use crate::error::Failure;

/// A file with a case in each row, and the files for the results.
#[derive(Clone, Debug, PartialEq)]
pub struct BatchFiles {
    /// The file of the cases.
    pub input: PathBuf,
    /// The file for the results.
    pub out: PathBuf,
    /// The file for the switches, if they are wanted.
    pub events: Option<PathBuf>,
    /// The number of threads; `None` is one for each core.
    pub threads: Option<u16>,
}

impl BatchFiles {
    /// The files that `arguments` name, beside other inputs; `None` without a batch.
    ///
    /// # Errors
    /// [`Failure::Usage`]: an output is an input, or the other output.
    pub fn new(arguments: &BatchArguments, inputs: &[Named]) -> Result<Option<Self>, Failure> {
        let BatchArguments { batch, out, events, threads } = arguments;
        let (Some(input), Some(out)) = (batch, out) else { return Ok(None) };
        let inputs: Vec<Named> =
            [("--batch", Some(&**input))].into_iter().chain(inputs.iter().copied()).collect();
        require_different(&[("--out", Some(out)), ("--events", events.as_deref())], &inputs)?;
        let (input, out) = (input.clone(), out.clone());
        Ok(Some(Self { input, out, events: events.clone(), threads: *threads }))
    }
}
