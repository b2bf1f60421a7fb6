//! Curves in a parameter plane on which the switching of a piecewise-smooth ODE changes, and the subdivision of the plane
//! that they make.
//!
//! In reading order: `family` (what is traced), `curve` (what comes out), `hybrid` (hybrid systems as families).

mod curve;
mod family;
mod hybrid;

pub use curve::{Curve, Node, Vertex, VertexKind};
pub use family::{Family, Point, Window};
pub use hybrid::{FamilyError, FamilyErrorKind, HybridFamily, ModeOf, Problem};
