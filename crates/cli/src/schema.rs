//! The layouts of the JSON that the program writes. A number rises when a field goes or changes its
//! meaning.

use stickslip_plane::atlas;
use stickslip_studies::{convergence, statements, stiff_springs};

/// A collision.
pub const COLLISION: &str = "stickslip.collision/1";
/// An impact in SI units.
pub const IMPACT: &str = "stickslip.impact/1";
/// Everything that `reproduce` computes.
pub const REPORT: &str = "stickslip.report/1";

/// All of them.
pub const ALL: [&str; 7] = [
    COLLISION,
    IMPACT,
    atlas::SCHEMA,
    convergence::SCHEMA,
    stiff_springs::SCHEMA,
    statements::SCHEMA,
    REPORT,
];
