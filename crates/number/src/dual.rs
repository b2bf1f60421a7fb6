//! Dual numbers: a value with its derivative along one direction, in numbers of any kind.

use std::f64::consts::FRAC_2_SQRT_PI;
use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::Number;

/// A value and its derivative along one direction, both in numbers of the type `T`.
///
/// Doubles give derivatives, enclosures give bounds for derivatives, and dual numbers give second
/// derivatives. A derivative at a kink is the one of the piece on which the value lies; at a jump,
/// it leaves the jump out.
///
/// ```
/// use stickslip_number::{Dual, Enclosure, Interval, Number};
///
/// fn cube<T: Number>(x: T) -> T {
///     x * x * x
/// }
///
/// assert_eq!(cube(Dual { value: 2.0, slope: 1.0 }).slope, 12.0);
/// // The derivative 3x² over [1, 2], with its own slope 6x.
/// let x = Enclosure::variable(Interval::new(1.0, 2.0));
/// let derivative = cube(Dual { value: x, slope: Enclosure::from(1.0) }).slope;
/// assert!(derivative.value.contains(3.0) && derivative.slope.contains(12.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<T> {
    /// The value.
    pub value: T,
    /// The derivative along the direction.
    pub slope: T,
}

impl<T: Number> Dual<T> {
    /// A function of this number, with its `value` and its `derivative` there.
    #[inline]
    fn chain(self, value: T, derivative: T) -> Self {
        Self { value, slope: derivative * self.slope }
    }

    /// The slope of one of two numbers: that of `one` where `difference` is ≥ 0.
    #[inline]
    fn chosen(value: T, difference: T, one: T, other: T) -> Self {
        Self { value, slope: difference.select(one, other) }
    }
}

impl<T: Number> From<f64> for Dual<T> {
    #[inline]
    fn from(x: f64) -> Self {
        Self { value: T::from(x), slope: T::from(0.0) }
    }
}

impl<T: Number> Neg for Dual<T> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self { value: -self.value, slope: -self.slope }
    }
}

impl<T: Number> Add for Dual<T> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, slope: self.slope + other.slope }
    }
}

impl<T: Number> Sub for Dual<T> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, slope: self.slope - other.slope }
    }
}

impl<T: Number> Mul for Dual<T> {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        let slope = self.slope * other.value + self.value * other.slope;
        Self { value: self.value * other.value, slope }
    }
}

impl<T: Number> Div for Dual<T> {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        Self { value, slope: (self.slope - value * other.slope) / other.value }
    }
}

impl<T: Number> Add<f64> for Dual<T> {
    type Output = Self;
    #[inline]
    fn add(self, other: f64) -> Self {
        Self { value: self.value + other, ..self }
    }
}

impl<T: Number> Sub<f64> for Dual<T> {
    type Output = Self;
    #[inline]
    fn sub(self, other: f64) -> Self {
        Self { value: self.value - other, ..self }
    }
}

impl<T: Number> Mul<f64> for Dual<T> {
    type Output = Self;
    #[inline]
    fn mul(self, other: f64) -> Self {
        Self { value: self.value * other, slope: self.slope * other }
    }
}

impl<T: Number> Div<f64> for Dual<T> {
    type Output = Self;
    #[inline]
    fn div(self, other: f64) -> Self {
        Self { value: self.value / other, slope: self.slope / other }
    }
}

