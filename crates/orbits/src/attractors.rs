//! What a run leads to, where that need not be a periodic orbit: points on a section, diagrams over
//! a parameter, Lyapunov exponents, and basins.

mod basins;
mod exponents;
mod section;

pub use basins::{Attractor, Basins};
pub use exponents::Exponents;
pub use section::{Column, Section, SectionPoint};

use stickslip_solver::{InvalidValue, Options, Outcome};

use crate::error::OrbitError;

/// The accuracy of long runs, from which no digits are read.
fn coarse() -> Options {
    Options { max_steps: 1_000_000, ..Options::with_tolerance(1e-10) }
}

/// Refuses a run that did not come to its end.
fn require_end(outcome: Outcome, s: f64) -> Result<(), OrbitError> {
    if outcome == Outcome::ReachedEnd { Ok(()) } else { Err(OrbitError::Ends { outcome, s }) }
}

/// Refuses a time to skip that is none.
fn require_skip(skip: f64) -> Result<(), InvalidValue> {
    let accepted = skip.is_finite() && skip >= 0.0;
    InvalidValue::check("the time to skip", skip, "a finite number from 0", accepted)
}
