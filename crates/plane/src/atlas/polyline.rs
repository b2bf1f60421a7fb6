//! Boundaries as straight lines.

use stickslip_tracer::{Curve, Point};

use super::regions::Atlas;
use crate::chart::Chart;

impl Atlas {
    /// The points (κ, ψ) of each boundary, in the order of the boundaries. They are so close that
    /// straight lines between them look smooth in a picture of the window.
    #[must_use]
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
