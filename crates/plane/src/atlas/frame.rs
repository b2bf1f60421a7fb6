//! The window of an atlas, and the coordinates in which it is traced.

use stickslip_model::{InvalidParameter, Reduction};
use stickslip_tracer::{Point, Window};

use crate::family::CollisionPlane;
use crate::range::Range;

/// The window of an atlas, and what all its collisions have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Scaled stiffness κ; the lower end is above 0.
    pub kappa: Range,
    /// Reduced impact ratio ψ; the lower end is above 0.
    pub psi: Range,
    /// The impact ratios from which ψ was reduced, if it was.
    pub ratio: Option<RatioRange>,
    /// Scaled damping.
    pub damping: f64,
}

/// An interval of impact ratios.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RatioRange {
    /// g_t/g_n.
    pub range: Range,
    /// Friction and inertia, which reduce it to ψ.
    pub reduction: Reduction,
}

/// Accuracies of boundaries in ψ that are possible in a window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// The finest: margins are known to some 1e-13.
    pub finest: f64,
    /// The usual one.
    pub usual: f64,
    /// The coarsest: the tracer tells curves apart by 1e-8 of the window's shorter side.
    pub coarsest: f64,
}

/// A window is too narrow for the accuracy of its boundaries.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "the window is too narrow: {width:e} in ln(kappa) by {height:e} in ln(1 + psi); expected from \
     {NARROWEST} each"
)]
pub struct TooNarrow {
    /// Its width in ln κ.
    pub width: f64,
    /// Its height in ln(1 + ψ).
    pub height: f64,
}

/// The least width and height of a window in traced coordinates.
const NARROWEST: f64 = 0.01;

/// The coordinates (ln κ, ln(1 + ψ)), in which boundaries bend evenly.
#[must_use]
pub fn traced([kappa, psi]: [f64; 2]) -> Point {
    CollisionPlane::point(kappa, psi)
}

/// κ and ψ of a traced point.
#[must_use]
pub fn scaled(point: &Point) -> [f64; 2] {
    CollisionPlane::parameters(point)
}

impl Frame {
    /// The window in traced coordinates.
    #[must_use]
    pub fn window(&self) -> Window {
        Window {
            low: traced([self.kappa.low, self.psi.low]),
            high: traced([self.kappa.high, self.psi.high]),
        }
    }

    /// Distance from its boundary, in traced coordinates, of a curve that is accurate to
    /// `tolerance` in ψ.
    #[must_use]
    pub fn interpolation(&self, tolerance: f64) -> f64 {
        tolerance / (1.0 + self.psi.high)
    }

    /// Distance within which the side of a curve is left open: ten times its error, and where
    /// vertices are known less well.
    #[must_use]
    pub fn resolution(&self, tolerance: f64) -> f64 {
        (10.0 * self.interpolation(tolerance)).max(1e-9)
    }

    /// The accuracies in ψ that boundaries may have.
    #[must_use]
    pub fn tolerances(&self) -> Tolerances {
        let shorter = self.window().extent().min().min(1.0);
        let [finest, usual, coarsest] = [1e-11, (1e-10 * shorter).max(1e-11), 1e-9 * shorter]
            .map(|part| part * (1.0 + self.psi.high));
        Tolerances { finest, usual, coarsest }
    }

    /// Refuses a window that is too narrow for the accuracy of its boundaries.
    ///
    /// # Errors
    /// [`TooNarrow`] has its size.
    pub fn require_wide(&self) -> Result<(), TooNarrow> {
        let extent = self.window().extent();
        if extent.min() >= NARROWEST {
            return Ok(());
        }
        Err(TooNarrow { width: extent.x, height: extent.y })
    }

    /// (κ, ψ), moved onto an edge of the window where it differs from it by rounding alone.
    #[must_use]
    pub fn snapped(&self, [kappa, psi]: [f64; 2]) -> [f64; 2] {
        let snap = |value: f64, Range { low, high }: Range| {
            let near = |edge: &f64| (value - edge).abs() <= 1e-14 * (1.0 + edge.abs());
            [low, high].into_iter().find(near).unwrap_or(value)
        };
        [snap(kappa, self.kappa), snap(psi, self.psi)]
    }

    /// The collisions in the window.
    ///
    /// # Errors
    /// No collision has these values.
    pub fn plane(&self) -> Result<CollisionPlane, InvalidParameter> {
        let Self { kappa, psi, damping, .. } = *self;
        CollisionPlane::new((kappa.low, kappa.high), (psi.low, psi.high), damping)
    }
}
