//! A curve on part of a step as a polynomial, and the critical points of that polynomial.

use crate::events::isolate::chebyshev::{
    TERMS, clenshaw, differentiate, dominated, expand, monotone_root,
};

/// A curve on part of a step, expanded in Chebyshev polynomials of the local variable t ∈ [−1, 1].
pub(crate) struct Panel {
    pub(crate) low: f64,
    pub(crate) high: f64,
    coefficients: [f64; TERMS],
}

impl Panel {
    /// Expands `curve` between the step fractions `low` and `high`.
    pub(crate) fn new(low: f64, high: f64, mut curve: impl FnMut(f64) -> f64) -> Self {
        let middle = 0.5 * (low + high);
        let half = 0.5 * (high - low);
        Self { low, high, coefficients: expand(|t| curve(middle + half * t)) }
    }

    /// The step fraction at the local variable `local`.
    pub(crate) fn theta(&self, local: f64) -> f64 {
        if local >= 1.0 {
            self.high
        } else {
            self.low + 0.5 * (local + 1.0) * (self.high - self.low)
        }
    }

    /// The value of the expansion at the local variable `local`.
    pub(crate) fn at(&self, local: f64) -> f64 {
        clenshaw(&self.coefficients, local)
    }

    /// The size of the last two terms. If the function is smooth, all terms beyond degree 8 are
    /// smaller.
    pub(crate) fn tail(&self) -> f64 {
        self.coefficients[TERMS - 1].abs() + self.coefficients[TERMS - 2].abs()
    }

    /// The size of the values, as a sum of the terms.
    pub(crate) fn size(&self) -> f64 {
        self.coefficients.iter().map(|c| c.abs()).sum()
    }

    /// Whether the values vary by much less than their distance from zero.
    pub(crate) fn is_far_from_zero(&self) -> bool {
        3.0 * self.coefficients[0].abs() > 2.0 * self.size()
    }

    /// Collects points of ]low, high[ that cut this interval into monotone pieces, from left to
    /// right. A stretch that is flat to within `error` contributes its middle.
    pub(crate) fn critical_points(
        &self,
        low: f64,
        high: f64,
        error: f64,
        depth: u32,
        points: &mut Points,
    ) {
        if points.overflowed {
            return;
        }
        let local = |t: f64| 0.5 * (low + high) + 0.5 * (high - low) * t;
        let derivative = differentiate(&self.coefficients);
        let slope = expand(|t| clenshaw(&derivative, local(t)));
        if dominated(&slope) {
            return;
        }
        let curvature = differentiate(&slope);
        if dominated(&curvature) {
            if (clenshaw(&slope, -1.0) < 0.0) != (clenshaw(&slope, 1.0) < 0.0) {
                points.push(local(monotone_root(&slope)));
            }
            return;
        }
        let values = expand(|t| clenshaw(&self.coefficients, local(t)));
        let variation: f64 = values[1..].iter().map(|c| c.abs()).sum();
        if depth == 0 || variation <= 0.125 * error {
            points.push(0.5 * (low + high));
            return;
        }
        let middle = 0.5 * (low + high);
        self.critical_points(low, middle, error, depth - 1, points);
        // Rounding may put an extremum on neither side of the cut. Then it lies on the cut.
        points.push(middle);
        self.critical_points(middle, high, error, depth - 1, points);
    }
}

/// The critical points of a panel, in order.
pub(crate) struct Points {
    items: [f64; 64],
    count: usize,
    pub(crate) overflowed: bool,
}

impl Default for Points {
    fn default() -> Self {
        Self { items: [0.0; 64], count: 0, overflowed: false }
    }
}

impl Points {
    pub(crate) fn push(&mut self, point: f64) {
        match self.items.get_mut(self.count) {
            Some(item) => {
                *item = point;
                self.count += 1;
            }
            None => self.overflowed = true,
        }
    }

    pub(crate) fn as_slice(&self) -> &[f64] {
        &self.items[..self.count]
    }
}
