//! The window of an atlas, and the accuracy that boundaries can have in it.

use stickslip_model::{InvalidParameter, Law, Reduction};
use stickslip_tracer::Window;

use crate::chart::Chart;
use crate::family::CollisionPlane;
use crate::range::Range;

/// The window of an atlas, and what all its collisions have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Scaled stiffness κ; the lower end is above 0.
    pub kappa: Range,
    /// Reduced impact ratio ψ; the lower end is above 0.
    pub psi: Range,
    /// The impact ratios from which ψ was reduced, if the window was given in impact ratios.
    pub ratio: Option<RatioRange>,
    /// Scaled damping.
    pub damping: f64,
    /// The contact law.
    pub law: Law,
    /// Tangential damping.
    pub tangential_damping: f64,
}

/// An interval of impact ratios.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RatioRange {
    /// The interval of g_t/g_n.
    pub range: Range,
    /// Friction and inertia, which reduce the ratio to ψ.
    pub reduction: Reduction,
}

/// The accuracies in ψ that boundaries can have in a window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToleranceRange {
    /// The finest: margins are known to some 1e-13.
    pub finest: f64,
    /// The usual one.
    pub usual: f64,
    /// The coarsest: the tracer tells curves apart by 1e-8 of an ordinary window's shorter side.
    pub coarsest: f64,
}

/// A window is too narrow for the accuracy of its boundaries.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "the window is too narrow: {width:e} in ln(kappa) by {height:e} in ln(psi); expected from \
     {NARROWEST:e} each"
)]
pub struct TooNarrow {
    /// The width of the window in ln κ.
    pub width: f64,
    /// The height of the window in ln ψ.
    pub height: f64,
}

/// The smallest distance between a boundary and its curve, in traced coordinates.
const FINEST: f64 = 1e-11;
/// The error of margins, which limits the places of boundaries.
const NOISE: f64 = 1e-13;
/// The least width and height of a window in ln κ and ln ψ.
const NARROWEST: f64 = 2e-7;

/// The error of a place in traced coordinates that comes from that of margins.
pub(super) fn noise(chart: &Chart) -> f64 {
    NOISE / chart.width.min(chart.height).min(1.0)
}

impl Frame {
    /// A window of collisions that obey the paper's law.
    #[must_use]
    pub fn new(kappa: Range, psi: Range, damping: f64) -> Self {
        Self { kappa, psi, ratio: None, damping, law: Law::PAPER, tangential_damping: 0.0 }
    }

    /// The coordinates in which the window is traced.
    #[must_use]
    pub fn chart(&self) -> Chart {
        Chart::of(self.kappa, self.psi)
    }

    /// The window in traced coordinates.
    #[must_use]
    pub fn window(&self, chart: &Chart) -> Window {
        chart.window(self.kappa, self.psi)
    }

    /// The distance in traced coordinates between a boundary and a curve that is accurate to
    /// `tolerance` in ψ.
    #[must_use]
    pub fn interpolation(&self, chart: &Chart, tolerance: f64) -> f64 {
        // The finest tolerance may be lost by rounding.
        (tolerance / chart.scale(self.psi.high)).max(FINEST)
    }

    /// The distance from a curve within which the side of a point is left open. It is ten times the
    /// curve's error, and at least 1e-9, since vertices are known less well.
    #[must_use]
    pub fn resolution(&self, chart: &Chart, tolerance: f64) -> f64 {
        (10.0 * self.interpolation(chart, tolerance)).max(1e3 * noise(chart)).max(1e-9)
    }

    /// The accuracies in ψ that boundaries can have.
    #[must_use]
    pub fn tolerances(&self) -> ToleranceRange {
        let chart = self.chart();
        let shorter = self.window(&chart).extent().min().min(1.0);
        let finest = FINEST.max(10.0 * noise(&chart));
        let [finest, usual, coarsest] =
            [finest, (1e-10 * shorter).max(finest), (1e-9 * shorter).max(10.0 * finest)]
                .map(|part| part * chart.scale(self.psi.high));
        ToleranceRange { finest, usual, coarsest }
    }

    /// Refuses a window that is too narrow for the accuracy of its boundaries.
    ///
    /// # Errors
    /// [`TooNarrow`] has the size of the window.
    pub fn require_wide(&self) -> Result<(), TooNarrow> {
        let [width, height] = [self.kappa, self.psi].map(|side| (side.high / side.low).ln());
        if width >= NARROWEST && height >= NARROWEST {
            return Ok(());
        }
        Err(TooNarrow { width, height })
    }

    /// (κ, ψ), moved onto an edge of the window if it differs from the edge by rounding alone.
    #[must_use]
    pub fn snapped(&self, [kappa, psi]: [f64; 2]) -> [f64; 2] {
        let snap = |value: f64, Range { low, high }: Range| {
            let near = |edge: &f64| (value - edge).abs() <= 1e-14 * edge;
            [low, high].into_iter().find(near).unwrap_or(value)
        };
        [snap(kappa, self.kappa), snap(psi, self.psi)]
    }

    /// The collisions in the window.
    ///
    /// # Errors
    /// [`InvalidParameter`]: no collision has these values.
    pub fn plane(&self) -> Result<CollisionPlane, InvalidParameter> {
        let Self { kappa, psi, damping, .. } = *self;
        CollisionPlane::new((kappa.low, kappa.high), (psi.low, psi.high), damping)?
            .with_law(self.law, self.tangential_damping)
    }
}
