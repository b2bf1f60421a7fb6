//! The window of an atlas, and the coordinates in which it is traced.

use stickslip_model::{Contact, InvalidParameter};
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
    Point::new(kappa.ln(), psi.ln_1p())
}

/// κ and ψ of a traced point.
pub fn scaled(point: &Point) -> [f64; 2] {
    [point.x.exp(), point.y.exp_m1()]
}

impl Frame {
    /// The window in traced coordinates.
    pub fn window(&self) -> Window {
        Window {
            low: traced([self.kappa.low, self.psi.low]),
            high: traced([self.kappa.high, self.psi.high]),
        }
    }

    /// Distance from its boundary, in traced coordinates, of a curve that is accurate to `tolerance` in ψ.
    pub fn interpolation(&self, tolerance: f64) -> f64 {
        tolerance / (1.0 + self.psi.high)
    }

    /// Distance within which the side of a curve is left open: ten times its error, for vertices are known less well.
    pub fn resolution(&self, tolerance: f64) -> f64 {
        10.0 * self.interpolation(tolerance)
    }

    /// Refuses a window in which `tolerance` is not small.
    ///
    /// # Errors
    /// What is wrong and what is accepted.
    pub fn require_wide(&self, tolerance: f64) -> Result<(), String> {
        let resolution = self.resolution(tolerance);
        let extent = self.window().extent();
        let (x, y) = (extent.x, extent.y);
        let narrowest = 1e3 * resolution;
        if x > narrowest && y > narrowest {
            return Ok(());
        }
        Err(format!(
            "the window is {x:e} wide in ln(kappa) and {y:e} high in ln(1 + psi), too narrow for a \
             tolerance of {tolerance:e}; accepted is above {narrowest:e}"
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

    /// The collision at a traced point. The tracer also asks for places a little outside of the window, where ψ may not be
    /// positive.
    ///
    /// # Errors
    /// κ has left the range of numbers.
    pub fn contact(&self, point: &Point) -> Result<Contact, InvalidParameter> {
        let [kappa, psi] = scaled(point);
        Contact::new(kappa, psi.max(0.5 * self.psi.low), self.damping)
    }
}
