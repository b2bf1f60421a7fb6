//! A window in its traced coordinates, and the accuracy that boundaries can have in it.

use stickslip_model::InvalidValue;
use stickslip_tracer::{Node, Point, Window};

use crate::chart::{Chart, Range};

/// A window of two parameters above 0, and its chart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sheet {
    /// The intervals of both parameters.
    pub sides: [Range; 2],
    /// The traced coordinates.
    pub chart: Chart,
    /// Whether margins come from integrated runs, which know them less well than the exact engine.
    pub integrated: bool,
}

/// The accuracies that boundaries can have in a window, in units of its second parameter: ψ, or the
/// tangential velocity in m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToleranceRange {
    /// The finest: margins are known to some 1e-13.
    pub finest: f64,
    /// The usual one.
    pub usual: f64,
    /// The coarsest: the tracer distinguishes curves that are 1e-8 of an ordinary window's shorter
    /// side apart.
    pub coarsest: f64,
}

/// The smallest distance between a boundary and its curve, in traced coordinates.
const FINEST: f64 = 1e-11;
/// The error of margins, which limits the places of boundaries.
const NOISE: f64 = 1e-13;
/// The least width and height of a window in the logarithms of its parameters.
const NARROWEST: f64 = 2e-7;

impl Sheet {
    /// The window in traced coordinates.
    pub fn window(&self) -> Window {
        let [x, y] = self.sides;
        self.chart.window(x, y)
    }

    /// The errors of a place along both traced coordinates that come from the error of margins.
    pub(crate) fn errors(&self) -> [f64; 2] {
        [self.chart.width, self.chart.height].map(|side| NOISE / side.min(1.0))
    }

    /// How closely a boundary can be known. A boundary that runs along one coordinate is known as
    /// well as places are along the other. Nodes are solved for, and labels are computed beside
    /// them, this closely: boundaries that meet at a vertex are close together even at a distance
    /// that is large compared with the shorter side.
    pub(crate) fn noise(&self) -> f64 {
        let [one, other] = self.errors();
        if self.integrated { one.max(other) } else { one.min(other) }
    }

    /// The distance in traced coordinates between a boundary and a curve that is accurate to
    /// `tolerance` in the second parameter.
    pub fn interpolation(&self, tolerance: f64) -> f64 {
        // The finest tolerance may be lost by rounding.
        (tolerance / self.chart.scale(self.sides[1].high)).max(FINEST)
    }

    /// The distance from a curve within which the side of a point is left open. It is ten times the
    /// curve's error, and at least 1e-9, since vertices are known less well.
    pub fn resolution(&self, tolerance: f64) -> f64 {
        let [one, other] = self.errors();
        (10.0 * self.interpolation(tolerance)).max(1e3 * one.max(other)).max(1e-9)
    }

    /// As [`Self::resolution`], for curves with these nodes.
    ///
    /// Margins leave the logarithms of both parameters open to 1e-13. In a window that is narrow in
    /// one of them, this is a large part of that side. It moves a boundary that runs along the
    /// side, but not one that runs across it.
    pub fn resolution_of<'n>(&self, nodes: impl Iterator<Item = &'n Node>, tolerance: f64) -> f64 {
        let [along, across] = self.errors();
        let moved =
            |Node { tangent, .. }: &Node| along * tangent.y.abs() + across * tangent.x.abs();
        let most = nodes.map(moved).fold(0.0, f64::max);
        (10.0 * self.interpolation(tolerance)).max(1e3 * most).max(1e-9)
    }

    /// The accuracies that boundaries can have.
    pub fn tolerances(&self) -> ToleranceRange {
        let shorter = self.window().extent().min().min(1.0);
        let finest = FINEST.max(10.0 * self.noise());
        let [finest, usual, coarsest] =
            [finest, (1e-10 * shorter).max(finest), (1e-9 * shorter).max(10.0 * finest)]
                .map(|part| part * self.chart.scale(self.sides[1].high));
        ToleranceRange { finest, usual, coarsest }
    }

    /// The width and the height of the window in the logarithms of its parameters.
    pub(crate) fn extents(&self) -> [f64; 2] {
        self.sides.map(|side| (side.high / side.low).ln())
    }

    /// Refuses a window that is too narrow for the accuracy of its boundaries. The error has the
    /// `names` of both parameters.
    ///
    /// # Errors
    /// [`InvalidValue`] has the size of the window.
    pub fn require_wide(&self, [x, y]: [&'static str; 2]) -> Result<(), InvalidValue> {
        let [width, height] = self.extents();
        if width >= NARROWEST && height >= NARROWEST {
            return Ok(());
        }
        let size = format!("is too narrow: {width:e} in ln({x}) by {height:e} in ln({y})");
        Err(InvalidValue::phrase("the window", size, format!("from {NARROWEST:e} each")))
    }

    /// Both parameters of a traced point, moved onto an edge of the window if they differ from the
    /// edge by rounding alone.
    pub fn snapped(&self, point: &Point) -> [f64; 2] {
        let snap = |value: f64, Range { low, high }: Range| {
            let near = |edge: &f64| (value - edge).abs() <= 1e-14 * edge;
            [low, high].into_iter().find(near).unwrap_or(value)
        };
        let [x, y] = self.chart.parameters(point);
        [snap(x, self.sides[0]), snap(y, self.sides[1])]
    }
}
