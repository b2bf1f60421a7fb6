//! Enclosures: a function of one variable over an interval, with its first two derivatives.

use std::f64::consts::FRAC_2_SQRT_PI;
use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::four::{Four, product_rule};
use crate::{Interval, Number};

/// Bounds for the values, the slopes and the second derivatives of a function over an interval of
/// its variable.
///
/// A kink makes the second derivative unbounded, a jump or a pole the slope too. So bounded slopes
/// mean that the function is continuous, and slopes of one sign then mean that it is monotone.
///
/// ```
/// use stickslip_number::{Enclosure, Interval, Number};
///
/// // The variable itself, over [0.5, 1.5].
/// let x = Enclosure::variable(Interval::new(0.5, 1.5));
/// let kink = (x - 1.0).abs();
/// assert!(kink.slope.is_bounded() && !kink.bend.is_bounded());
/// let jump = (x - 1.0).select(x, -x);
/// assert!(!jump.slope.is_bounded());
/// let rises = x * x;
/// assert!(rises.slope.sign() == 1.0 && rises.bend.contains(2.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Enclosure {
    /// Bounds for the values.
    pub value: Interval,
    /// Bounds for the slopes.
    pub slope: Interval,
    /// Bounds for the second derivatives.
    pub bend: Interval,
}

impl Enclosure {
    /// A function about which nothing is known.
    pub const ENTIRE: Self =
        Self { value: Interval::ENTIRE, slope: Interval::ENTIRE, bend: Interval::ENTIRE };

    /// The variable itself.
    #[must_use]
    pub fn variable(range: Interval) -> Self {
        Self { value: range, slope: Interval::point(1.0), bend: Interval::ZERO }
    }

    /// The same bounds, made tighter by an expansion about the middle, with the bounds `centre`
    /// there and the distance `radius` from there to the ends.
    #[must_use]
    pub fn about(self, centre: &Self, radius: f64) -> Self {
        let away = Interval::around(0.0, radius);
        let Self { mut value, mut slope, bend } = self;
        if bend.is_bounded() {
            slope = slope.meet(centre.slope.plus(bend.times(away)));
            let half = bend.times(away.powi(2)).scaled(0.5);
            value = value.meet(centre.value.plus(centre.slope.times(away)).plus(half));
        }
        value = value.meet(centre.value.plus(slope.times(away)));
        Self { value, slope, bend }
    }

    /// A function of this function, with its `value` and its first two derivatives there.
    #[inline]
    fn chain(self, value: Interval, first: Interval, second: Interval) -> Self {
        let slope = first.times(self.slope);
        let bend = second.times(self.slope.powi(2)).plus(first.times(self.bend));
        Self { value, slope, bend }
    }

    /// A function that is constant but for jumps.
    fn jumps(value: Interval) -> Self {
        let still = value.width() == 0.0;
        let slope = if still { Interval::ZERO } else { Interval::ENTIRE };
        Self { value, slope, bend: slope }
    }

    /// The product of functions with infinite bounds.
    #[cold]
    fn unbounded_product(self, other: Self) -> Self {
        let (a, b) = (self, other);
        let crossed = a.slope.times(b.slope).scaled(2.0);
        Self {
            value: a.value.times(b.value),
            slope: a.slope.times(b.value).plus(a.value.times(b.slope)),
            bend: a.bend.times(b.value).plus(crossed).plus(a.value.times(b.bend)),
        }
    }

    /// 1 divided by this function.
    fn inverse(self) -> Self {
        let inverse = self.value.inverse();
        let square = inverse.powi(2);
        self.chain(inverse, square.negated(), square.times(inverse).scaled(2.0))
    }

    /// One of two continuous functions at each place.
    fn either(value: Interval, one: Self, other: Self) -> Self {
        Self { value, slope: one.slope.hull(other.slope), bend: Interval::ENTIRE }
    }
}

impl From<f64> for Enclosure {
    #[inline]
    fn from(x: f64) -> Self {
        Self { value: Interval::point(x), slope: Interval::ZERO, bend: Interval::ZERO }
    }
}

impl Neg for Enclosure {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        let Self { value, slope, bend } = self;
        Self { value: value.negated(), slope: slope.negated(), bend: bend.negated() }
    }
}

impl Add for Enclosure {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        let four = |it: Self| Four::new([it.value, it.slope, it.bend, Interval::ZERO]);
        let [value, slope, bend, _] = four(self).plus(four(other)).all();
        Self { value, slope, bend }
    }
}

impl Sub for Enclosure {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Enclosure {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        let parts = |it: Self| [it.value, it.slope, it.bend];
        match product_rule(parts(self), parts(other)) {
            Some([value, slope, bend]) => Self { value, slope, bend },
            None => self.unbounded_product(other),
        }
    }
}

