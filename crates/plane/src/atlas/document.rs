//! The layout of an atlas as a file, schema [`SCHEMA`].

use serde::{Deserialize, Serialize};
use stickslip_tracer::{Curve, Extremum, Node, VertexKind};

use super::boundary::Kind;
use super::frame::scaled;
use super::regions::{Atlas, switch_count};
use super::traced::VerifiedAtlas;
use super::verification::VerificationReport;

/// The name of the layout, with its version.
pub const SCHEMA: &str = "stickslip.atlas/1";

/// An atlas as it is written.
#[derive(Debug, Serialize, Deserialize)]
pub struct Document {
    /// The name of the layout, [`SCHEMA`].
    pub schema: String,
    /// The window.
    pub window: WindowFields,
    /// Accuracy of boundaries in ψ.
    pub tolerance: f64,
    /// The boundaries.
    pub boundaries: Vec<BoundaryFields>,
    /// Where boundaries meet and end.
    pub vertices: Vec<VertexFields>,
    /// Where boundaries are extremal in κ or ψ.
    #[serde(default)]
    pub extrema: Vec<ExtremumFields>,
    /// The regions.
    pub regions: Vec<RegionFields>,
    /// What the verification found.
    pub verification: VerificationReport,
}

#[derive(Debug, Serialize, Deserialize)]
pub struct WindowFields {
    pub kappa: [f64; 2],
    pub psi: [f64; 2],
    pub damping: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ratio: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mu: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub alpha: Option<f64>,
}

#[derive(Debug, Serialize, Deserialize)]
pub struct BoundaryFields {
    pub id: usize,
    pub kind: Kind,
    pub below: Switching,
    pub above: Switching,
    /// (κ, ψ).
    pub points: Vec<[f64; 2]>,
    /// Unit tangents in (ln κ, ln(1 + ψ)).
    pub tangents: Vec<[f64; 2]>,
    pub start: Why,
    pub end: Why,
    /// Where it starts and ends, unless it is closed.
    pub vertices: Option<[usize; 2]>,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Switching {
    pub switch_count: usize,
    pub itinerary: String,
}

/// Why a boundary ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Why {
    /// On the window's edge.
    Window,
    /// At a vertex inside.
    Vertex,
    /// It does not: its last point is its first.
    Closed,
}

#[derive(Debug, Serialize, Deserialize)]
pub struct VertexFields {
    pub id: usize,
    pub kind: Meeting,
    pub kappa: f64,
    pub psi: f64,
    /// The boundaries that end there.
    pub boundaries: Vec<usize>,
}

/// What a vertex is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Meeting {
    WindowEdge,
    WindowCorner,
    /// Boundaries cross or touch.
    Crossing,
    /// What vanishes on the boundary stops to exist.
    Degenerate,
    /// A graze reaches the end of contact.
    GrazeAtEnd,
    /// Ends of contact of a phase and of the next.
    VanishingPhase,
}

