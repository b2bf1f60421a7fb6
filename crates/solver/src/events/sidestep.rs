//! Places beside one where a guard has no value.

use crate::error::RunError;

/// The narrowest part of a step that is worth dividing.
const FINEST: f64 = 1.0 / (1_u64 << 48) as f64;
/// The places that are tried before a guard counts as without value.
const PLACES: i32 = 8;

/// The narrowest part of a step from `s` of size `h` that is wider than a point.
pub(crate) fn resolution(s: f64, h: f64) -> f64 {
    (2.0 * f64::EPSILON * s.abs() / h).clamp(FINEST, 1.0)
}

/// Moves aside from places where a guard has no value: d/|d| has no value where d is 0, and the
/// values beside it show what it does there.
pub(crate) struct Sidestep {
    /// The narrowest part of the step that is wider than a point.
    resolution: f64,
    nowhere: RunError,
    tried: i32,
}

impl Sidestep {
    /// `resolution` is the narrowest part of the step from `s` that is wider than a point.
    pub(crate) fn new(guard: usize, s: f64, resolution: f64) -> Self {
        Self { resolution, nowhere: RunError::GuardNotANumber { guard, s }, tried: 0 }
    }

    /// A step fraction beside `theta`, alternately behind it and before it, and farther away each
    /// time.
    ///
    /// # Errors
    ///
    /// It fails if too many have been tried.
    pub(crate) fn of(&mut self, theta: f64) -> Result<f64, RunError> {
        if self.tried == PLACES {
            return Err(self.nowhere.clone());
        }
        let away = 4_f64.powi(self.tried) * self.resolution.max(f64::EPSILON * theta);
        let before = self.tried % 2 != 0 || theta + away > 1.0;
        self.tried += 1;
        Ok(if before { (theta - away).abs() } else { theta + away })
    }
}
