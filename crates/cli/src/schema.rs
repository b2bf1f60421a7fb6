//! The layouts of the JSON that the program writes. A number rises when a field goes or changes its
//! meaning.

/// A collision.
pub const COLLISION: &str = "stickslip.collision/1";
/// An impact in SI units.
pub const IMPACT: &str = "stickslip.impact/1";
/// An atlas.
pub const ATLAS: &str = "stickslip.atlas/1";
/// The study of convergence.
pub const CONVERGENCE: &str = "stickslip.convergence/1";
/// The study of stiff springs.
pub const ASYMPTOTE: &str = "stickslip.asymptote/1";
/// Statements of the paper.
pub const AUDIT: &str = "stickslip.audit/1";
/// Everything that `reproduce` computes.
pub const REPORT: &str = "stickslip.report/1";

/// All of them.
pub const ALL: [&str; 7] = [COLLISION, IMPACT, ATLAS, CONVERGENCE, ASYMPTOTE, AUDIT, REPORT];
