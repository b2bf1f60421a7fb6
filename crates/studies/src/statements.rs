//! The paper's statements, each tested by a computation of its own.
//!
//! A verdict follows from numbers by a rule, so that another model of the spring changes it.
//!
//! Start reading here; then `statement` (what is said of one), `catalogue` (all of them), `spring` and
//! `subject` (what computes), and the tests by topic: `sliding`, `parameters`, `regimes`, `counts`
//! with `line`, `course`, `bounds` with `search`; `report` makes a study of them, `sampling` says which
//! collisions are tried, [`unreset`] is another model of the spring.

mod bounds;
mod catalogue;
mod counts;
mod course;
mod line;
mod parameters;
mod regimes;
mod report;
mod sampling;
mod search;
mod sliding;
mod spring;
mod statement;
mod subject;
pub mod unreset;

use rayon::prelude::*;
use stickslip_plane::progress::{Progress, Report};

use crate::error::StudyError;

pub use catalogue::COUNT;
pub use report::SCHEMA;
pub use spring::Spring;
pub use statement::{Evidence, Finding, Statement, Verdict};

use subject::Subject;

/// The statements with what was found.
#[derive(Debug)]
pub struct Audit {
    /// The model of the spring.
    pub spring: Spring,
    /// In the order in which they were asked for.
    pub statements: Vec<Statement>,
}

/// Tests the statements `numbers`, from 1 to [`COUNT`], on the threads of the current pool.
///
/// # Errors
/// [`StudyError`]: a collision cannot be computed.
///
/// # Panics
/// A number is not from 1 to [`COUNT`].
pub fn run(spring: Spring, numbers: &[u8], progress: Report<'_>) -> Result<Audit, StudyError> {
    progress(Progress::Begin { steps: numbers.len() });
    let subject = Subject::new(spring);
    let test = |&number: &u8| {
        let statement = catalogue::test(number, &subject);
        progress(Progress::Advance { steps: 1 });
        statement
    };
    // All are kept until the end, so that the first failure in order is the one that is reported.
    let statements: Vec<_> = numbers.par_iter().map(test).collect();
    Ok(Audit { spring, statements: statements.into_iter().collect::<Result<_, _>>()? })
}
