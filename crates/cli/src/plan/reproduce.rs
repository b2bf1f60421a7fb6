//! What `reproduce` is to do.

use std::path::PathBuf;

use stickslip_studies::statements::Spring;

use crate::args::{AuditFormat, ReproduceArguments};

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
    pub spring: Spring,
    /// Number of threads; `None` is one for each core.
    pub threads: Option<u16>,
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
    pub spring: Spring,
    /// Number of threads; `None` is one for each core.
    pub threads: Option<u16>,
}

impl ReproducePlan {
    /// The plan that `arguments` make.
    pub fn new(arguments: &ReproduceArguments) -> Self {
        let ReproduceArguments { out, statement, format, model, threads, cells } = arguments;
        let (spring, threads) = (model.spring(), *threads);
        match out {
            Some(out) => Self::Page(PagePlan {
                out: out.clone(),
                spring,
                threads,
                cells: usize::from(*cells),
            }),
            None => Self::Statements(StatementsPlan {
                statements: statement.clone(),
                format: *format,
                spring,
                threads,
            }),
        }
    }
}
