//! All statements, with the test of each.

use super::statement::{Finding, Statement, Stop};
use super::subject::Subject;
use super::{bounds, counts, course, parameters, regimes, sliding};
use crate::error::ReproductionError;

/// The number of statements.
pub const COUNT: u8 = 25;

/// A statement in other words, its place in the paper, and its test.
struct Entry(&'static str, &'static str, fn(&Subject) -> Result<Finding, Stop>);

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
///
/// # Errors
/// There is no such statement, or a collision cannot be computed.
pub fn test(number: u8, subject: &Subject) -> Result<Statement, ReproductionError> {
    let entry = usize::from(number).checked_sub(1).and_then(|index| ENTRIES.get(index));
    let Entry(paraphrase, place, test) =
        entry.ok_or(ReproductionError::Statement { number, last: COUNT })?;
    let finding = Stop::into_finding(test(subject))?;
    Ok(Statement { number, paraphrase, place, finding })
}
