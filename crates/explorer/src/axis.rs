//! Axes of planes.

use serde::Deserialize;
use serde_json::{Value, json};

/// An axis of a plane.
#[derive(Clone, Copy, Deserialize)]
pub struct Axis {
    /// Its lower end.
    pub low: f64,
    /// Its upper end.
    pub high: f64,
    /// Whether it is logarithmic.
    pub log: bool,
}

impl Axis {
    /// Refuses an axis without length, and a logarithmic one that does not begin above 0.
    ///
    /// # Errors
    /// An object whose `error` says what is wrong.
    pub fn check(&self, name: &str) -> Result<(), Value> {
        let Self { low, high, log } = *self;
        let ordered = low.is_finite() && high.is_finite() && low < high;
        if ordered && (low > 0.0 || !log) {
            return Ok(());
        }
        let from = if log { " above 0" } else { "" };
        let error =
            format!("axis {name}: from {low} to {high}; expected two numbers{from} in order");
        Err(json!({ "error": error }))
    }

    /// The value at a part of the axis between 0 and 1.
    pub fn at(&self, part: f64) -> f64 {
        let Self { low, high, log } = *self;
        if log { low * (high / low).powf(part) } else { low + (high - low) * part }
    }
}
