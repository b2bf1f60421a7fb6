//! Curves as a trace returns them: nodes with tangents, between vertices.

use crate::window::Point;

/// A point of a boundary, with the boundary's direction there.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Node {
    /// The point, which lies on the boundary to the tolerance of the trace.
    pub point: Point,
    /// The unit tangent.
    pub tangent: Point,
}

/// A piece of a boundary between two vertices, or a closed boundary.
///
/// Between two nodes the curve is the cubic with their points and tangents,
/// [`Cubic::between`](crate::Cubic::between). The trace keeps the distance of the cubic from the
/// boundary below [`interpolation`](crate::TraceOptions::interpolation), except next to a vertex
/// whose place is known less accurately.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Curve<Label, Margin> {
    /// The margin that vanishes on the curve.
    pub margin: Margin,
    /// The labels on the left and on the right, seen in the direction of the curve.
    pub sides: [Label; 2],
    /// The nodes in order, at least two.
    pub nodes: Vec<Node>,
    /// The indices of the vertices at which the curve starts and ends; `None` if it is closed.
    pub ends: Option<[usize; 2]>,
}

/// A place where boundaries end or meet.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Vertex<Margin> {
    /// The place.
    pub point: Point,
    /// What kind of place it is.
    pub kind: VertexKind,
    /// The margins that vanish there.
    pub margins: Vec<Margin>,
}

/// The kind of a vertex.
///
/// A trace distinguishes the first four kinds. For hybrid systems,
/// [`Network::name_vertices`](crate::tracing::Network::name_vertices) distinguishes all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum VertexKind {
    /// A boundary leaves the window.
    WindowEdge,
    /// A corner of the window.
    WindowCorner,
    /// Two or more margins vanish together.
    Crossing,
    /// The margin that vanishes ceases to exist: its extremum merges with another one, or reaches
    /// the end of its phase.
    Degenerate,
    /// The minimum that vanishes reaches the end of the run. Beyond the vertex the value of the
    /// guard at the end vanishes instead.
    GrazeAtEnd,
    /// Values at the end of the run vanish together: the value of one phase, and the values of
    /// phases that begin where it ends.
    VanishingPhase,
}

impl VertexKind {
    /// Its name, as in files of collisions and in Python.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::WindowEdge => "window-edge",
            Self::WindowCorner => "window-corner",
            Self::Crossing => "crossing",
            Self::Degenerate => "degenerate",
            Self::GrazeAtEnd => "graze-at-end",
            Self::VanishingPhase => "vanishing-phase",
        }
    }

    /// Whether the vertex is on an edge of the window or in a corner.
    #[must_use]
    pub fn is_on_window(self) -> bool {
        matches!(self, Self::WindowEdge | Self::WindowCorner)
    }
}
