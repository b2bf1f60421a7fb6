//! The coordinates in which the (κ, ψ) plane is traced.

use stickslip_tracer::{Point, Window};

/// Traced coordinates of the (κ, ψ) plane, in which boundaries bend evenly.
///
/// They are x = ln(κ/κ₀)/w and y = ln(1 + (ψ − ψ₀)/s)/h. Windows of an ordinary shape have the
/// [plain](Self::PLAIN) chart, ln κ and ln(1 + ψ). One that is narrow, long, or reaches to small ψ
/// has a chart of its own, in which its sides are ln κ and ln ψ from 0 to 1: then lengths relative
/// to the window mean the same in both directions, and no digits are lost in a small window. In the
/// plain chart a window of 8 by 1e-5 would be crossed in steps of 1e-7, and one of 1e-6 by 1e-6 at
/// κ = 1000 would have lost ten digits.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Chart {
    /// κ₀.
    pub kappa: f64,
    /// w.
    pub width: f64,
    /// ψ₀.
    pub psi: f64,
    /// s. With s = ψ₀, y is (ln ψ − ln ψ₀)/h.
    pub spread: f64,
    /// h.
    pub height: f64,
}

impl Chart {
    /// ln κ and ln(1 + ψ).
    pub const PLAIN: Self = Self { kappa: 1.0, width: 1.0, psi: 0.0, spread: 1.0, height: 1.0 };

    /// The chart of a window.
    pub fn of(kappa: Range, psi: Range) -> Self {
        /// The least ψ of an ordinary window.
        const SMALLEST: f64 = 1e-3;
        if psi.low >= SMALLEST && Self::PLAIN.is_even(kappa, psi) {
            return Self::PLAIN;
        }
        Self::unit(kappa, psi)
    }

    /// The chart of a window of two velocities, which take the places of κ and ψ: their logarithms
    /// from 0 on, or from 0 to 1 if the window is narrow or long.
    pub fn of_velocities(normal: Range, tangential: Range) -> Self {
        let plain = Self::logarithms(normal, tangential);
        if plain.is_even(normal, tangential) { plain } else { Self::unit(normal, tangential) }
    }

    /// The logarithms of κ and ψ, from 0 on.
    fn logarithms(kappa: Range, psi: Range) -> Self {
        Self { kappa: kappa.low, width: 1.0, psi: psi.low, spread: psi.low, height: 1.0 }
    }

    /// The logarithms of κ and ψ, from 0 to 1.
    fn unit(kappa: Range, psi: Range) -> Self {
        let logarithms = Self::logarithms(kappa, psi);
        let extent = logarithms.window(kappa, psi).extent();
        Self { width: extent.x, height: extent.y, ..logarithms }
    }

    /// Whether a window is neither narrow nor long in this chart.
    fn is_even(&self, kappa: Range, psi: Range) -> bool {
        /// The least extent.
        const SHORTEST: f64 = 0.01;
        /// The greatest ratio of the two extents.
        const LONGEST: f64 = 16.0;
        let extent = self.window(kappa, psi).extent();
        extent.min() >= SHORTEST && extent.max() <= LONGEST * extent.min()
    }

    /// x of κ.
    pub fn abscissa(&self, kappa: f64) -> f64 {
        (kappa / self.kappa).ln() / self.width
    }

    /// The traced point of κ and ψ.
    pub fn point(&self, kappa: f64, psi: f64) -> Point {
        let x = self.abscissa(kappa);
        let y = ((psi - self.psi) / self.spread).ln_1p() / self.height;
        Point::new(x, y)
    }

    /// κ and ψ of a traced point: the inverse of [`Self::point`].
    pub fn parameters(&self, point: &Point) -> [f64; 2] {
        let kappa = self.kappa * (point.x * self.width).exp();
        [kappa, self.psi + self.spread * (point.y * self.height).exp_m1()]
    }

    /// A window in traced coordinates.
    pub fn window(&self, kappa: Range, psi: Range) -> Window {
        Window { low: self.point(kappa.low, psi.low), high: self.point(kappa.high, psi.high) }
    }

    /// The derivative of ψ with respect to y at `psi`.
    pub(crate) fn scale(&self, psi: f64) -> f64 {
        self.height * (self.spread - self.psi + psi)
    }
}

/// An interval of a quantity that is never negative.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Range {
    /// Lower end, 0 or above.
    pub low: f64,
    /// Upper end, above the lower one.
    pub high: f64,
}
