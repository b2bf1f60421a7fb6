//! The layout of the file of an atlas.

use serde::{Deserialize, Serialize};
use stickslip_model::Law;
use stickslip_tracer::{Node, VertexKind};

use crate::atlas::boundary::BoundaryKind;
use crate::atlas::verification::VerificationReport;
use crate::chart::Chart;

/// The name of the layout, with its version.
pub const SCHEMA: &str = "stickslip.atlas/1";

/// An atlas in the layout of its file.
///
/// [`AtlasDocument::new`] makes it from an atlas, `CollisionAtlas::try_from` reads it back. All
/// numbers are written so that they read back exactly, and the regions are then the same, bit for
/// bit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AtlasDocument {
    /// The name of the layout, [`SCHEMA`].
    pub schema: String,
    /// The window.
    pub window: WindowFields,
    /// The coordinates in which boundaries are cubics; (ln κ, ln(1 + ψ)) if there are none here.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chart: Option<Chart>,
    /// Accuracy of the boundaries in ψ.
    pub tolerance: f64,
    /// The boundaries.
    pub boundaries: Vec<BoundaryFields>,
    /// The vertices, at which boundaries meet and end.
    pub vertices: Vec<VertexFields>,
    /// The points at which boundaries are extremal in κ or ψ.
    #[serde(default)]
    pub extrema: Vec<ExtremumFields>,
    /// The regions between the boundaries.
    pub regions: Vec<RegionFields>,
    /// What the verification of the atlas found.
    pub verification: VerificationReport,
}

/// The window of an atlas in its file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WindowFields {
    /// Lower and upper end of the scaled stiffness κ.
    pub kappa: [f64; 2],
    /// Lower and upper end of the reduced impact ratio ψ.
    pub psi: [f64; 2],
    /// Scaled damping of all collisions.
    pub damping: f64,
    /// The contact law; the paper's if there is none here.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub law: Option<Law>,
    /// Tangential damping of all collisions; 0 if it is not here.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tangential_damping: Option<f64>,
    /// Lower and upper end of g_t/g_n, if the window was given in impact ratios.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ratio: Option<[f64; 2]>,
    /// Friction μ, if the window was given in impact ratios.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mu: Option<f64>,
    /// Inertia α, if the window was given in impact ratios.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub alpha: Option<f64>,
}

/// A boundary in the file of an atlas.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BoundaryFields {
    /// Index of the boundary in its list.
    pub id: usize,
    /// What happens on the boundary.
    pub kind: BoundaryKind,
    /// The switches below the boundary, or to its left where it runs straight up.
    pub below: Switching,
    /// The switches above the boundary, or to its right where it runs straight up.
    pub above: Switching,
    /// Points (κ, ψ), between which the boundary is a cubic in the coordinates of the chart.
    pub points: Vec<[f64; 2]>,
    /// Unit tangents at the points, in these coordinates.
    pub tangents: Vec<[f64; 2]>,
    /// Where the boundary starts.
    pub start: BoundaryEnd,
    /// Where the boundary ends.
    pub end: BoundaryEnd,
    /// Indices of the vertices at the start and at the end; none if the boundary is closed.
    pub vertices: Option<[usize; 2]>,
}

/// The switches of all collisions on one side of a boundary or in a region.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Switching {
    /// Number of switches.
    pub switch_count: usize,
    /// One character per phase: `+` and `-` for slip, `o` for stick.
    pub itinerary: String,
}

/// Where a boundary starts or ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BoundaryEnd {
    /// The end is on the edge of the window.
    Window,
    /// The end is at a vertex inside the window.
    Vertex,
    /// The boundary is closed: its last point is its first.
    Closed,
}

/// A vertex in the file of an atlas.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VertexFields {
    /// Index of the vertex in its list.
    pub id: usize,
    /// What happens at the vertex.
    #[serde(with = "VertexNames")]
    pub kind: VertexKind,
    /// κ of the vertex.
    pub kappa: f64,
    /// ψ of the vertex.
    pub psi: f64,
    /// Indices of the boundaries that start or end at the vertex.
    pub boundaries: Vec<usize>,
}

/// The names of kinds of vertices in the file.
#[derive(Serialize, Deserialize)]
#[serde(remote = "VertexKind", rename_all = "kebab-case")]
#[allow(dead_code, reason = "serde reads the names alone")]
enum VertexNames {
    WindowEdge,
    WindowCorner,
    Crossing,
    Degenerate,
    GrazeAtEnd,
    VanishingPhase,
}

/// A point at which a boundary is extremal, in the file of an atlas.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ExtremumFields {
    /// Index of the boundary.
    pub boundary: usize,
    /// The parameter that is extremal along the boundary.
    pub of: ExtremalParameter,
    /// κ of the point.
    pub kappa: f64,
    /// ψ of the point.
    pub psi: f64,
}

/// A parameter that is extremal along a boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ExtremalParameter {
    /// The scaled stiffness κ.
    Kappa,
    /// The reduced impact ratio ψ.
    Psi,
}

/// A region in the file of an atlas.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RegionFields {
    /// Index of the region in its list.
    pub id: usize,
    /// The switches of all collisions in the region.
    #[serde(flatten)]
    pub switching: Switching,
    /// A point (κ, ψ) well inside the region.
    pub sample: [f64; 2],
    /// The region's share of the window's area in (ln κ, ln(1 + ψ)).
    pub area_share: f64,
    /// Indices of the boundaries around the region.
    pub boundaries: Vec<usize>,
}

/// Turns left and right of a curve into below and above, or the reverse, at its middle node.
///
/// Below is the side with the smaller ψ; where the curve runs straight up, the side with the
/// smaller κ. The rule is its own inverse.
pub(super) fn in_order<T>(nodes: &[Node], [left, right]: [T; 2]) -> [T; 2] {
    let tangent = nodes[nodes.len() / 2].tangent;
    let left_is_above = tangent.x > 0.0 || tangent.x == 0.0 && tangent.y < 0.0;
    if left_is_above { [right, left] } else { [left, right] }
}
