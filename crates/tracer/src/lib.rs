//! Curves in a parameter plane on which the switching of a piecewise-smooth ODE changes, and the subdivision of the plane
//! that they make.
//!
//! In reading order: `family` (what is traced), `curve` (what comes out).

mod curve;
mod family;

pub use curve::{Curve, Node, Vertex, VertexKind};
pub use family::{Family, Point, Window};
