//! Boundaries as straight lines.

use stickslip_tracer::{Cubic, Curve, Point};

use super::frame::scaled;

/// Most straight lines for the piece between two points.
const MOST_LINES: f64 = 16.0;
/// Straight lines for a piece as long as the window is high.
const LINES: f64 = 60.0;

/// Points (κ, ψ) of a curve, close enough for straight lines between them in a window of this
/// extent.
#[must_use]
pub fn polyline<Label, Margin>(curve: &Curve<Label, Margin>, extent: &Point) -> Vec<[f64; 2]> {
    let mut points = vec![scaled(&curve.nodes[0].point)];
    for nodes in curve.nodes.windows(2) {
        let cubic = Cubic::between(&nodes[0], &nodes[1]);
        let length = (nodes[1].point - nodes[0].point).component_div(extent).norm();
        let lines = (LINES * length).ceil().clamp(1.0, MOST_LINES);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let count = lines as u32;
        points.extend((1..=count).map(|i| scaled(&cubic.at(f64::from(i) / lines))));
    }
    points
}
