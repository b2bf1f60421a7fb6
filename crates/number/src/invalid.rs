//! The error for a value that cannot be used.

use std::borrow::Cow;
use std::fmt;

/// A value that cannot be used: a number out of its range, or a text that means nothing.
///
/// Errors of computations carry this one, with what they know of the place.
///
/// ```
/// use stickslip_number::InvalidValue;
///
/// let error = InvalidValue::new("rtol", -1.0, "1e-15 to 0.1");
/// assert_eq!(error.to_string(), "rtol = -1.0 is out of range; expected 1e-15 to 0.1");
/// let error = InvalidValue::new("cells", 0_usize, "1 to 4096");
/// assert_eq!(error.to_string(), "cells = 0 is out of range; expected 1 to 4096");
/// let error = InvalidValue::new("psi", [2.0, 1.0], "LO:HI with LO < HI");
/// assert_eq!(error.to_string(), "psi 2.0:1.0 is out of range; expected LO:HI with LO < HI");
/// let error = InvalidValue::new("prefix", "2d", "a letter first");
/// assert_eq!(error.to_string(), "prefix = \"2d\"; expected a letter first");
/// let error = InvalidValue::phrase("mu", "is free twice", "different names");
/// assert_eq!(error.to_string(), "mu is free twice; expected different names");
/// ```
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{name}{}{value}{}; expected {expected}", value.sign(), value.verdict())]
pub struct InvalidValue {
    /// What has the value: an option, a parameter, a column.
    pub name: Cow<'static, str>,
    /// The value.
    pub value: GivenValue,
    /// The values that are expected, in words.
    pub expected: Cow<'static, str>,
}

/// The value of an [`InvalidValue`].
#[derive(Clone, Debug, PartialEq)]
pub enum GivenValue {
    /// A number, shown with its point: `2.0`, `1e300`.
    Number(f64),
    /// A number of things.
    Count(usize),
    /// The ends of an interval, shown as `1.0:2.0`.
    Interval([f64; 2]),
    /// A text, shown in quotes.
    Text(Box<str>),
    /// What is wrong, in words that go on behind the name.
    Phrase(Box<str>),
}

impl InvalidValue {
    /// The error of `name`, whose `value` is not among the `expected` ones.
    pub fn new(
        name: impl Into<Cow<'static, str>>,
        value: impl Into<GivenValue>,
        expected: impl Into<Cow<'static, str>>,
    ) -> Self {
        Self { name: name.into(), value: value.into(), expected: expected.into() }
    }

    /// The error of `name`, with what is wrong in words that go on behind the name.
    pub fn phrase(
        name: impl Into<Cow<'static, str>>,
        phrase: impl Into<Box<str>>,
        expected: impl Into<Cow<'static, str>>,
    ) -> Self {
        Self::new(name, GivenValue::Phrase(phrase.into()), expected)
    }

    /// Nothing if the value is `accepted`.
    ///
    /// # Errors
    /// The error of these fields otherwise.
    #[inline]
    pub fn check(
        name: impl Into<Cow<'static, str>>,
        value: impl Into<GivenValue>,
        expected: impl Into<Cow<'static, str>>,
        accepted: bool,
    ) -> Result<(), Self> {
        if accepted { Ok(()) } else { Err(Self::new(name, value, expected)) }
    }
}

impl GivenValue {
    /// What stands between the name and the value.
    fn sign(&self) -> &'static str {
        match self {
            Self::Number(_) | Self::Count(_) | Self::Text(_) => " = ",
            Self::Interval(_) | Self::Phrase(_) => " ",
        }
    }

    /// What stands behind the value.
    fn verdict(&self) -> &'static str {
        match self {
            Self::Number(_) | Self::Count(_) | Self::Interval(_) => " is out of range",
            Self::Text(_) | Self::Phrase(_) => "",
        }
    }
}

impl fmt::Display for GivenValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(value) => write!(f, "{value:?}"),
            Self::Count(value) => write!(f, "{value}"),
            Self::Interval([low, high]) => write!(f, "{low:?}:{high:?}"),
            Self::Text(value) => write!(f, "{value:?}"),
            Self::Phrase(phrase) => f.write_str(phrase),
        }
    }
}

impl From<f64> for GivenValue {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}

impl From<usize> for GivenValue {
    fn from(value: usize) -> Self {
        Self::Count(value)
    }
}

impl From<[f64; 2]> for GivenValue {
    fn from(ends: [f64; 2]) -> Self {
        Self::Interval(ends)
    }
}

impl From<&str> for GivenValue {
    fn from(value: &str) -> Self {
        Self::Text(value.into())
    }
}
