//! Curves in a parameter plane on which the switching of a piecewise-smooth ODE changes, and the subdivision of the plane
//! that they make.
//!
//! In reading order: `family` (what is traced), `curve` (what comes out), `runs` (hybrid systems as families).

mod curve;
mod family;
mod runs;

pub use curve::{Curve, Node, Vertex, VertexKind};
pub use family::{Family, Point, Window};
pub use runs::{ModeOf, Problem, Runs, RunsError, RunsErrorKind};
