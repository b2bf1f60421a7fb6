//! The paper's statements, each tested by a computation of its own.
//!
//! A verdict follows from numbers by a rule, so that another model of the spring changes it. A
//! collision that cannot be computed is an error of the whole audit. A doubt about boundaries is
//! not: it is the verdict "cannot be decided".
//!
//! Start reading here; then, in this order: `statement` (what is said of one, and which collisions
//! are tried), [`Spring`] (two models of the spring; the second one is
//! [`unreset`](stickslip_studies::unreset)), `subject` (what all tests share), `line` (all
//! boundaries at one stiffness), the tests by topic: `sliding`, `parameters`, `regimes`, `counts`,
//! `course`, `bounds`; and `report` (a study of them).

use rayon::prelude::*;
use stickslip_plane::progress::{Progress, Report};

use crate::error::ReproductionError;
use statement::Stop;
use subject::Subject;

mod bounds;
mod counts;
mod course;
mod line;
mod parameters;
mod regimes;
mod report;
mod sliding;
mod spring;
mod statement;
mod subject;

pub use report::{SCHEMA, TITLE};
pub use spring::Spring;
pub use statement::{Evidence, Statement, StatementFinding, StatementVerdict};

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
        let statement = tested(number, subject);
        progress(Progress::Advance { steps: 1 });
        statement
    };
    // All are kept until the end, so that the first failure in order is the one that is reported.
    let statements: Vec<_> = numbers.par_iter().map(test).collect();
    statements.into_iter().collect()
}

/// The number of statements.
pub const COUNT: u8 = 25;

/// A statement in other words, its place in the paper, and its test.
struct Entry(&'static str, &'static str, fn(&Subject) -> Result<StatementFinding, Stop>);

#[rustfmt::skip]
const ENTRIES: [Entry; COUNT as usize] = [
    Entry("With Coulomb friction alone, ε_t = max(0, 1 - μ(1 + ε_n)/α g_n/g_t), whatever the normal law.",
        "(15), (16)", sliding::closed_form),
    Entry("Three independent parameters describe the collision.", "(21)-(24)", parameters::three),
    Entry("The motion always starts in the Coulomb regime.", "(9), (10)", regimes::start),
    Entry("The motion ends in the Coulomb regime, unless g_t = 0.", "(9), (10)", regimes::end),
    Entry("The number of switches is even.", "(9), (10)", regimes::parity),
    Entry("At κ = 18, μ = 0.4, α = 2/7 there are up to eight switches.", "Figs. 4, 5", counts::eight),
    Entry("The motion reverses half as many times as there are switches.", "Fig. 5", counts::reversals),
    Entry("As g_t/g_n falls, the number of switches falls with brief rises by two.", "Fig. 5 j", counts::rises),
    Entry("Above about g_t/g_n = 3 sliding is pure, except for very small κ.", "Figs. 3, 4", sliding::above_three),
    Entry("The true limit of pure sliding lies below g_t/g_n = 2μ/α.", "(16)", sliding::true_limit),
    Entry("For small κ there is always a switch: the boundary is a vertical line.", "Fig. 4", sliding::vertical_line),
    Entry("The largest elongation of the spring is μ/(ακ), and |ε_t| at most (g_n/g_t) μ/(α√κ).",
        "(25)-(27)", bounds::largest),
    Entry("For stiff springs ε_t tends to 0.", "(27)", bounds::stiff),
    Entry("In the range (30) ε_t is close to zero.", "(30)", bounds::close_to_zero),
    Entry("In the pragmatic model max(const, 1 - ...) const = 0 is the only sensible choice.", "Section 4", bounds::pragmatic),
    Entry("Steel spheres with Y = 210 MPa have ζ = 1.109e5 m s²/kg / k_t.", "Footnote 2", sliding::footnote_2),
    Entry("With damping some collisions end in the spring regime.", "Footnote 3", regimes::damped_end),
    Entry("Damping changes quantities only, not how a collision goes.", "Footnote 3", regimes::damping),
    Entry("At κ = 100, g_t/g_n = 0.3 there are many sliding episodes, and the velocity has its first minimum shortly after t = 1.",
        "Fig. 6", course::figure_6),
    Entry("Without damping, energy is lost only while sliding.", "(26)", regimes::energy),
    Entry("At b, c, d all switches fall in the decompression, at e the first one just before the largest compression.",
        "Fig. 5 b-e", counts::decompression),
    Entry("The spring's elongation at the first switch grows as g_t/g_n falls.", "Fig. 5", course::first_elongation),
    Entry("ε_t is negative after an odd number of reversals of the motion, positive after an even one.", "Fig. 5", counts::signs),
    Entry("For a small enough g_t/g_n there are two switches.", "Fig. 5 o", counts::small_ratio),
    Entry("Two steel spheres have a negative ε_t at small g_t, down to -0.6.", "Fig. 2", bounds::steel),
];

/// Tests statement `number`, from 1 to [`COUNT`].
fn tested(number: u8, subject: &Subject) -> Result<Statement, ReproductionError> {
    let entry = usize::from(number).checked_sub(1).and_then(|index| ENTRIES.get(index));
    let Entry(paraphrase, place, test) =
        entry.ok_or(ReproductionError::Statement { number, last: COUNT })?;
    let finding = Stop::into_finding(test(subject))?;
    Ok(Statement { number, paraphrase, place, finding })
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
            assert_eq!(finding.verdict, StatementVerdict::CannotBeDecided, "{number}");
            assert_eq!(finding.explanation, "two boundaries are one");
        }
        // Statement 10 has the boundaries only as further evidence.
        let statements = test(&with_lines(doubt), &[10], SILENT).unwrap();
        assert_eq!(statements[0].finding.verdict, StatementVerdict::DoesNotHold);
    }

    #[test]
    fn a_collision_that_fails_in_a_single_statement_keeps_its_parameters() {
        let failure = || -> Result<StatementFinding, Stop> {
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