impl<T: Number> Number for Dual<T> {
    fn select(self, on_or_above: Self, below: Self) -> Self {
        let value = self.value.select(on_or_above.value, below.value);
        Self::chosen(value, self.value, on_or_above.slope, below.slope)
    }
    fn floor(self) -> Self {
        Self { value: self.value.floor(), slope: T::from(0.0) }
    }
    fn abs(self) -> Self {
        Self::chosen(self.value.abs(), self.value, self.slope, -self.slope)
    }
    fn min(self, other: Self) -> Self {
        let (a, b) = (self.value, other.value);
        Self::chosen(a.min(b), b - a, self.slope, other.slope)
    }
    fn max(self, other: Self) -> Self {
        let (a, b) = (self.value, other.value);
        Self::chosen(a.max(b), a - b, self.slope, other.slope)
    }
    fn powi(self, exponent: i32) -> Self {
        match exponent {
            0 => Self::from(1.0),
            1 => self,
            _ => {
                let power = self.value.powi(exponent.saturating_sub(1));
                self.chain(self.value.powi(exponent), power * f64::from(exponent))
            }
        }
    }
    fn powf(self, exponent: f64) -> Self {
        self.chain(self.value.powf(exponent), self.value.powf(exponent - 1.0) * exponent)
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        Self { value: root, slope: self.slope / (root * 2.0) }
    }
    fn exp(self) -> Self {
        let value = self.value.exp();
        self.chain(value, value)
    }
    fn ln(self) -> Self {
        Self { value: self.value.ln(), slope: self.slope / self.value }
    }
    fn sin(self) -> Self {
        self.chain(self.value.sin(), self.value.cos())
    }
    fn cos(self) -> Self {
        self.chain(self.value.cos(), -self.value.sin())
    }
    fn tan(self) -> Self {
        let value = self.value.tan();
        self.chain(value, value * value + 1.0)
    }
    fn sinh(self) -> Self {
        self.chain(self.value.sinh(), self.value.cosh())
    }
    fn cosh(self) -> Self {
        self.chain(self.value.cosh(), self.value.sinh())
    }
    fn tanh(self) -> Self {
        // 1 − tanh² would be the difference of equal numbers.
        let cosh = self.value.cosh();
        self.chain(self.value.tanh(), T::from(1.0) / (cosh * cosh))
    }
    fn asin(self) -> Self {
        let root = (-(self.value * self.value) + 1.0).sqrt();
        Self { value: self.value.asin(), slope: self.slope / root }
    }
    fn acos(self) -> Self {
        let root = (-(self.value * self.value) + 1.0).sqrt();
        Self { value: self.value.acos(), slope: -(self.slope / root) }
    }
    fn atan(self) -> Self {
        let slope = self.slope / (self.value * self.value + 1.0);
        Self { value: self.value.atan(), slope }
    }
    fn atan2(self, x: Self) -> Self {
        let turned = x.value * self.slope - self.value * x.slope;
        let slope = turned / (x.value * x.value + self.value * self.value);
        Self { value: self.value.atan2(x.value), slope }
    }
    fn asinh(self) -> Self {
        let slope = self.slope / (self.value * self.value + 1.0).sqrt();
        Self { value: self.value.asinh(), slope }
    }
    fn acosh(self) -> Self {
        let slope = self.slope / (self.value * self.value - 1.0).sqrt();
        Self { value: self.value.acosh(), slope }
    }
    fn atanh(self) -> Self {
        let slope = self.slope / (-(self.value * self.value) + 1.0);
        Self { value: self.value.atanh(), slope }
    }
    fn exp_m1(self) -> Self {
        self.chain(self.value.exp_m1(), self.value.exp())
    }
    fn ln_1p(self) -> Self {
        Self { value: self.value.ln_1p(), slope: self.slope / (self.value + 1.0) }
    }
    fn erf(self) -> Self {
        let bell = (-(self.value * self.value)).exp() * FRAC_2_SQRT_PI;
        self.chain(self.value.erf(), bell)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_dual::Dual64;

    /// A formula with everything that a number can do.
    fn formula<T: Number>(x: T, kind: usize) -> T {
        match kind {
            0 => (x * 3.0).sin() * x.exp() - x.powi(3) / (x * x + 2.0),
            1 => (x * x + 0.5).sqrt() + (x + 4.0).ln().tanh(),
            2 => (x * 0.3).asin() + x.atan() * (x * 0.2).acos(),
            3 => (x * 0.4).tan() + x.sinh() * x.cosh() - (x + 5.0).powf(1.7),
            4 => (x * 2.0).cos().max(x).min(T::from(0.7)) / 3.0,
            5 => (x - 0.3).abs() * x + (x * 4.0).floor() + x.powi(0) - x.powi(1) + x.powi(-2),
            6 => (x - 0.2).select(x * x, -x) - 0.1,
            7 => x.atan2(x * x - 0.3) + x.asinh() - (x * x + 1.5).acosh() * x,
            _ => (x * 0.9).atanh() * x.exp_m1() + (x * 0.5).ln_1p() - (x * 2.0).erf(),
        }
    }

    /// Derivatives are those of another implementation, also the second ones.
    #[test]
    fn derivatives_are_those_of_dual64() {
        for kind in 0..9 {
            for x in [-0.77, -0.11, 0.31, 0.85] {
                let one = formula(Dual { value: x, slope: 1.0 }, kind);
                let other = formula(Dual64::new(x, 1.0), kind);
                let near = |a: f64, b: f64| (a - b).abs() <= 1e-14 * (1.0 + b.abs());
                assert!(near(one.value, other.re) && near(one.slope, other.eps), "{kind} {x}");
                let value = Dual { value: x, slope: 1.0 };
                let twice = formula(Dual { value, slope: Dual::from(1.0) }, kind).slope;
                let at = |x: f64| formula(Dual64::new(x, 1.0), kind).eps;
                let rise = |h: f64| at(x + h) - at(x - h);
                // A difference of fourth order.
                let bend = (8.0 * rise(1e-4) - rise(2e-4)) / 12e-4;
                let error = (twice.slope - bend).abs() / (1.0 + bend.abs());
                assert!(twice.value == one.slope && error < 1e-8, "{kind} {x} {error}");
            }
        }
    }
}
