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

/// The result at one point of a map.
pub struct MapPoint {
    /// The values of the scene's fields; NaN where there is no result.
    pub values: [f32; 4],
    /// The number of switches or events; [`NO_COUNT`] where there is no result.
    pub count: u16,
    /// The code of the itinerary.
    pub code: u32,
}

/// The count of a point without a result.
pub const NO_COUNT: u16 = u16::MAX;

impl MapPoint {
    /// A point without a result.
    pub const FAILED: Self = Self { values: [f32::NAN; 4], count: NO_COUNT, code: 0 };
}
