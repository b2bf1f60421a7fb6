//! Boundaries as straight lines.

use stickslip_tracer::{Cubic, Curve, Point};

use super::regions::Atlas;
use crate::chart::Chart;

/// The largest number of straight lines between two points of a boundary.
const MOST_LINES: f64 = 16.0;
/// The number of straight lines for a piece of a boundary as long as the window is high.
const LINES: f64 = 60.0;

impl Atlas {
    /// The points (κ, ψ) of each boundary, in the order of the boundaries. They are so close that
    /// straight lines between them look smooth in a picture of the window.
    #[must_use]
    pub fn polylines(&self) -> Vec<Vec<[f64; 2]>> {
        let extent = self.regions.window().extent();
        let curves = self.regions.curves().iter();
        curves.map(|curve| polyline(&self.chart, &extent, curve)).collect()
    }
}

/// The points (κ, ψ) of a boundary in a window of this extent.
pub(crate) fn polyline<Label, Margin>(
    chart: &Chart,
    extent: &Point,
    curve: &Curve<Label, Margin>,
) -> Vec<[f64; 2]> {
    let mut points = vec![chart.parameters(&curve.nodes[0].point)];
    for nodes in curve.nodes.windows(2) {
        let cubic = Cubic::between(&nodes[0], &nodes[1]);
        let length = (nodes[1].point - nodes[0].point).component_div(extent).norm();
        let lines = (LINES * length).ceil().clamp(1.0, MOST_LINES);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let count = lines as u32;
        let parts = (1..=count).map(|line| f64::from(line) / lines);
        points.extend(parts.map(|part| chart.parameters(&cubic.at(part))));
    }
    points
}
