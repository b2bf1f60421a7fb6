//! A guard along a step, as isolation sees it, and how well it is known.

use crate::events::isolate::chebyshev::COSINES;
use crate::events::isolate::panel::Panel;

/// Panels narrower than 2^−`DEPTH` of the step are not cut further.
pub(super) const DEPTH: u32 = 12;
pub(super) const NARROWEST: f64 = 1.0 / (1_u32 << DEPTH) as f64;
/// By how much the dense output's error may exceed its last term. A value that is too large costs
/// steps of the method; one too small would cost decisions.
const SAFETY: f64 = 4.0;
/// A value counts as beyond its noise at this multiple of the noise's standard deviation.
const BEYOND_NOISE: f64 = 32.0;
/// Points in a row from which the noise is measured, and the order of the differences that are
/// taken of them.
const ROW: usize = 9;
const DIFFERENCES: usize = 6;
/// By how much such a difference is larger than the noise: the square root of the sum of its
/// squared weights, C(12, 6).
const DIFFERENCED: f64 = 30.397_368_307_141_3;

/// A guard's value along a step.
pub(crate) trait Curve {
    /// Why a value cannot be had.
    type Error;
    /// By the dense output, and by the dense output without its last term.
    fn dense(&mut self, theta: f64) -> (f64, f64);
    /// What the rounding of state and time may do to a value: at the start of the step, and at
    /// most.
    fn rounding(&mut self) -> (f64, f64);
    /// By a step of the method to `theta`.
    fn truth(&mut self, theta: f64) -> Result<f64, Self::Error>;
}

/// How far a curve's values scatter where the step starts or, if `at_end`, ends, if that is more
/// than their own rounding there.
pub(crate) fn noise<C: Curve>(curve: &mut C, at_end: bool) -> f64 {
    let width = NARROWEST / 64.0;
    let (low, high) = if at_end { (1.0 - width, 1.0) } else { (0.0, width) };
    let largest = curve.dense(low).0.abs().max(curve.dense(high).0.abs());
    let noise = Quotient { curve, order: 0 }.noise(low, high);
    if noise > BEYOND_NOISE * f64::EPSILON * largest { noise } else { 0.0 }
}

pub(super) fn power(theta: f64, order: u32) -> f64 {
    (0..order).fold(1.0, |product, _| product * theta)
}

/// A curve with the known zero at its start divided out.
pub(super) struct Quotient<'a, C> {
    pub(super) curve: &'a mut C,
    pub(super) order: u32,
}

impl<C: Curve> Quotient<'_, C> {
    pub(super) fn at(&mut self, theta: f64) -> (f64, f64) {
        let (fine, coarse) = self.curve.dense(theta);
        let divisor = power(theta, self.order);
        (fine / divisor, coarse / divisor)
    }

    pub(super) fn truth(&mut self, theta: f64) -> Result<f64, C::Error> {
        Ok(self.curve.truth(theta)? / power(theta, self.order))
    }

    pub(super) fn accuracy(&mut self) -> Accuracy {
        let state = self.curve.rounding();
        let mut accuracy = Accuracy { dense: 0.0, rounding: 0.0, state, noise: 0.0 };
        for j in 1..16 {
            let theta = f64::from(j) / 16.0;
            let divisor = power(theta, self.order);
            let (fine, coarse) = self.curve.dense(theta);
            // The error vanishes as θ²(1−θ)² at the ends of the step, but its ratio to a double
            // zero at the start does not, where the last term's does: 16 is the inverse
            // of the maximum of θ²(1−θ)².
            let weight = if self.order > 1 { (1.0 / divisor).max(16.0) } else { 1.0 / divisor };
            let error = SAFETY * weight * (fine - coarse).abs();
            if error.is_nan() {
                return Accuracy { dense: f64::NAN, ..accuracy };
            }
            accuracy.dense = accuracy.dense.max(error);
            accuracy.rounding = accuracy.rounding.max(64.0 * f64::EPSILON * fine.abs());
        }
        accuracy
    }

    /// How far the curve's values scatter between two step fractions, beyond which they mean
    /// something.
    ///
    /// High differences of successive values are left by noise alone, which is estimated from them
    /// (Moré and Wild, SIAM J. Sci. Comput. 33 (2011) 1292). What a function does diminishes
    /// when the values move together, and a jump is in one place; noise is neither: of two
    /// spacings the smaller estimate counts, of three places the middle one.
    pub(super) fn noise(&mut self, low: f64, high: f64) -> f64 {
        let mut at = [0.0, 1.0 / 3.0, 2.0 / 3.0].map(|place| {
            let start = low + place * (high - low);
            let [wide, narrow] = [32.0, 128.0].map(|parts| {
                let spacing = (high - low) / parts;
                let mut row: [f64; ROW] =
                    std::array::from_fn(|i| self.curve.dense(start + i as f64 * spacing).0);
                for order in 1..=DIFFERENCES {
                    for i in 0..ROW - order {
                        row[i] = row[i + 1] - row[i];
                    }
                }
                let left = &row[..ROW - DIFFERENCES];
                let square = left.iter().map(|d| d * d).sum::<f64>() / left.len() as f64;
                square.sqrt() / DIFFERENCED
            });
            if wide < narrow { wide } else { narrow }
        });
        at.sort_unstable_by(f64::total_cmp);
        if at[2].is_finite() { BEYOND_NOISE * at[1] } else { 0.0 }
    }
}

/// How well a quotient is known along the dense output.
pub(super) struct Accuracy {
    /// Error of the dense output as the guard sees it: the effect of its last term.
    pub(super) dense: f64,
    /// Rounding of the guard before the known zero is divided out, which magnifies it.
    pub(super) rounding: f64,
    /// What rounding of state and time does to the guard, at the start of the step and at most.
    pub(super) state: (f64, f64),
    /// What the guard's values scatter beyond that, where it was measured.
    pub(super) noise: f64,
}

impl Accuracy {
    pub(super) fn on(&self, panel: &Panel, order: u32) -> f64 {
        let state = self.state.0 + panel.high * self.state.1;
        self.dense + (self.rounding + state + self.noise) / power(panel.theta(-COSINES[1]), order)
    }

    /// The part of it that does not diminish with the step.
    pub(super) fn lasting(&self, panel: &Panel, order: u32) -> f64 {
        (self.state.0 + self.noise) / power(panel.theta(-COSINES[1]), order)
    }
}
