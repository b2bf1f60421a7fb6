//! Curves as traced: points with tangents, and what ends them.

use crate::family::Point;

/// A point of a boundary with the direction in which the boundary goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// The point, on the boundary to the tolerance of the trace.
    pub point: Point,
    /// Unit tangent.
    pub tangent: Point,
}

/// A piece of a boundary between two vertices, or closed.
///
/// Between two nodes the curve is the cubic that has their points and tangents; tracing keeps its
/// distance from the boundary below the tolerance of interpolation.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve<Label, Margin> {
    /// The margin that vanishes on it.
    pub margin: Margin,
    /// The label on the left of its direction, and the one on the right.
    pub sides: [Label; 2],
    /// Nodes in order, at least two.
    pub nodes: Vec<Node>,
    /// Index of the vertex at which it starts and of the one at which it ends; `None` for both if
    /// it is closed.
    pub ends: Option<[usize; 2]>,
}

/// Where boundaries end or meet.
#[derive(Clone, Debug, PartialEq)]
pub struct Vertex<Margin> {
    /// Where.
    pub point: Point,
    /// What it is.
    pub kind: VertexKind,
    /// Margins that vanish there.
    pub margins: Vec<Margin>,
}

/// What a vertex is. A trace tells the first four apart,
/// [`Network::name_vertices`](crate::Network::name_vertices) all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VertexKind {
    /// A boundary leaves the window.
    WindowEdge,
    /// A corner of the window.
    WindowCorner,
    /// Two or more margins vanish together.
    Crossing,
    /// The margin that vanishes stops to exist: its extremum merges with another one or with the
    /// end of its phase.
    Degenerate,
    /// The minimum of a guard that vanishes reaches the end of the run: the guard's value there
    /// takes over.
    GrazeAtEnd,
    /// Values at the end of the run vanish together, of one phase and of others that begin as it
    /// ends.
    VanishingPhase,
}
