//! Laws of the contact, as hybrid systems.
//!
//! [`law`] says what a law consists of. [`regularized`] is the paper's, in coordinates of its own;
//! [`general`] is every other one;
//! [`presets`] names those of particle codes. [`phase`] holds what laws have in common.

pub mod general;
pub(crate) mod law;
pub(crate) mod phase;
pub mod presets;
pub mod regularized;

/// The longest first step of a phase. Near its end a contact has no other scale than the time that
/// is left, u/|v|, which may be far below the tolerance.
fn longest_first_step(u: f64, v: f64) -> f64 {
    /// The step goes at most this part of the time left beyond it.
    const BEYOND: f64 = 1.5;
    if v < 0.0 { BEYOND * u / -v } else { f64::INFINITY }
}
