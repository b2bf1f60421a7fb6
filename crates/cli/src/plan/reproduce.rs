//! What `reproduce` is to do.

use std::path::PathBuf;

use crate::args::{AuditFormat, ReproduceArguments};
use crate::audit::Model;

/// Everything, or statements alone.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ReproducePlan {
    /// A page.
    Page(PagePlan),
    /// Standard output.
    Statements(StatementsPlan),
}

/// Everything to be computed anew.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PagePlan {
    /// The directory of the files.
    pub out: PathBuf,
    /// The model of the spring of which the statements are tested.
    pub model: Model,
    /// Number of threads; `None` is one for each core.
    pub threads: Option<usize>,
    /// Columns and rows of a map.
    pub cells: usize,
}

/// Statements to be tested.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StatementsPlan {
    /// Their numbers.
    pub statements: Vec<u8>,
    /// How they are printed.
    pub format: AuditFormat,
    /// The model of the spring.
    pub model: Model,
    /// Number of threads; `None` is one for each core.
    pub threads: Option<usize>,
}

impl ReproducePlan {
    /// The plan that `arguments` make.
    pub fn new(arguments: &ReproduceArguments) -> Self {
        let ReproduceArguments { out, statement, format, model, threads, cells } = arguments;
        let (model, threads) = (*model, threads.map(usize::from));
        match out {
            Some(out) => Self::Page(PagePlan {
                out: out.clone(),
                model,
                threads,
                cells: usize::from(*cells),
            }),
            None => Self::Statements(StatementsPlan {
                statements: statement.clone(),
                format: *format,
                model,
                threads,
            }),
        }
    }
}