#[derive(Debug, Serialize, Deserialize)]
pub struct ExtremumFields {
    pub boundary: usize,
    pub of: Parameter,
    pub kappa: f64,
    pub psi: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Parameter {
    Kappa,
    Psi,
}

#[derive(Debug, Serialize, Deserialize)]
pub struct RegionFields {
    pub id: usize,
    #[serde(flatten)]
    pub switching: Switching,
    /// A place well inside.
    pub sample: [f64; 2],
    /// Its part of the window's area in (ln κ, ln(1 + ψ)).
    pub area_share: f64,
    /// The boundaries around it.
    pub boundaries: Vec<usize>,
}

impl Document {
    /// `verified` as it is written.
    #[must_use]
    pub fn new(verified: &VerifiedAtlas) -> Self {
        let VerifiedAtlas { atlas, extrema, report } = verified;
        let Atlas { frame, tolerance, regions: map, .. } = atlas;
        let corners: Vec<Meeting> =
            map.vertices().iter().map(|vertex| Meeting::from(vertex.kind)).collect();
        let mut ending = vec![Vec::new(); corners.len()];
        for (id, curve) in map.curves().iter().enumerate() {
            for vertex in curve.ends.into_iter().flatten() {
                if ending[vertex].last() != Some(&id) {
                    ending[vertex].push(id);
                }
            }
        }
        let vertices = map.vertices().iter().zip(ending).enumerate();
        let vertices = vertices.map(|(id, (vertex, boundaries))| {
            let [kappa, psi] = frame.snapped(scaled(&vertex.point));
            VertexFields { id, kind: corners[id], kappa, psi, boundaries }
        });
        let regions = map.regions().iter().enumerate().map(|(id, region)| {
            let mut boundaries: Vec<usize> = region.boundary.iter().map(|side| side.0).collect();
            boundaries.sort_unstable();
            boundaries.dedup();
            RegionFields {
                id,
                switching: Switching::new(atlas.itinerary(id)),
                sample: scaled(&region.sample),
                area_share: region.area / map.window().area(),
                boundaries,
            }
        });
        let boundaries = map.curves().iter().enumerate();
        Self {
            schema: SCHEMA.to_owned(),
            window: WindowFields {
                kappa: [frame.kappa.low, frame.kappa.high],
                psi: [frame.psi.low, frame.psi.high],
                damping: frame.damping,
                ratio: frame.ratio.map(|ratio| [ratio.range.low, ratio.range.high]),
                mu: frame.ratio.map(|ratio| ratio.reduction.mu),
                alpha: frame.ratio.map(|ratio| ratio.reduction.alpha),
            },
            tolerance: *tolerance,
            boundaries: boundaries
                .map(|(id, curve)| BoundaryFields::new(atlas, id, curve, &corners))
                .collect(),
            vertices: vertices.collect(),
            extrema: extrema.iter().map(ExtremumFields::new).collect(),
            regions: regions.collect(),
            verification: report.clone(),
        }
    }
}

impl BoundaryFields {
    fn new(atlas: &Atlas, id: usize, curve: &Curve<String, Kind>, corners: &[Meeting]) -> Self {
        let [below, above] = in_order(&curve.nodes, curve.sides.each_ref());
        let why = |end: usize| match curve.ends.map(|ends| corners[ends[end]]) {
            None => Why::Closed,
            Some(Meeting::WindowEdge | Meeting::WindowCorner) => Why::Window,
            Some(_) => Why::Vertex,
        };
        let point = |node: &Node| atlas.frame.snapped(scaled(&node.point));
        Self {
            id,
            kind: curve.margin,
            below: Switching::new(below),
            above: Switching::new(above),
            points: curve.nodes.iter().map(point).collect(),
            tangents: curve.nodes.iter().map(|node| node.tangent.into()).collect(),
            start: why(0),
            end: why(1),
            vertices: curve.ends,
        }
    }
}

impl ExtremumFields {
    fn new(extremum: &Extremum) -> Self {
        let [kappa, psi] = scaled(&extremum.point);
        let of = if extremum.axis == 0 { Parameter::Kappa } else { Parameter::Psi };
        Self { boundary: extremum.curve, of, kappa, psi }
    }
}

impl Switching {
    fn new(itinerary: &str) -> Self {
        Self { switch_count: switch_count(itinerary), itinerary: itinerary.to_owned() }
    }
}

impl From<VertexKind> for Meeting {
    fn from(kind: VertexKind) -> Self {
        match kind {
            VertexKind::WindowEdge => Self::WindowEdge,
            VertexKind::WindowCorner => Self::WindowCorner,
            VertexKind::Crossing => Self::Crossing,
            VertexKind::Degenerate => Self::Degenerate,
            VertexKind::GrazeAtEnd => Self::GrazeAtEnd,
            VertexKind::VanishingPhase => Self::VanishingPhase,
        }
    }
}

impl From<Meeting> for VertexKind {
    fn from(corner: Meeting) -> Self {
        match corner {
            Meeting::WindowEdge => Self::WindowEdge,
            Meeting::WindowCorner => Self::WindowCorner,
            Meeting::Crossing => Self::Crossing,
            Meeting::Degenerate => Self::Degenerate,
            Meeting::GrazeAtEnd => Self::GrazeAtEnd,
            Meeting::VanishingPhase => Self::VanishingPhase,
        }
    }
}

/// What lies below and above a curve, at its middle node.
///
/// Smaller ψ is below; where a curve runs straight up, smaller κ. The rule is its own inverse:
/// below and above become left and right again.
pub fn in_order<T>(nodes: &[Node], [left, right]: [T; 2]) -> [T; 2] {
    let tangent = nodes[nodes.len() / 2].tangent;
    let left_is_above = tangent.x > 0.0 || tangent.x == 0.0 && tangent.y < 0.0;
    if left_is_above { [right, left] } else { [left, right] }
}
