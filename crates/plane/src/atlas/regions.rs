//! The atlas itself: a window, its boundaries, and the regions between them.

use stickslip_tracer::{Curve, Names, Point, regions::Subdivision, tracing::Extremum};

use super::boundary::BoundaryKind;
use super::frame::{Frame, RatioRange};
use super::verification::VerificationReport;
use crate::chart::Chart;
use crate::family::CollisionPlane;

/// A window divided by its boundaries into regions, which are labelled by itineraries.
pub type Regions = Subdivision<String, BoundaryKind>;

/// Every boundary in a window, the regions between them, and what their verification found.
#[derive(Clone, Debug)]
pub struct CollisionAtlas {
    /// The collisions, and the traced coordinates, in which the boundaries are cubics.
    pub plane: CollisionPlane,
    /// The impact ratios from which ψ was reduced, if the window was given in impact ratios.
    pub ratio: Option<RatioRange>,
    /// Accuracy of the boundaries in the second parameter.
    pub tolerance: f64,
    /// Boundaries, vertices and regions.
    pub regions: Regions,
    /// The points at which boundaries turn back in one of the parameters.
    pub extrema: Vec<Extremum>,
    /// What the verification found.
    pub report: VerificationReport,
}

impl CollisionAtlas {
    /// The itinerary of a region: one character per phase, `+` and `-` for slip, `o` for stick. It
    /// is empty if it is not known.
    ///
    /// # Panics
    /// If there is no region with this index.
    pub fn itinerary(&self, region: usize) -> &str {
        self.regions.regions()[region].label.as_deref().unwrap_or_default()
    }

    /// The window, and what all its collisions have in common.
    pub fn frame(&self) -> Frame {
        Frame { ratio: self.ratio, ..Frame::of(&self.plane) }
    }

    /// What speaks against the atlas; `None` if nothing does.
    pub fn objection(&self) -> Option<String> {
        self.report.objection()
    }
}

impl Names<String, BoundaryKind> for CollisionPlane {
    fn axes(&self) -> [&str; 2] {
        self.names()
    }

    fn parameters(&self, point: &Point) -> [f64; 2] {
        self.chart().parameters(point)
    }

    fn point(&self, [x, y]: [f64; 2]) -> Point {
        self.chart().point(x, y)
    }

    fn text(&self, label: &String) -> String {
        label.clone()
    }

    fn kind(&self, margin: &BoundaryKind) -> &'static str {
        margin.name()
    }
}

/// The number of switches of an itinerary, which has one character per phase.
///
/// ```
/// assert_eq!(stickslip_plane::atlas::switch_count("+o-"), 2);
/// ```
pub fn switch_count(itinerary: &str) -> usize {
    itinerary.len().saturating_sub(1)
}

impl CollisionAtlas {
    /// The points (κ, ψ) of each boundary, in the order of the boundaries. They are so close that
    /// straight lines between them look smooth in a picture of the window.
    pub fn polylines(&self) -> Vec<Vec<[f64; 2]>> {
        let extent = self.regions.window().extent();
        let curves = self.regions.curves().iter();
        curves.map(|curve| polyline(self.plane.chart(), &extent, curve)).collect()
    }
}

/// The points (κ, ψ) of a boundary in a window of this extent.
pub(crate) fn polyline<Label, Margin>(
    chart: &Chart,
    extent: &Point,
    curve: &Curve<Label, Margin>,
) -> Vec<[f64; 2]> {
    curve.polyline(extent).iter().map(|point| chart.parameters(point)).collect()
}
