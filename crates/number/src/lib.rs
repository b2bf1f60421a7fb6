//! Numbers in which a system can be written once and read in three ways.
//!
//! A formula that is generic in its [`Number`]s gives values with `f64`. With dual numbers the same
//! lines give derivatives. With [`Enclosure`]s they bound the formula and its first two derivatives
//! over an interval of one variable, so that a zero there can be excluded. [`Dual`] numbers have
//! parts of any of these kinds.
//!
//! `interval` has the arithmetic of intervals, and `four` computes four of them side by side;
//! `enclosure` is built on both.
//!
//! Every crate meets input that it cannot use, and says so by an [`InvalidValue`].

mod dual;
mod enclosure;
mod four;
mod interval;
mod invalid;

use std::f64::consts::FRAC_2_SQRT_PI;
use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

use num_dual::{Dual64, DualNum};

pub use dual::Dual;
pub use enclosure::Enclosure;
pub use interval::Interval;
pub use invalid::{GivenValue, InvalidValue};

/// A number in which a formula is written: a double, a dual number or an enclosure.
///
/// A number cannot be compared, because an enclosure may have no answer. Formulas with cases are
/// written with [`Self::select`], [`Self::abs`], [`Self::min`], [`Self::max`] and
/// [`Self::floor`], and bounds then know where they have kinks and jumps.
///
/// ```
/// use stickslip_number::Number;
///
/// /// A force that acts in the second half of each period.
/// fn pulse<T: Number>(time: T, period: f64) -> T {
///     let phase = time / period - (time / period).floor();
///     (phase - 0.5).select(T::from(1.0), T::from(0.0))
/// }
///
/// assert_eq!([0.9, 1.2].map(|time| pulse(time, 1.0)), [1.0, 0.0]);
/// ```
///
/// The solver needs it for doubles, [`Dual64`] and [`Enclosure`]. Other types may
/// implement it; functions that come later have provided versions.
pub trait Number:
    Copy
    + Debug
    + From<f64>
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
{
    /// `on_or_above` where the number is ≥ 0, and `below` where it is < 0.
    #[must_use]
    fn select(self, on_or_above: Self, below: Self) -> Self;
    /// The largest integer that is not above the number.
    #[must_use]
    fn floor(self) -> Self;
    /// The absolute value.
    #[must_use]
    fn abs(self) -> Self;
    /// The smaller of two numbers.
    #[must_use]
    fn min(self, other: Self) -> Self;
    /// The larger of two numbers.
    #[must_use]
    fn max(self, other: Self) -> Self;
    /// A power with an integer exponent.
    #[must_use]
    fn powi(self, exponent: i32) -> Self;
    /// A power of a number ≥ 0 with any exponent.
    #[must_use]
    fn powf(self, exponent: f64) -> Self;
    /// The square root of a number ≥ 0.
    #[must_use]
    fn sqrt(self) -> Self;
    /// The exponential function.
    #[must_use]
    fn exp(self) -> Self;
    /// The natural logarithm of a number > 0.
    #[must_use]
    fn ln(self) -> Self;
    /// The sine of an angle in radians.
    #[must_use]
    fn sin(self) -> Self;
    /// The cosine of an angle in radians.
    #[must_use]
    fn cos(self) -> Self;
    /// The tangent of an angle in radians.
    #[must_use]
    fn tan(self) -> Self;
    /// The hyperbolic sine.
    #[must_use]
    fn sinh(self) -> Self;
    /// The hyperbolic cosine.
    #[must_use]
    fn cosh(self) -> Self;
    /// The hyperbolic tangent.
    #[must_use]
    fn tanh(self) -> Self;
    /// The arc sine in radians of a number between −1 and 1.
    #[must_use]
    fn asin(self) -> Self;
    /// The arc cosine in radians of a number between −1 and 1.
    #[must_use]
    fn acos(self) -> Self;
    /// The arc tangent in radians.
    #[must_use]
    fn atan(self) -> Self;
    /// The angle of the point (`x`, self) in radians, from −π to π.
    #[must_use]
    fn atan2(self, x: Self) -> Self;
    /// The inverse hyperbolic sine.
    #[must_use]
    fn asinh(self) -> Self;
    /// The inverse hyperbolic cosine of a number ≥ 1.
    #[must_use]
    fn acosh(self) -> Self;
    /// The inverse hyperbolic tangent of a number between −1 and 1.
    #[must_use]
    fn atanh(self) -> Self;
    /// exp(x) − 1, accurate where it is small.
    #[must_use]
    fn exp_m1(self) -> Self;
    /// ln(1 + x), accurate where it is small.
    #[must_use]
    fn ln_1p(self) -> Self;
    /// The error function.
    #[must_use]
    fn erf(self) -> Self;
}

