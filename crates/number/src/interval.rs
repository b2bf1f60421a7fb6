//! Interval arithmetic: sets of numbers between two doubles.
//!
//! It is our own, since the maintained crates need GMP and MPFR, or lack functions. A guard needs
//! ten operations and a dozen functions, which are tested against random values.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// All numbers between two bounds, which are rounded outwards.
///
/// Sums, products, quotients and roots are rounded by one or two units in the last place, other
/// functions by four: the libraries of common platforms are more accurate than that. An interval
/// over which a function has no value everywhere has bounds for the values that exist; if there may
/// be none, it is [`Interval::ENTIRE`].
///
/// ```
/// use stickslip_number::Interval;
///
/// let x = Interval::new(-1.0, 2.0);
/// assert!(x.times(x).contains(-2.0) && x.powi(2).lower() >= 0.0);
/// assert!(x.sin().upper() >= 1.0 && !x.plus(Interval::point(3.0)).contains(0.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    lower: f64,
    upper: f64,
}

/// The relative error of a function of the standard library, as a bound.
const FUNCTION: f64 = 4.0 * f64::EPSILON;

/// The rounding of a number, relative to it, and a little more (Rump, Zimmermann, Boldo and
/// Melquiond 2009).
pub(super) const HALF_UNIT: f64 = 0.5 * f64::EPSILON * (1.0 + f64::EPSILON);
/// The smallest positive number.
pub(super) const LEAST: f64 = f64::from_bits(1);

/// A number below `x`, mostly the next one.
#[inline(always)]
fn down(x: f64) -> f64 {
    // NaN stays.
    let x = if f64::MAX < x { f64::MAX } else { x };
    x - (HALF_UNIT * x.abs() + LEAST)
}

/// A number above `x`, mostly the next one.
#[inline(always)]
fn up(x: f64) -> f64 {
    -down(-x)
}

