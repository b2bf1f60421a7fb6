//! A guard as isolation sees it: a curve, its quotient by a known zero, and the accuracy of both.

use crate::error::RunError;
use crate::events::isolate::chebyshev::COSINES;
use crate::events::isolate::panel::Panel;
use crate::events::path::SAFETY;

/// The width of a narrow panel, as a part of the step: what it does not resolve may be noise.
pub(super) const NARROWEST: f64 = 1.0 / 4096.0;

/// A value has a sign if it exceeds the standard deviation of its noise by this factor.
const BEYOND_NOISE: f64 = 32.0;
/// The number of points in a row from which noise is measured.
const ROW: usize = 9;
/// The order of the differences that are taken of these points.
const DIFFERENCES: usize = 6;
/// Differences that shrink by more than this factor with a quarter of the spacing belong to a
/// smooth function, for which the factor is 4096.
const SHRINKS: f64 = 64.0;
/// The factor by which such a difference is larger than the noise: the square root of C(12, 6), the
/// sum of its squared weights.
const DIFFERENCED: f64 = 30.397_368_307_141_3;

/// A guard's value along a step.
pub(crate) trait Curve {
    /// The value by the dense output.
    fn dense(&mut self, theta: f64) -> f64;
    /// The value by the dense output without its last term.
    fn coarse(&mut self, theta: f64) -> f64;
    /// The effect of rounding of state and time on a value: at the start of the step, and the
    /// largest on the step.
    fn rounding(&mut self) -> (f64, f64);
    /// The sign of the curve's rate at the start, by the field, or 0 if rounding hides it.
    fn start_rate(&mut self) -> f64;
    /// The value by a step of the method to `theta`.
    fn truth(&mut self, theta: f64) -> Result<f64, RunError>;
}

/// θ to the power `order`.
pub(super) fn power(theta: f64, order: u32) -> f64 {
    (0..order).fold(1.0, |product, _| product * theta)
}

/// A curve divided by θ to the power `order`, to remove a known zero at its start.
pub(super) struct Quotient<'a> {
    pub(super) curve: &'a mut (dyn Curve + 'a),
    pub(super) order: u32,
}

impl Quotient<'_> {
    /// The quotient by the dense output.
    pub(super) fn at(&mut self, theta: f64) -> f64 {
        self.curve.dense(theta) / power(theta, self.order)
    }

    /// The quotient by a step of the method.
    pub(super) fn truth(&mut self, theta: f64) -> Result<f64, RunError> {
        Ok(self.curve.truth(theta)? / power(theta, self.order))
    }

    /// The errors of the quotient on the step.
    pub(super) fn accuracy(&mut self) -> Accuracy {
        let state = self.curve.rounding();
        let mut accuracy =
            Accuracy { dense: 0.0, rounding: 0.0, state, noise: 0.0, noisy_part: 0.0 };
        for j in 1..16 {
            let theta = f64::from(j) / 16.0;
            let divisor = power(theta, self.order);
            let (fine, coarse) = (self.curve.dense(theta), self.curve.coarse(theta));
            // The error of the dense output vanishes as θ²(1−θ)² at the ends of the step. Divided
            // by a double zero, it is not zero at the start, whereas the last term is. 16 is the
            // inverse of the maximum of θ²(1−θ)².
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

    /// The noise of the curve's values between two step fractions. Larger values have a sign.
    pub(super) fn noise(&mut self, low: f64, high: f64) -> f64 {
        noise(&mut |theta| self.curve.dense(theta), low, high, [0.0, 1.0 / 3.0, 2.0 / 3.0])
    }
}

/// The noise of a function between two places. Larger values have a sign.
///
/// Noise is estimated from differences of high order of successive values (Moré and Wild, SIAM J.
/// Sci. Comput. 33 (2011) 1292). A smooth function hardly contributes to them if the values are
/// close together, and a jump contributes in one place only. Therefore both of two spacings must
/// show the noise, the smaller estimate counts, and the middle one of those at several `parts` of
/// the way from `low` to `high`.
pub(crate) fn noise<const K: usize>(
    function: &mut dyn FnMut(f64) -> f64,
    low: f64,
    high: f64,
    parts: [f64; K],
) -> f64 {
    let mut at = parts.map(|part| {
        let start = low + part * (high - low);
        let [wide, narrow] = [32.0, 128.0].map(|parts| {
            let spacing = (high - low) / parts;
            let mut row: [f64; ROW] = std::array::from_fn(|i| function(start + i as f64 * spacing));
            for order in 1..=DIFFERENCES {
                for i in 0..ROW - order {
                    row[i] = row[i + 1] - row[i];
                }
            }
            let left = &row[..ROW - DIFFERENCES];
            let square = left.iter().map(|d| d * d).sum::<f64>() / left.len() as f64;
            square.sqrt() / DIFFERENCED
        });
        if narrow * SHRINKS < wide { 0.0 } else { wide.min(narrow) }
    });
    at.sort_unstable_by(f64::total_cmp);
    if at[K - 1].is_finite() { BEYOND_NOISE * at[K / 2] } else { 0.0 }
}

/// The errors of a quotient along the dense output.
pub(super) struct Accuracy {
    /// The error of the dense output: the effect of its last term on the guard.
    pub(super) dense: f64,
    /// The rounding of the guard before the known zero is divided out, which magnifies it.
    pub(super) rounding: f64,
    /// The effect of rounding of state and time on the guard: at the start of the step, and the
    /// largest on the step.
    pub(super) state: (f64, f64),
    /// The noise of the guard's values beyond that, if it was measured.
    pub(super) noise: f64,
    /// The same, relative to the values around it. The smaller of both gives the noise: values near
    /// a pole are noisy in proportion, and differences of larger values are equally noisy
    /// everywhere.
    noisy_part: f64,
}

impl Accuracy {
    /// Takes a measured noise of the values on `panel` into account.
    pub(super) fn learn(&mut self, noise: f64, panel: &Panel) {
        self.noise = self.noise.max(noise);
        self.noisy_part = self.noisy_part.max(noise / panel.size());
    }

    /// The noise of the values on `panel`.
    pub(super) fn noise_on(&self, panel: &Panel) -> f64 {
        self.noise.min(self.noisy_part * panel.size())
    }

    /// The error of the quotient on `panel`.
    pub(super) fn on(&self, panel: &Panel, order: u32) -> f64 {
        let state = self.state.0 + panel.high * self.state.1;
        self.dense
            + (self.rounding + state + self.noise_on(panel))
                / power(panel.theta(-COSINES[1]), order)
    }

    /// The part of the error at the start of `panel` that a shorter step does not diminish.
    pub(super) fn lasting(&self, panel: &Panel, order: u32) -> f64 {
        (self.state.0 + self.noise_on(panel)) / power(panel.theta(-COSINES[1]), order)
    }
}
