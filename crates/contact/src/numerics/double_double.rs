//! Numbers of about 106 bits, made of two floating-point numbers each.
//!
//! The operations are those of T. J. Dekker, Numer. Math. 18, 224 (1971). The error of a product
//! comes from a fused multiplication.

/// A sum of two numbers that is kept as it is; the second is below the rounding of the first.
#[derive(Clone, Copy, Debug)]
pub struct DoubleDouble(pub f64, pub f64);

impl DoubleDouble {
    /// The exact sum a + b.
    #[inline]
    pub fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let part = high - a;
        Self(high, (a - (high - part)) + (b - part))
    }

    /// The exact product a·b.
    #[inline]
    pub fn product(a: f64, b: f64) -> Self {
        let high = a * b;
        Self(high, a.mul_add(b, -high))
    }

    /// The sum with `other`.
    #[inline]
    pub fn plus(self, other: Self) -> Self {
        let Self(high, low) = Self::sum(self.0, other.0);
        Self::sum(high, low + (self.1 + other.1))
    }

    /// The difference from `other`.
    #[inline]
    pub fn minus(self, other: Self) -> Self {
        self.plus(Self(-other.0, -other.1))
    }

    /// The product with `other`.
    #[inline]
    pub fn times(self, other: Self) -> Self {
        let Self(high, low) = Self::product(self.0, other.0);
        Self::sum(high, low + (self.0 * other.1 + self.1 * other.0))
    }

    /// The product with a double.
    #[inline]
    pub fn scaled(self, factor: f64) -> Self {
        let Self(high, low) = Self::product(self.0, factor);
        Self::sum(high, self.1.mul_add(factor, low))
    }

    /// The quotient by `divisor`.
    #[inline]
    pub fn over(self, divisor: Self) -> Self {
        let quotient = self.0 / divisor.0;
        let rest = (-quotient).mul_add(divisor.0, self.0) + self.1 - quotient * divisor.1;
        Self::sum(quotient, rest / divisor.0)
    }

    /// The nearest double.
    #[inline]
    pub fn nearest(self) -> f64 {
        self.0 + self.1
    }
}
