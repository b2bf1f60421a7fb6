//! Intervals of parameters.

/// An interval of a quantity that is never negative.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Range {
    /// Lower end, 0 or above.
    pub low: f64,
    /// Upper end, above the lower one.
    pub high: f64,
}
