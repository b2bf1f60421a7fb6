//! What `reproduce` is to do.

use crate::args::{AuditFormat, ReproduceArguments};
use crate::audit::Model;

/// Statements to be tested.
#[derive(Clone, Debug, PartialEq)]
pub struct ReproducePlan {
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
        let ReproduceArguments { statement, format, model, threads } = arguments;
        Self {
            statements: statement.clone(),
            format: *format,
            model: *model,
            threads: threads.map(usize::from),
        }
    }
}
