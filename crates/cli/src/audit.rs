//! The paper's statements, each tested by a computation of its own.
//!
//! Source of the statements: Schwager, Becker and Pöschel, Eur. Phys. J. E 27, 107 (2008). A
//! verdict follows from numbers by a rule, so that another model of the spring changes it.
//!
//! Start reading here; then `statement` (what is said of one), `catalogue` (all of them), `subject`
//! (what computes), and the tests by topic: `sliding`, `parameters`, `regimes`, `counts` with
//! `line`, `course`, `bounds` with `search`; `report` writes.

mod bounds;
mod catalogue;
mod counts;
mod course;
mod line;
mod parameters;
mod regimes;
mod report;
mod search;
mod sliding;
mod statement;
mod subject;

use std::io::{self, Write};

use indicatif::ProgressBar;
use rayon::ThreadPoolBuilder;
use rayon::prelude::*;

use crate::args::AuditFormat;
use crate::error::Failure;
use crate::plan::StatementsPlan;

pub use catalogue::COUNT;
pub use statement::Statement;
pub use subject::Model;

use subject::Subject;

/// The statements with what was found.
#[derive(Debug)]
pub struct Audit {
    /// The model of the spring.
    pub model: Model,
    /// In the order in which they were asked for.
    pub statements: Vec<Statement>,
}

/// Tests the statements `numbers`, from 1 to [`COUNT`], on the current threads; `bar` advances by
/// one for each.
///
/// # Errors
/// A collision cannot be computed.
pub fn run(model: Model, numbers: &[u8], bar: &ProgressBar) -> Result<Audit, Failure> {
    let subject = Subject::new(model);
    let test = |&number: &u8| {
        let statement = catalogue::test(number, &subject);
        bar.inc(1);
        statement
    };
    // All are kept until the end, so that the first failure in order is the one that is reported.
    let statements: Vec<_> = numbers.par_iter().map(test).collect();
    Ok(Audit { model, statements: statements.into_iter().collect::<Result<_, _>>()? })
}

/// Tests statements and prints them.
///
/// # Errors
/// A collision cannot be computed, or standard output cannot be written.
pub fn print(plan: &StatementsPlan) -> Result<(), Failure> {
    let pool = ThreadPoolBuilder::new().num_threads(plan.threads.unwrap_or(0)).build()?;
    let audit = pool.install(|| run(plan.model, &plan.statements, &ProgressBar::hidden()))?;
    let text = match plan.format {
        AuditFormat::Text => audit.text(),
        AuditFormat::Json => format!("{:#}\n", audit.study().json),
        AuditFormat::Markdown => audit.markdown(),
    };
    Failure::unless_written(io::stdout().lock().write_all(text.as_bytes()))
}