/// Functions that a type has under the same name.
macro_rules! same {
    ($($name:ident)*) => {$(
        #[inline]
        fn $name(self) -> Self {
            <f64>::$name(self)
        }
    )*};
}

impl Number for f64 {
    #[inline]
    fn select(self, on_or_above: Self, below: Self) -> Self {
        if self.is_nan() {
            self
        } else if self >= 0.0 {
            on_or_above
        } else {
            below
        }
    }
    /// NaN spreads, as in all other functions.
    #[inline]
    fn min(self, other: Self) -> Self {
        if self < other || self.is_nan() { self } else { other }
    }
    #[inline]
    fn max(self, other: Self) -> Self {
        if self > other || self.is_nan() { self } else { other }
    }
    #[inline]
    fn powi(self, exponent: i32) -> Self {
        f64::powi(self, exponent)
    }
    #[inline]
    fn powf(self, exponent: f64) -> Self {
        f64::powf(self, exponent)
    }
    same!(floor abs sqrt exp ln sin cos tan sinh cosh tanh asin acos atan asinh acosh atanh);
    same!(exp_m1 ln_1p);
    #[inline]
    fn atan2(self, x: Self) -> Self {
        f64::atan2(self, x)
    }
    #[inline]
    fn erf(self) -> Self {
        libm::erf(self)
    }
}

/// Functions that `DualNum` has under the same name.
macro_rules! dual {
    ($($name:ident)*) => {$(
        #[inline]
        fn $name(self) -> Self {
            DualNum::$name(&self)
        }
    )*};
}

/// Derivatives at a kink are those of the piece on which the number lies, and derivatives at a jump
/// leave the jump out.
impl Number for Dual64 {
    #[inline]
    fn select(self, on_or_above: Self, below: Self) -> Self {
        if self.re.is_nan() {
            self
        } else if self.re >= 0.0 {
            on_or_above
        } else {
            below
        }
    }
    #[inline]
    fn floor(self) -> Self {
        Self::from(self.re.floor())
    }
    #[inline]
    fn abs(self) -> Self {
        if self.re < 0.0 { -self } else { self }
    }
    #[inline]
    fn min(self, other: Self) -> Self {
        if self.re < other.re || self.re.is_nan() { self } else { other }
    }
    #[inline]
    fn max(self, other: Self) -> Self {
        if self.re > other.re || self.re.is_nan() { self } else { other }
    }
    #[inline]
    fn powi(self, exponent: i32) -> Self {
        DualNum::powi(&self, exponent)
    }
    #[inline]
    fn powf(self, exponent: f64) -> Self {
        DualNum::powf(&self, exponent)
    }
    #[inline]
    fn atan2(self, x: Self) -> Self {
        DualNum::atan2(&self, x)
    }
    #[inline]
    fn erf(self) -> Self {
        let slope = FRAC_2_SQRT_PI * (-self.re * self.re).exp();
        Self::new(libm::erf(self.re), slope * self.eps)
    }
    dual!(sqrt exp ln sin cos tan sinh cosh tanh asin acos atan asinh acosh atanh exp_m1 ln_1p);
}

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
pub struct Readme;
