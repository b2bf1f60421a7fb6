//! What `reproduce` is to do.

use std::path::PathBuf;

use stickslip_reproduction::statements::Spring;

use crate::args::{AuditFormat, ReproduceArguments};

/// The plan of `reproduce`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ReproducePlan {
    /// Everything is computed and shown on a page.
    Page(PagePlan),
    /// Statements alone are tested and printed.
    Statements(StatementsPlan),
}

/// A page with everything.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PagePlan {
    /// The directory of the files.
    pub out: PathBuf,
    /// The model of the spring for which the statements are tested.
    pub spring: Spring,
    /// The number of threads; `None` is one for each core.
    pub threads: Option<u16>,
    /// The number of columns and rows of each map.
    pub cells: usize,
}

/// Statements to be tested.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StatementsPlan {
    /// The numbers of the statements.
    pub statements: Vec<u8>,
    /// How they are printed.
    pub format: AuditFormat,
    /// The model of the spring.
    pub spring: Spring,
    /// The number of threads; `None` is one for each core.
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
