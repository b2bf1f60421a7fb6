//! Step-size control: how large the next step is.
//!
//! It repeats the step sequences of the codes DOPRI5 and DOP853, with a safety factor of 0.9. Order
//! 8 has the exponent 1/8 and step factors from 1/3 to 6, order 5 a proportional-integral rule with
//! β = 0.04 and step factors from 0.2 to 10. Source: Hairer, Nørsett and Wanner, *Solving Ordinary
//! Differential Equations I*, sections II.4 and IV.2.

use crate::method::store::Store;
use crate::method::tableau::Method;

const SAFETY: f64 = 0.9;

/// Proportional-integral control, with what it remembers of earlier steps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Controller {
    last_error: f64,
    just_rejected: bool,
    fresh: bool,
}

impl Controller {
    /// The factor by which the first step of a right-hand side may be cut at once, since it is a
    /// guess and may be too long by far.
    pub(crate) const FIRST_CUT: f64 = 0.01;

    pub(crate) fn new() -> Self {
        Self { last_error: 1e-4, just_rejected: false, fresh: true }
    }

    /// Prepares for a new right-hand side.
    pub(crate) fn begin(&mut self) {
        self.fresh = true;
    }

    /// The size of the next step after an accepted one of size `h` and relative `error`.
    pub(crate) fn accepted<M: Method>(&mut self, h: f64, error: f64) -> f64 {
        let (least, most) = M::STEP_FACTORS;
        self.fresh = false;
        let factor =
            SAFETY * power(self.last_error, M::CONTROL_BETA) * power(error, -exponent::<M>());
        self.last_error = error.max(1e-4);
        let most = if std::mem::take(&mut self.just_rejected) { 1.0 } else { most };
        h * factor.clamp(least, most)
    }

    /// The size of the next trial after a rejected step of size `h`. Its relative `error` was too
    /// large, or NaN.
    pub(crate) fn rejected<M: Method>(&mut self, h: f64, error: f64) -> f64 {
        self.just_rejected = true;
        if error.is_finite() {
            let least = if self.fresh { Self::FIRST_CUT } else { M::STEP_FACTORS.0 };
            h * (SAFETY * power(error, -exponent::<M>())).max(least)
        } else {
            0.1 * h
        }
    }
}

/// `base^exponent`. The exponents of order 8 are treated specially for speed, since the next step
/// waits for this number: three square roots would be a tenth of a step.
#[inline]
fn power(base: f64, exponent: f64) -> f64 {
    if exponent == -0.125 {
        inverse_eighth_root(base)
    } else if exponent == 0.0 {
        1.0
    } else {
        base.powf(exponent)
    }
}

/// `x^(−1/8)` of a finite x ≥ 0, with a relative error below 1e-7. For x = 0 it is some large
/// number.
///
/// The bits of a double are nearly its logarithm, which gives an approximation to 3 %. The binomial
/// series of (1 − r)^(−1/8) gives the remaining digits. It is evaluated in pairs, so that few
/// operations wait for each other.
#[inline]
fn inverse_eighth_root(x: f64) -> f64 {
    /// The bits of 1.
    const ONE: u64 = 1.0_f64.to_bits();
    /// A shift that makes the error of the straight line equally large on both sides.
    const SHIFT: u64 = (1 << 52) / 1000 * 54;
    const SERIES: [f64; 10] = {
        let mut series = [1.0; 10];
        let mut k = 1;
        while k < 10 {
            series[k] = series[k - 1] * (8 * k - 7) as f64 / (8 * k) as f64;
            k += 1;
        }
        series
    };
    let y = f64::from_bits(ONE + ONE / 8 - SHIFT - x.to_bits() / 8);
    let square = y * y;
    let fourth = square * square;
    let r = 1.0 - (x * fourth) * fourth;
    let [c0, c1, c2, c3, c4, c5, c6, c7, c8, c9] = SERIES;
    let pair = |low: f64, high: f64| low + high * r;
    let (r2, r4) = (r * r, (r * r) * (r * r));
    let low = pair(c0, c1) + pair(c2, c3) * r2;
    let high = (pair(c4, c5) + pair(c6, c7) * r2) + pair(c8, c9) * r4;
    y * (low + high * r4)
}

fn exponent<M: Method>() -> f64 {
    let order = M::CONTROL_ORDER as f64;
    // 0.75 β for order 5 and 0.2 β for order 8, as in the codes DOPRI5 and DOP853.
    1.0 / order - M::CONTROL_BETA * if M::CONTROL_ORDER == 5 { 0.75 } else { 0.2 }
}

/// A size for the first step, from the sizes of the state, of its derivative `f0` and of its second
/// derivative. `moved` and `f1` are room.
pub(crate) fn first_step_of<M: Method, V: Store>(
    field: &mut impl FnMut(f64, &V, &mut V),
    (s, y0, f0): (f64, &V, &V),
    tolerances: (f64, f64),
    longest: f64,
    (moved, f1): (&mut V, &mut V),
) -> f64 {
    let (rtol, atol) = tolerances;
    let norm = |v: &V| -> f64 {
        let parts = v.parts().iter().zip(y0.parts());
        parts.map(|(v, y)| (v / (atol + rtol * y.abs())).powi(2)).sum()
    };
    let (state_size, slope_size) = (norm(y0), norm(f0));
    let guess = if state_size <= 1e-10 || slope_size <= 1e-10 {
        1e-6
    } else {
        0.01 * (state_size / slope_size).sqrt()
    };
    // Numbers at the ends of the range of doubles may overflow in between.
    let guess = if guess > 0.0 { guess } else { 1e-6 };
    let h = guess.min(longest);
    V::shifted(moved, y0, f0, h);
    field(s + h, moved, f1);
    V::each(f1, [f0], |f1, [f0]| f1 - f0);
    let curvature = norm(f1).sqrt() / h;
    let largest = curvature.max(slope_size.sqrt());
    let order = M::CONTROL_ORDER as f64;
    let step =
        if largest <= 1e-15 { (h * 1e-3).max(1e-6) } else { (0.01 / largest).powf(1.0 / order) };
    let step = if step > 0.0 { step } else { h };
    step.min(100.0 * h).min(longest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_eighth_roots_are_good_to_1e_7() {
        for i in -3000..3000 {
            let x = 1.2_f64.powi(i).clamp(f64::MIN_POSITIVE, f64::MAX);
            assert!((inverse_eighth_root(x) * x.powf(0.125) - 1.0).abs() < 1e-7, "{x:e}");
        }
        assert!(inverse_eighth_root(0.0) > 1e30);
    }
}
