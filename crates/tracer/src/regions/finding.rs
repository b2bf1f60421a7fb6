//! What can be wrong with curves and vertices: findings, and errors in the input.

use std::fmt;

use crate::curve::{Curve, Node, Vertex};
use crate::window::{Point, Window};

/// An inconsistency between curves and vertices, each of which is well formed.
#[derive(Clone, Debug, PartialEq)]
pub enum Finding<Label> {
    /// A curve does not end at its vertex.
    EndAway {
        /// The curve.
        curve: usize,
        /// The vertex.
        vertex: usize,
        /// The distance of the curve's end from the vertex, above the tolerance.
        distance: f64,
    },
    /// A vertex is outside the window, or it is inside although its kind places it on the boundary.
    VertexOffWindow {
        /// The vertex.
        vertex: usize,
    },
    /// A curve ends inside the window at a vertex where no other curve ends.
    Dangling {
        /// The curve.
        curve: usize,
        /// The vertex.
        vertex: usize,
    },
    /// Two curves, or a curve and the window's boundary (`None`), cross where there is no vertex.
    Crossing {
        /// The curves; twice the same one if a curve crosses itself.
        curves: [Option<usize>; 2],
        /// The place of the crossing.
        point: Point,
    },
    /// The curves around a region disagree about its label.
    Labels {
        /// The region.
        region: usize,
        /// A curve with the label of the region, and one with another label.
        curves: [usize; 2],
        /// The labels of these curves.
        labels: [Label; 2],
        /// A vertex at which these curves meet.
        vertex: Option<usize>,
    },
    /// A curve has the same region on both sides, or the outside of the window on one side.
    SidesNotApart {
        /// The curve.
        curve: usize,
        /// The regions on the left and on the right.
        regions: [Option<usize>; 2],
    },
    /// No point of a region was found that is farther than the tolerance from the boundary.
    Thin {
        /// The region.
        region: usize,
        /// The clearance of its sample point.
        clearance: f64,
    },
    /// Euler's formula does not hold.
    Euler(Euler),
}

impl<Label> fmt::Display for Finding<Label> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::EndAway { curve, vertex, distance } => {
                write!(f, "curve {curve} ends {distance:e} away from its vertex {vertex}")
            }
            Self::VertexOffWindow { vertex } => write!(
                f,
                "vertex {vertex} is outside the window, or not on its boundary as its kind says"
            ),
            Self::Dangling { curve, vertex } => {
                write!(f, "curve {curve} ends at vertex {vertex}, where no other curve ends")
            }
            Self::Crossing { curves, point } => {
                write!(f, "curves {curves:?} cross without a vertex at ({}, {})", point.x, point.y)
            }
            Self::Labels { region, curves, vertex, .. } => write!(
                f,
                "curves {curves:?} disagree about the label of region {region} (common vertex \
                 {vertex:?})"
            ),
            Self::SidesNotApart { curve, regions } => write!(
                f,
                "curve {curve} does not separate two regions; on its sides are {regions:?}"
            ),
            Self::Thin { region, clearance } => {
                write!(
                    f,
                    "region {region} is not wider than the tolerance (clearance {clearance:e})"
                )
            }
            Self::Euler(euler) => write!(f, "Euler's formula does not hold: {euler:?}"),
        }
    }
}

/// The counts of Euler's formula for plane graphs, V − E + F = 1 + C.
///
/// Vertices, edges and components are counted in the graph, and faces in the plane. The formula is
/// therefore a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Euler {
    /// The number of vertices with an edge, including corners of the window, and one for every
    /// closed curve.
    pub vertices: usize,
    /// The number of curves and of parts of the window's boundary.
    pub edges: usize,
    /// The number of regions, and one for the outside.
    pub faces: usize,
    /// The number of connected components of the graph.
    pub components: usize,
}

impl Euler {
    /// Whether V − E + F = 1 + C.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.vertices + self.faces == 1 + self.components + self.edges
    }
}

/// Input from which no subdivision can be made, or with which none can be verified.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SubdivisionError {
    /// The window's corners are not finite, or not in order.
    #[error("the window from ({}, {}) to ({}, {}) has no area", low.x, low.y, high.x, high.y)]
    Window {
        /// The corner that should have the least coordinates.
        low: Point,
        /// The corner that should have the greatest.
        high: Point,
    },
    /// The tolerance is not a small positive number.
    #[error(
        "the tolerance is {value}, expected above 0 and below a thousandth of the window's sides"
    )]
    Tolerance {
        /// The value that was given.
        value: f64,
    },
    /// A curve has too few nodes.
    #[error("curve {curve} has {count} nodes, expected at least two")]
    Nodes {
        /// The curve.
        curve: usize,
        /// The number of its nodes.
        count: usize,
    },
    /// A curve is a single point.
    #[error("curve {curve} has no length")]
    NoLength {
        /// The curve.
        curve: usize,
    },
    /// A node is not finite, or its tangent is not of length 1.
    #[error("node {node} of curve {curve} is not a finite point with a tangent of length 1")]
    Node {
        /// The curve.
        curve: usize,
        /// The node.
        node: usize,
    },
    /// A vertex is not finite.
    #[error("vertex {vertex} is not finite")]
    Vertex {
        /// The vertex.
        vertex: usize,
    },
    /// A curve ends at a vertex that does not exist.
    #[error("curve {curve} ends at vertex {vertex}, but there are only {count} vertices")]
    End {
        /// The curve.
        curve: usize,
        /// The index that was given.
        vertex: usize,
        /// The number of vertices.
        count: usize,
    },
    /// The distances from curves are not finite, not above 0, or not in order.
    #[error(
        "distances from {nearest:e} to {farthest:e}, expected finite values above 0 in ascending order"
    )]
    Distances {
        /// The least distance.
        nearest: f64,
        /// The greatest distance.
        farthest: f64,
    },
    /// The numbers of labels and of points differ.
    #[error("{labels} labels for {points} points, expected one for each")]
    Labels {
        /// The number of points.
        points: usize,
        /// The number of labels.
        labels: usize,
    },
}

impl SubdivisionError {
    /// Checks the input of a subdivision.
    pub(crate) fn check<Label, Margin>(
        window: &Window,
        curves: &[Curve<Label, Margin>],
        vertices: &[Vertex<Margin>],
        tolerance: f64,
    ) -> Result<(), Self> {
        let finite = |point: &Point| point.iter().all(|coordinate| coordinate.is_finite());
        let (low, high) = (window.low, window.high);
        if !(finite(&low) && finite(&high) && low.x < high.x && low.y < high.y) {
            return Err(Self::Window { low, high });
        }
        if !(tolerance > 0.0 && tolerance < 1e-3 * (high - low).min()) {
            return Err(Self::Tolerance { value: tolerance });
        }
        if let Some(vertex) = vertices.iter().position(|vertex| !finite(&vertex.point)) {
            return Err(Self::Vertex { vertex });
        }
        for (index, curve) in curves.iter().enumerate() {
            if curve.nodes.len() < 2 {
                return Err(Self::Nodes { curve: index, count: curve.nodes.len() });
            }
            let good =
                |node: &Node| finite(&node.point) && (node.tangent.norm() - 1.0).abs() < 1e-6;
            if let Some(node) = curve.nodes.iter().position(|node| !good(node)) {
                return Err(Self::Node { curve: index, node });
            }
            let mut ends = curve.ends.into_iter().flatten();
            if let Some(vertex) = ends.find(|&vertex| vertex >= vertices.len()) {
                return Err(Self::End { curve: index, vertex, count: vertices.len() });
            }
        }
        Ok(())
    }
}