impl Div for Enclosure {
    type Output = Self;
    // A quotient is a product with the inverse.
    #[allow(clippy::suspicious_arithmetic_impl)]
    #[inline]
    fn div(self, other: Self) -> Self {
        self * other.inverse()
    }
}

impl Add<f64> for Enclosure {
    type Output = Self;
    #[inline]
    fn add(self, other: f64) -> Self {
        Self { value: self.value.plus(Interval::point(other)), ..self }
    }
}

impl Sub<f64> for Enclosure {
    type Output = Self;
    #[inline]
    fn sub(self, other: f64) -> Self {
        self + -other
    }
}

impl Mul<f64> for Enclosure {
    type Output = Self;
    #[inline]
    fn mul(self, other: f64) -> Self {
        let Self { value, slope, bend } = self;
        Self { value: value.scaled(other), slope: slope.scaled(other), bend: bend.scaled(other) }
    }
}

impl Div<f64> for Enclosure {
    type Output = Self;
    #[inline]
    fn div(self, other: f64) -> Self {
        // The quotient of the bounds is rounded once; a product with the inverse is rounded twice.
        let by = Interval::point(other).inverse();
        let Self { value, slope, bend } = self;
        Self { value: value.times(by), slope: slope.times(by), bend: bend.times(by) }
    }
}

impl Number for Enclosure {
    fn select(self, on_or_above: Self, below: Self) -> Self {
        if self.value.lower() >= 0.0 {
            on_or_above
        } else if self.value.upper() < 0.0 {
            below
        } else {
            Self {
                value: on_or_above.value.hull(below.value),
                slope: Interval::ENTIRE,
                bend: Interval::ENTIRE,
            }
        }
    }

    fn floor(self) -> Self {
        Self::jumps(Interval::new(self.value.lower().floor(), self.value.upper().floor()))
    }

    fn abs(self) -> Self {
        if self.value.lower() >= 0.0 {
            self
        } else if self.value.upper() <= 0.0 {
            -self
        } else {
            Self::either(self.value.abs(), self, -self)
        }
    }

    fn min(self, other: Self) -> Self {
        -(-self).max(-other)
    }

    fn max(self, other: Self) -> Self {
        let (a, b) = (self.value, other.value);
        if a.lower() >= b.upper() {
            self
        } else if b.lower() >= a.upper() {
            other
        } else {
            let value = Interval::new(a.lower().max(b.lower()), a.upper().max(b.upper()));
            Self::either(value, self, other)
        }
    }

    fn powi(self, exponent: i32) -> Self {
        let n = f64::from(exponent);
        let power = |less: i32| self.value.powi(exponent.saturating_sub(less));
        match exponent {
            0 => Self::from(1.0),
            1 => self,
            _ => self.chain(power(0), power(1).scaled(n), power(2).scaled(n).scaled(n - 1.0)),
        }
    }

