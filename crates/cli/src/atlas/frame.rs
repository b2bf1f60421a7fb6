//! The window of an atlas, and the coordinates in which it is traced.

use stickslip::collisions::CollisionPlane;
use stickslip_model::InvalidParameter;
use stickslip_tracer::{Point, Window};

use crate::range::Range;

/// The window of an atlas, and what all its collisions have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Scaled stiffness κ.
    pub kappa: Range,
    /// Reduced impact ratio ψ.
    pub psi: Range,
    /// Where ψ came from, if not given itself.
    pub ratio: Option<Ratio>,
    /// Scaled damping.
    pub damping: f64,
}

/// An interval of impact ratios.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ratio {
    /// g_t/g_n.
    pub range: Range,
    /// Coefficient of friction.
    pub mu: f64,
    /// Tangential inertia.
    pub alpha: f64,
}

/// The coordinates (ln κ, ln(1 + ψ)), in which boundaries bend evenly.
pub fn traced([kappa, psi]: [f64; 2]) -> Point {
    CollisionPlane::point(kappa, psi)
}

/// κ and ψ of a traced point.
pub fn scaled(point: &Point) -> [f64; 2] {
    CollisionPlane::parameters(point)
}

impl Frame {
    /// The window in traced coordinates.
    pub fn window(&self) -> Window {
        Window {
            low: traced([self.kappa.low, self.psi.low]),
            high: traced([self.kappa.high, self.psi.high]),
        }
    }

    /// Distance from its boundary, in traced coordinates, of a curve that is accurate to
    /// `tolerance` in ψ.
    pub fn interpolation(&self, tolerance: f64) -> f64 {
        tolerance / (1.0 + self.psi.high)
    }

    /// Distance within which the side of a curve is left open: ten times its error, and where
    /// vertices are known less well.
    pub fn resolution(&self, tolerance: f64) -> f64 {
        (10.0 * self.interpolation(tolerance)).max(1e-9)
    }

    /// The finest, the usual and the coarsest accuracy in ψ. The tracer tells curves apart by 1e-8
    /// of the window's shorter side, and has margins to some 1e-13.
    pub fn tolerances(&self) -> [f64; 3] {
        let shorter = self.window().extent().min().min(1.0);
        [1e-11, (1e-10 * shorter).max(1e-11), 1e-9 * shorter]
            .map(|part| part * (1.0 + self.psi.high))
    }

    /// Refuses a window that is too narrow for the accuracy of its boundaries.
    ///
    /// # Errors
    /// What is wrong and what is expected.
    pub fn require_wide(&self) -> Result<(), String> {
        const NARROWEST: f64 = 0.01;
        let extent = self.window().extent();
        if extent.min() >= NARROWEST {
            return Ok(());
        }
        Err(format!(
            "the window is too narrow: {:e} in ln(kappa) by {:e} in ln(1 + psi); expected from \
             {NARROWEST} each",
            extent.x, extent.y
        ))
    }

    /// (κ, ψ), moved onto an edge of the window from which only rounding parts it.
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
