//! Columns that tables of several figures have.

use stickslip_studies::Column;

pub const AXIS: Column = Column::headed("axis", "axis", "the reading of the axis of stiffness");
pub const KAPPA: Column = Column::headed("kappa", "κ", "κ of (24)");
pub const RATIO: Column = Column::headed("ratio", "g_t/g_n", "impact ratio g_t/g_n");
pub const POINT: Column = Column::headed("point", "point", "point of Figure 4");
pub const SWITCHES: Column = Column::headed("switch_count", "switches", "number of switches");
pub const PHASES: Column =
    Column::headed("itinerary", "phases", "the phases, one character for each");
pub const EPS_T: Column = Column::headed("eps_t", "ε_t", "tangential restitution ε_t");

/// The course of a collision in time.
pub const COURSE: [Column; 4] = [
    Column::new("time", "scaled time"),
    Column::new("normal_force", "F_n in units of m β^{2/5} g_n^{6/5}"),
    Column::new("tangential_force", "F_t/μ in the same units"),
    Column::new("velocity", "w = (α/μ) g_t/g_n"),
];
