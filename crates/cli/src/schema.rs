//! The names of the layouts of JSON that the program writes. The number at the end rises when a
//! field disappears or changes its meaning.

use stickslip_model::document;
use stickslip_orbits::document as orbits;
use stickslip_plane::{atlas, gaining, stack};
use stickslip_practice::{fit, tables, time_steps};
use stickslip_reproduction::statements;
use stickslip_studies::{contact_laws, convergence, stiff_springs};

/// The layout of the report that `reproduce` writes.
pub const REPORT: &str = "stickslip.report/1";

/// The layout of a run of a system of a user's own.
pub const RUN: &str = "stickslip.run/1";

/// All layouts, those of the libraries included.
pub const ALL: [&str; 18] = [
    document::COLLISION,
    document::IMPACT,
    atlas::SCHEMA,
    stack::SCHEMA,
    gaining::SCHEMA,
    contact_laws::SCHEMA,
    convergence::SCHEMA,
    stiff_springs::SCHEMA,
    statements::SCHEMA,
    tables::SCHEMA,
    time_steps::SCHEMA,
    fit::SCHEMA,
    REPORT,
    RUN,
    orbits::ORBIT,
    orbits::BRANCH,
    orbits::CURVE,
    orbits::REGIONS,
];
