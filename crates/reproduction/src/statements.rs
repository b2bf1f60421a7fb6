//! The paper's statements, each tested by a computation of its own.
//!
//! A verdict follows from numbers by a rule, so that another model of the spring changes it. A
//! collision that cannot be computed is an error of the whole audit. A doubt about boundaries is
//! not: it is the verdict "cannot be decided".
//!
//! Start reading here; then, in this order: `statement` (what is said of one), `catalogue` (all of
//! them), [`Spring`] (two models of the spring; the second one is
//! [`unreset`](stickslip_studies::unreset)), `subject` (what all tests share), `line` (all
//! boundaries at one stiffness), `sampling` (which collisions are tried), the tests by topic:
//! `sliding`, `parameters`, `regimes`, `counts`, `course`, `bounds`; and `report` (a study of
//! them).

mod bounds;
mod catalogue;
mod counts;
mod course;
mod line;
mod parameters;
mod regimes;
mod report;
mod sampling;
mod sliding;
mod spring;
mod statement;
mod subject;

use rayon::prelude::*;
use stickslip_plane::progress::{Progress, Report};

use crate::error::ReproductionError;

pub use catalogue::COUNT;
pub use report::{SCHEMA, TITLE};
pub use spring::Spring;
pub use statement::{Evidence, Finding, Statement, Verdict};

use subject::Subject;

/// The statements with what was found.
#[derive(Debug)]
pub struct Audit {
    /// The model of the spring.
    pub spring: Spring,
    /// The statements, in the order in which they were asked for.
    pub statements: Vec<Statement>,
}

/// Tests the statements `numbers`, from 1 to [`COUNT`], on the threads of the current pool.
///
/// # Errors
/// [`ReproductionError`]: a number is not from 1 to [`COUNT`], or a collision cannot be computed.
pub fn run(
    spring: Spring,
    numbers: &[u8],
    progress: Report<'_>,
) -> Result<Audit, ReproductionError> {
    Ok(Audit { spring, statements: test(&Subject::new(spring), numbers, progress)? })
}

fn test(
    subject: &Subject,
    numbers: &[u8],
    progress: Report<'_>,
) -> Result<Vec<Statement>, ReproductionError> {
    progress(Progress::Begin { steps: numbers.len() });
    let test = |&number: &u8| {
        let statement = catalogue::test(number, subject);
        progress(Progress::Advance { steps: 1 });
        statement
    };
    // All are kept until the end, so that the first failure in order is the one that is reported.
    let statements: Vec<_> = numbers.par_iter().map(test).collect();
    statements.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use stickslip_model::{CollisionError, CollisionFailure, exact};
    use stickslip_plane::atlas::AtlasError;
    use stickslip_plane::progress::SILENT;

    use super::line::{Line, line};
    use super::statement::Stop;
    use super::*;

    /// Beyond the stiffness that the exact solution accepts.
    const TOO_STIFF: f64 = 2e16;

    fn with_lines(line: impl Fn() -> Result<Line, Stop>) -> Subject {
        Subject::with_lines(Spring::Reset, [line(), line()])
    }

    #[test]
    fn a_line_without_collisions_fails_and_is_not_in_doubt() {
        let Err(Stop::Failed(error)) = line(Spring::Reset, TOO_STIFF) else { panic!("a line") };
        assert!(matches!(*error, ReproductionError::Atlas(AtlasError::Run { .. })), "{error}");
        assert!(error.to_string().contains("out of the range of the exact solution"), "{error}");
        // Without an exact solution the samples fail.
        let Err(Stop::Failed(error)) = line(Spring::Unreset, -1.0) else { panic!("a line") };
        assert!(matches!(*error, ReproductionError::Parameter(_)), "{error}");
    }

    /// Statements 6, 7, 8, 10 and 21 use the lines; statement 4 does not.
    #[test]
    fn a_line_that_fails_is_an_error_of_the_audit() {
        let subject = with_lines(|| line(Spring::Reset, TOO_STIFF));
        for number in [6, 7, 8, 10, 21] {
            let error = test(&subject, &[number], SILENT).unwrap_err();
            assert!(matches!(error, ReproductionError::Shared(_)), "{number}: {error}");
        }
        let error = test(&subject, &[4, 7, 16], SILENT).unwrap_err();
        assert!(error.to_string().contains("out of the range"), "{error}");
        assert!(test(&subject, &[4, 16], SILENT).is_ok());
    }

    #[test]
    fn a_doubt_about_boundaries_is_a_verdict() {
        let doubt = || Err(Stop::Open("two boundaries are one".to_owned()));
        let statements = test(&with_lines(doubt), &[6, 7, 8, 21], SILENT).unwrap();
        for Statement { number, finding, .. } in &statements {
            assert_eq!(finding.verdict, Verdict::CannotBeDecided, "{number}");
            assert_eq!(finding.explanation, "two boundaries are one");
        }
        // Statement 10 has the boundaries only as further evidence.
        let statements = test(&with_lines(doubt), &[10], SILENT).unwrap();
        assert_eq!(statements[0].finding.verdict, Verdict::DoesNotHold);
    }

    #[test]
    fn a_collision_that_fails_in_a_single_statement_keeps_its_parameters() {
        let failure = || -> Result<Finding, Stop> {
            Spring::Reset.collide(TOO_STIFF, 1.0, 0.0)?;
            unreachable!("the collision is out of range")
        };
        let error = statement::Stop::into_finding(failure()).unwrap_err();
        let ReproductionError::Collision(CollisionFailure { kappa, source, .. }) = error else {
            panic!("{error}")
        };
        assert_eq!(kappa, TOO_STIFF);
        let domain = matches!(source, CollisionError::Exact(exact::ExactError::Domain(_)));
        assert!(domain, "{source}");
    }
}
