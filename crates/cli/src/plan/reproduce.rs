//! What `reproduce` is to do.

use std::path::PathBuf;

use crate::args::ReproduceArguments;

/// Everything to be computed anew.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReproducePlan {
    /// The directory of the files.
    pub out: PathBuf,
    /// Number of threads; `None` is one for each core.
    pub threads: Option<usize>,
    /// Columns and rows of a map.
    pub cells: usize,
}

impl ReproducePlan {
    /// The plan that `arguments` make.
    pub fn new(arguments: &ReproduceArguments) -> Self {
        Self {
            out: arguments.out.clone(),
            threads: arguments.threads.map(usize::from),
            cells: usize::from(arguments.cells),
        }
    }
}