    fn powf(self, exponent: f64) -> Self {
        if self.value.lower() <= 0.0 && exponent < 2.0 {
            // The derivatives may be unbounded at 0, and below it there is no value.
            let kept = if exponent >= 1.0 && self.value.lower() == 0.0 {
                self.value.powf(exponent - 1.0).scaled(exponent)
            } else {
                Interval::ENTIRE
            };
            return self.chain(self.value.powf(exponent), kept, Interval::ENTIRE);
        }
        if self.value.lower() < 0.0 {
            return self.chain(self.value.powf(exponent), Interval::ENTIRE, Interval::ENTIRE);
        }
        let power = |less: f64| self.value.powf(exponent - less);
        let second = power(2.0).scaled(exponent).scaled(exponent - 1.0);
        self.chain(power(0.0), power(1.0).scaled(exponent), second)
    }

    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        if self.value.lower() <= 0.0 {
            return self.chain(root, Interval::ENTIRE, Interval::ENTIRE);
        }
        let first = root.scaled(2.0).inverse();
        self.chain(root, first, first.times(self.value.scaled(-2.0).inverse()))
    }

    fn exp(self) -> Self {
        let value = self.value.exp();
        self.chain(value, value, value)
    }

    fn ln(self) -> Self {
        if self.value.lower() <= 0.0 {
            return self.chain(self.value.ln(), Interval::ENTIRE, Interval::ENTIRE);
        }
        let first = self.value.inverse();
        self.chain(self.value.ln(), first, first.powi(2).negated())
    }

    fn sin(self) -> Self {
        let (sine, cosine) = (self.value.sin(), self.value.cos());
        self.chain(sine, cosine, sine.negated())
    }

    fn cos(self) -> Self {
        let (sine, cosine) = (self.value.sin(), self.value.cos());
        self.chain(cosine, sine.negated(), cosine.negated())
    }

    fn tan(self) -> Self {
        let value = self.value.tan();
        if !value.is_bounded() {
            return Self::ENTIRE;
        }
        let first = Interval::point(1.0).plus(value.powi(2));
        self.chain(value, first, value.times(first).scaled(2.0))
    }

    fn sinh(self) -> Self {
        let (sine, cosine) = (self.value.sinh(), self.value.cosh());
        self.chain(sine, cosine, sine)
    }

    fn cosh(self) -> Self {
        let (sine, cosine) = (self.value.sinh(), self.value.cosh());
        self.chain(cosine, sine, cosine)
    }

    fn tanh(self) -> Self {
        let value = self.value.tanh();
        // 1 − tanh² would be the difference of equal numbers.
        let first = self.value.cosh().powi(2).inverse();
        self.chain(value, first, value.times(first).scaled(-2.0))
    }

    fn asin(self) -> Self {
        let value = self.value.asin();
        let inside = Interval::point(1.0).plus(self.value.powi(2).negated());
        if inside.lower() <= 0.0 {
            return self.chain(value, Interval::ENTIRE, Interval::ENTIRE);
        }
        let first = inside.sqrt().inverse();
        self.chain(value, first, self.value.times(first.powi(3)))
    }

    fn acos(self) -> Self {
        let right = Interval::around(std::f64::consts::FRAC_PI_2, f64::EPSILON);
        Self { value: right, ..Self::from(0.0) } - self.asin()
    }

    fn atan(self) -> Self {
        let first = Interval::point(1.0).plus(self.value.powi(2)).inverse();
        let second = self.value.times(first.powi(2)).scaled(-2.0);
        self.chain(self.value.atan(), first, second)
    }

    fn atan2(self, x: Self) -> Self {
        let value = self.value.atan2(x.value);
        let square = x.value.powi(2).plus(self.value.powi(2)).inverse();
        let jumps = self.value.lower() <= 0.0 && self.value.upper() >= 0.0;
        if jumps && x.value.lower() <= 0.0 || !square.is_bounded() {
            return Self { value, slope: Interval::ENTIRE, bend: Interval::ENTIRE };
        }
        // θ′ = (x y′ − y x′)/r² and θ″ = ((x y″ − y x″) − 2 (x x′ + y y′) θ′)/r².
        let cross = |a: Interval, b: Interval| x.value.times(a).plus(self.value.times(b).negated());
        let slope = cross(self.slope, x.slope).times(square);
        let grows = x.value.times(x.slope).plus(self.value.times(self.slope)).scaled(-2.0);
        let bend = cross(self.bend, x.bend).plus(grows.times(slope)).times(square);
        Self { value, slope, bend }
    }

    fn asinh(self) -> Self {
        let first = Interval::point(1.0).plus(self.value.powi(2)).sqrt().inverse();
        let second = self.value.times(first.powi(3)).negated();
        self.chain(self.value.asinh(), first, second)
    }

    fn acosh(self) -> Self {
        let value = self.value.acosh();
        let outside = Interval::point(-1.0).plus(self.value.powi(2));
        if outside.lower() <= 0.0 || self.value.lower() <= 1.0 {
            return self.chain(value, Interval::ENTIRE, Interval::ENTIRE);
        }
        let first = outside.sqrt().inverse();
        self.chain(value, first, self.value.times(first.powi(3)).negated())
    }

    fn atanh(self) -> Self {
        let value = self.value.atanh();
        let inside = Interval::point(1.0).plus(self.value.powi(2).negated());
        if inside.lower() <= 0.0 {
            return self.chain(value, Interval::ENTIRE, Interval::ENTIRE);
        }
        let first = inside.inverse();
        self.chain(value, first, self.value.times(first.powi(2)).scaled(2.0))
    }

    fn exp_m1(self) -> Self {
        let slope = self.value.exp();
        self.chain(self.value.exp_m1(), slope, slope)
    }

    fn ln_1p(self) -> Self {
        let inside = self.value.plus(Interval::point(1.0));
        if inside.lower() <= 0.0 {
            return self.chain(self.value.ln_1p(), Interval::ENTIRE, Interval::ENTIRE);
        }
        let first = inside.inverse();
        self.chain(self.value.ln_1p(), first, first.powi(2).negated())
    }

    fn erf(self) -> Self {
        let factor = Interval::around(FRAC_2_SQRT_PI, f64::EPSILON);
        let first = self.value.powi(2).negated().exp().times(factor);
        self.chain(self.value.erf(), first, self.value.times(first).scaled(-2.0))
    }
}
