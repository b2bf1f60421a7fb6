//! What can be wrong with curves and vertices.

use crate::curve::{Curve, Vertex};
use crate::window::{Point, Window};

/// Something inconsistent in curves that are each well formed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Finding<Label> {
    /// A curve does not end at its vertex.
    #[error("curve {curve} ends {distance:e} away from its vertex {vertex}")]
    EndAway {
        /// The curve.
        curve: usize,
        /// The vertex.
        vertex: usize,
        /// Their distance, above the tolerance.
        distance: f64,
    },
    /// A vertex is outside the window, or inside although its kind says that it is on the boundary.
    #[error("vertex {vertex} is not on the window's boundary, or outside")]
    VertexOffWindow {
        /// The vertex.
        vertex: usize,
    },
    /// A curve ends where nothing else begins.
    #[error("curve {curve} ends at vertex {vertex}, where nothing goes on")]
    Dangling {
        /// The curve.
        curve: usize,
        /// The vertex.
        vertex: usize,
    },
    /// Two curves, or a curve and the window's boundary (`None`), cross where there is no vertex.
    #[error("curves {curves:?} cross without a vertex at ({}, {})", point.x, point.y)]
    Crossing {
        /// The curves; twice the same if a curve crosses itself.
        curves: [Option<usize>; 2],
        /// Where.
        point: Point,
    },
    /// The curves around a region disagree about its label.
    #[error(
        "curves {curves:?} disagree about the label of region {region} (common vertex {vertex:?})"
    )]
    Labels {
        /// The region.
        region: usize,
        /// A curve with the region's label, and one without.
        curves: [usize; 2],
        /// Their labels.
        labels: [Label; 2],
        /// A vertex at which they meet.
        vertex: Option<usize>,
    },
    /// A curve has the same region on both sides, or the outside on one.
    #[error("curve {curve} has on its sides the regions {regions:?}")]
    SidesNotApart {
        /// The curve.
        curve: usize,
        /// The regions on its left and right.
        regions: [Option<usize>; 2],
    },
    /// No place was found in a region that is farther than the tolerance from its boundary.
    #[error("region {region} is nowhere wider than the tolerance (clearance {clearance:e})")]
    Thin {
        /// The region.
        region: usize,
        /// The clearance of its sample point.
        clearance: f64,
    },
    /// Euler's formula does not hold.
    #[error("Euler's formula does not hold: {0:?}")]
    Euler(Euler),
}

/// The counts of Euler's formula for plane graphs, V − E + F = 1 + C.
///
/// Vertices, edges and components are counted in the graph, faces in the plane, so that the formula
/// is a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Euler {
    /// Vertices with an edge, corners of the window among them; one for every closed curve.
    pub vertices: usize,
    /// Curves, and parts of the window's boundary.
    pub edges: usize,
    /// Regions, and the outside.
    pub faces: usize,
    /// Connected components of the graph.
    pub components: usize,
}

impl Euler {
    /// Whether V − E + F = 1 + C.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.vertices + self.faces == 1 + self.components + self.edges
    }
}

/// Input from which nothing can be made.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
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
    #[error("the tolerance {value} must be above 0 and below a thousandth of the window's sides")]
    Tolerance {
        /// The value given.
        value: f64,
    },
    /// A curve has too few nodes.
    #[error("curve {curve} has {count} nodes; at least two are needed")]
    Nodes {
        /// The curve.
        curve: usize,
        /// How many it has.
        count: usize,
    },
    /// All of a curve is one point.
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
    /// A curve ends at a vertex that there is not.
    #[error("curve {curve} ends at vertex {vertex}; there are {count}")]
    End {
        /// The curve.
        curve: usize,
        /// The index given.
        vertex: usize,
        /// How many vertices there are.
        count: usize,
    },
}

impl SubdivisionError {
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
            let good = |node: &crate::curve::Node| {
                finite(&node.point) && (node.tangent.norm() - 1.0).abs() < 1e-6
            };
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