/// The smaller of two numbers that are not NaN.
#[inline(always)]
fn least(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// A product of bounds: one that is 0 stands for numbers near 0, also beside infinity.
#[inline(always)]
fn near_zero(product: f64) -> f64 {
    if product.is_nan() { 0.0 } else { product }
}

/// The larger of two numbers that are not NaN.
#[inline(always)]
fn most(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

impl Interval {
    /// All real numbers.
    pub const ENTIRE: Self = Self { lower: f64::NEG_INFINITY, upper: f64::INFINITY };
    /// The number 0.
    pub const ZERO: Self = Self { lower: 0.0, upper: 0.0 };

    /// The numbers from `lower` to `upper`. It is entire if a bound is NaN or the bounds are in the
    /// wrong order.
    #[must_use]
    #[inline]
    pub fn new(lower: f64, upper: f64) -> Self {
        if lower <= upper { Self { lower, upper } } else { Self::ENTIRE }
    }

    /// The numbers between two bounds that are in order.
    #[inline(always)]
    pub(super) fn between(lower: f64, upper: f64) -> Self {
        Self { lower, upper }
    }

    /// One number. It is entire if the number is NaN.
    #[must_use]
    #[inline]
    pub fn point(x: f64) -> Self {
        Self::new(x, x)
    }

    /// The numbers within `radius` of `middle`.
    #[must_use]
    #[inline]
    pub fn around(middle: f64, radius: f64) -> Self {
        if radius == 0.0 {
            Self::point(middle)
        } else {
            Self::new(down(middle - radius), up(middle + radius))
        }
    }

    /// The lower bound.
    #[must_use]
    #[inline]
    pub fn lower(self) -> f64 {
        self.lower
    }

    /// The upper bound.
    #[must_use]
    #[inline]
    pub fn upper(self) -> f64 {
        self.upper
    }

    /// Whether `x` is one of the numbers.
    #[must_use]
    #[inline]
    pub fn contains(self, x: f64) -> bool {
        self.lower <= x && x <= self.upper
    }

    /// The sign that all numbers have, or 0 if 0 is one of them or they have both signs.
    #[must_use]
    #[inline]
    pub fn sign(self) -> f64 {
        if self.lower > 0.0 {
            1.0
        } else if self.upper < 0.0 {
            -1.0
        } else {
            0.0
        }
    }

    /// Whether both bounds are finite.
    #[must_use]
    #[inline]
    pub fn is_bounded(self) -> bool {
        self.lower.is_finite() && self.upper.is_finite()
    }

    /// The largest absolute value.
    #[must_use]
    #[inline]
    pub fn magnitude(self) -> f64 {
        self.upper.max(-self.lower)
    }

    /// The distance between the bounds.
    #[must_use]
    #[inline]
    pub fn width(self) -> f64 {
        self.upper - self.lower
    }

    /// The numbers of either interval and those in between.
    #[must_use]
    #[inline]
    pub fn hull(self, other: Self) -> Self {
        Self { lower: least(self.lower, other.lower), upper: most(self.upper, other.upper) }
    }

    /// The common numbers. Both intervals enclose one quantity, so there are some.
    #[must_use]
    #[inline]
    pub fn meet(self, other: Self) -> Self {
        let (lower, upper) = (most(self.lower, other.lower), least(self.upper, other.upper));
        if lower <= upper { Self { lower, upper } } else { self }
    }

    /// The sum.
    #[must_use]
    #[inline]
    pub fn plus(self, other: Self) -> Self {
        if other == Self::ZERO {
            self
        } else if self == Self::ZERO {
            other
        } else {
            Self::new(down(self.lower + other.lower), up(self.upper + other.upper))
        }
    }

    /// The negatives.
    #[must_use]
    #[inline]
    pub fn negated(self) -> Self {
        Self { lower: -self.upper, upper: -self.lower }
    }

    /// The product.
    #[must_use]
    #[inline]
    pub fn times(self, other: Self) -> Self {
        let (p, q) = (near_zero(self.lower * other.lower), near_zero(self.lower * other.upper));
        let (r, s) = (near_zero(self.upper * other.lower), near_zero(self.upper * other.upper));
        if self == Self::ZERO || other == Self::ZERO {
            return Self::ZERO;
        }
        Self {
            lower: down(least(least(p, q), least(r, s))),
            upper: up(most(most(p, q), most(r, s))),
        }
    }

    /// The product with one number.
    #[must_use]
    #[inline]
    pub fn scaled(self, factor: f64) -> Self {
        self.times(Self::point(factor))
    }

    /// The inverses. They are entire if 0 is one of the numbers.
    #[must_use]
    #[inline]
    pub fn inverse(self) -> Self {
        if self.sign() == 0.0 {
            Self::ENTIRE
        } else {
            Self::new(down(1.0 / self.upper), up(1.0 / self.lower))
        }
    }

    /// The bounds of a function that rises.
    #[inline]
    fn rising(self, function: impl Fn(f64) -> f64) -> Self {
        Self::computed(function(self.lower), function(self.upper), FUNCTION)
    }

    /// Bounds of numbers between two that were computed with a relative `error`. One beyond the
    /// range of doubles lies between the largest of them and infinity.
    #[inline]
    fn computed(lower: f64, upper: f64, error: f64) -> Self {
        let below = |x: f64| {
            let x = if f64::MAX < x { f64::MAX } else { x };
            down(x - error * x.abs())
        };
        Self::new(below(lower), -below(-upper))
    }

    /// The square roots of the numbers that have one.
    #[must_use]
    pub fn sqrt(self) -> Self {
        if self.upper < 0.0 {
            return Self::ENTIRE;
        }
        let lower = self.lower.max(0.0).sqrt();
        let lower = if lower == 0.0 { 0.0 } else { down(lower) };
        Self::new(lower, if self.upper == 0.0 { 0.0 } else { up(self.upper.sqrt()) })
    }

    /// The powers with an integer exponent.
    #[must_use]
    pub fn powi(self, exponent: i32) -> Self {
        match exponent {
            0 => Self::point(1.0),
            1 => self,
            ..=-1 => self.powi(exponent.saturating_neg()).inverse(),
            _ => {
                let error = FUNCTION * f64::from(exponent);
                let widen = |lower, upper| Self::computed(lower, upper, error);
                let (a, b) = (self.lower.powi(exponent), self.upper.powi(exponent));
                if exponent % 2 != 0 || self.lower >= 0.0 {
                    widen(a, b)
                } else if self.upper <= 0.0 {
                    widen(b, a)
                } else {
                    Self::new(0.0, widen(0.0, a.max(b)).upper)
                }
            }
        }
    }

    /// The powers of the numbers ≥ 0 with any exponent.
    #[must_use]
    pub fn powf(self, exponent: f64) -> Self {
        if self.upper < 0.0 || exponent.is_nan() {
            return Self::ENTIRE;
        }
        let base = Self::new(self.lower.max(0.0), self.upper);
        if exponent >= 0.0 {
            let powers = base.rising(|x| x.powf(exponent));
            Self::new(powers.lower.max(0.0), powers.upper)
        } else {
            base.powf(-exponent).inverse()
        }
    }

    /// The exponential function.
    #[must_use]
    pub fn exp(self) -> Self {
        let values = self.rising(f64::exp);
        Self::new(values.lower.max(0.0), values.upper)
    }

    /// The natural logarithms of the numbers that have one.
    #[must_use]
    pub fn ln(self) -> Self {
        if self.upper <= 0.0 {
            return Self::ENTIRE;
        }
        Self::new(self.lower.max(0.0), self.upper).rising(f64::ln)
    }

    /// Whether offset + k·period is among the numbers for some integer k; true if in doubt.
    fn meets(self, offset: f64, period: f64) -> bool {
        let slack = FUNCTION * (self.magnitude() + period);
        let first = ((self.lower - slack - offset) / period).ceil();
        // The rounding of the quotient must not hide the number.
        let near = |k: f64| offset + k * period <= self.upper + slack;
        near(first) || near(first - 1.0) && offset + (first - 1.0) * period >= self.lower - slack
    }

    /// A function of period 2π that has the value 1 at `top` and −1 half a period later.
    fn wave(self, function: impl Fn(f64) -> f64, top: f64) -> Self {
        // Beyond 2^52 a period has no two doubles.
        if !(self.width() < TAU && self.magnitude() < 4e15) {
            return Self::new(-1.0, 1.0);
        }
        let (a, b) = (function(self.lower), function(self.upper));
        let slack = |x: f64| FUNCTION * x.abs() + f64::MIN_POSITIVE;
        let (least, most) = (a.min(b), a.max(b));
        Self {
            lower: if self.meets(top + PI, TAU) { -1.0 } else { (least - slack(least)).max(-1.0) },
            upper: if self.meets(top, TAU) { 1.0 } else { (most + slack(most)).min(1.0) },
        }
    }

    /// The sine.
    #[must_use]
    pub fn sin(self) -> Self {
        self.wave(f64::sin, FRAC_PI_2)
    }

    /// The cosine.
    #[must_use]
    pub fn cos(self) -> Self {
        self.wave(f64::cos, 0.0)
    }

    /// The tangent. It is entire if one of the numbers is a pole.
    #[must_use]
    pub fn tan(self) -> Self {
        if !(self.width() < PI && self.magnitude() < 4e15) || self.meets(FRAC_PI_2, PI) {
            return Self::ENTIRE;
        }
        self.rising(f64::tan)
    }

    /// The hyperbolic sine.
    #[must_use]
    pub fn sinh(self) -> Self {
        self.rising(f64::sinh)
    }

    /// The hyperbolic cosine.
    #[must_use]
    pub fn cosh(self) -> Self {
        let size = self.abs().rising(f64::cosh);
        Self::new(size.lower.max(1.0), size.upper)
    }

    /// The hyperbolic tangent.
    #[must_use]
    pub fn tanh(self) -> Self {
        self.rising(f64::tanh).meet(Self::new(-1.0, 1.0))
    }

    /// The arc tangent.
    #[must_use]
    pub fn atan(self) -> Self {
        self.rising(f64::atan)
    }

    /// The arc sines of the numbers that have one.
    #[must_use]
    pub fn asin(self) -> Self {
        if self.upper < -1.0 || self.lower > 1.0 {
            return Self::ENTIRE;
        }
        Self::new(self.lower.max(-1.0), self.upper.min(1.0)).rising(f64::asin)
    }

    /// The inverse hyperbolic sine.
    #[must_use]
    pub fn asinh(self) -> Self {
        self.rising(f64::asinh)
    }

    /// The inverse hyperbolic cosines of the numbers that have one.
    #[must_use]
    pub fn acosh(self) -> Self {
        if self.upper < 1.0 {
            return Self::ENTIRE;
        }
        let values = Self::new(self.lower.max(1.0), self.upper).rising(f64::acosh);
        Self::new(values.lower.max(0.0), values.upper)
    }

    /// The inverse hyperbolic tangents of the numbers that have one.
    #[must_use]
    pub fn atanh(self) -> Self {
        if self.upper < -1.0 || self.lower > 1.0 {
            return Self::ENTIRE;
        }
        Self::new(self.lower.max(-1.0), self.upper.min(1.0)).rising(f64::atanh)
    }

    /// exp(x) − 1.
    #[must_use]
    pub fn exp_m1(self) -> Self {
        let values = self.rising(f64::exp_m1);
        Self::new(values.lower.max(-1.0), values.upper)
    }

    /// ln(1 + x) of the numbers that have one.
    #[must_use]
    pub fn ln_1p(self) -> Self {
        if self.upper <= -1.0 {
            return Self::ENTIRE;
        }
        Self::new(self.lower.max(-1.0), self.upper).rising(f64::ln_1p)
    }

    /// The error function.
    #[must_use]
    pub fn erf(self) -> Self {
        self.rising(libm::erf).meet(Self::new(-1.0, 1.0))
    }

    /// The angles of the points whose second coordinates are these numbers and whose first ones
    /// are `x`, from −π to π.
    #[must_use]
    pub fn atan2(self, x: Self) -> Self {
        let turn = Self::around(0.0, PI * (1.0 + f64::EPSILON));
        if self.lower <= 0.0 && self.upper >= 0.0 && x.lower <= 0.0 {
            // The origin, or points on both sides of the jump.
            return turn;
        }
        // The extreme angles of a rectangle without the origin are those of corners.
        let corners = [(self.lower, x.lower), (self.lower, x.upper), (self.upper, x.lower)];
        let at = |(y, x): (f64, f64)| Self::point(x).rising(|x| y.atan2(x));
        corners.into_iter().map(at).fold(at((self.upper, x.upper)), Self::hull).meet(turn)
    }

    /// The absolute values.
    #[must_use]
    #[inline]
    pub fn abs(self) -> Self {
        if self.lower >= 0.0 {
            self
        } else if self.upper <= 0.0 {
            self.negated()
        } else {
            Self { lower: 0.0, upper: self.magnitude() }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is too large for a double still has its sign.
    #[test]
    fn values_beyond_the_range_of_doubles_have_bounds() {
        let functions: [fn(Interval) -> Interval; 7] = [
            Interval::exp,
            Interval::exp_m1,
            Interval::sinh,
            Interval::cosh,
            |x| x.powi(200),
            |x| x.powi(301),
            |x| x.powf(1e300),
        ];
        for function in functions {
            let values = function(Interval::new(1e3, 1e4));
            assert!(values.lower > 0.99 * f64::MAX && values.upper.is_infinite(), "{values:?}");
        }
        for function in [Interval::sinh, |x: Interval| x.powi(301)] {
            let values = function(Interval::new(-1e4, -1e3));
            assert!(values.upper < -0.99 * f64::MAX && values.lower.is_infinite(), "{values:?}");
        }
    }

    /// Every function contains the values at random places of a random interval.
    #[test]
    fn values_are_enclosed() {
        type Functions = (fn(Interval) -> Interval, fn(f64) -> f64);
        let mut random = fastrand::Rng::with_seed(1);
        let functions: [Functions; 21] = [
            (Interval::sqrt, f64::sqrt),
            (Interval::exp, f64::exp),
            (Interval::ln, f64::ln),
            (Interval::sin, f64::sin),
            (Interval::cos, f64::cos),
            (Interval::tan, f64::tan),
            (Interval::sinh, f64::sinh),
            (Interval::cosh, f64::cosh),
            (Interval::tanh, f64::tanh),
            (Interval::atan, f64::atan),
            (Interval::asin, f64::asin),
            (Interval::abs, f64::abs),
            (Interval::asinh, f64::asinh),
            (Interval::acosh, f64::acosh),
            (Interval::atanh, f64::atanh),
            (Interval::exp_m1, f64::exp_m1),
            (Interval::ln_1p, f64::ln_1p),
            (Interval::erf, libm::erf),
            (|x| x.powi(3), |x| x.powi(3)),
            (|x| x.powi(-2), |x| x.powi(-2)),
            (|x| x.powf(1.5), |x| x.powf(1.5)),
        ];
        for _ in 0..20_000 {
            let scale = 10_f64.powf(6.0 * random.f64() - 4.0);
            let middle = scale * (2.0 * random.f64() - 1.0);
            let radius = scale * 10_f64.powf(-8.0 * random.f64());
            let x = Interval::new(middle - radius, middle + radius);
            for (enclosed, function) in functions {
                let values = enclosed(x);
                for part in [0.0, 1.0, random.f64(), random.f64()] {
                    let value = function((x.lower + part * (x.upper - x.lower)).min(x.upper));
                    assert!(value.is_nan() || values.contains(value), "{x:?} {values:?} {value}");
                }
            }
            let other = Interval::around(random.f64() - 0.5, random.f64());
            for (a, b) in [(x.lower, other.lower), (x.upper, other.lower), (middle, other.upper)] {
                assert!(x.plus(other).contains(a + b) && x.times(other).contains(a * b));
                assert!(x.times(other.inverse()).contains(a / b));
                assert!(x.atan2(other).contains(a.atan2(b)) && other.atan2(x).contains(b.atan2(a)));
            }
        }
    }

    #[test]
    fn extrema_and_poles_are_seen() {
        assert_eq!(Interval::new(1.5, 1.6).sin().upper, 1.0);
        assert!(Interval::new(1.4, 1.5).sin().upper < 1.0);
        assert_eq!(Interval::new(3.0, 3.2).cos().lower, -1.0);
        assert_eq!(Interval::new(-100.0, 100.0).sin(), Interval::new(-1.0, 1.0));
        assert_eq!(Interval::new(1.5, 1.6).tan(), Interval::ENTIRE);
        assert_eq!(Interval::new(-1.0, 1.0).inverse(), Interval::ENTIRE);
        assert_eq!(Interval::point(f64::NAN), Interval::ENTIRE);
        assert_eq!(Interval::new(1.0, 2.0).powf(f64::NAN), Interval::ENTIRE);
        // For thousands of turns, each extremum is met in an interval around it and in no other.
        for k in 0..10_000 {
            let top = FRAC_PI_2 + TAU * f64::from(k);
            assert_eq!(Interval::around(top, 1e-3).sin().upper, 1.0);
            assert!(Interval::around(top + 1.0, 0.9).sin().upper < 1.0);
        }
    }
}
