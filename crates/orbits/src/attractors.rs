//! What a run leads to, where that need not be a periodic orbit: points on a section, diagrams over
//! a parameter, Lyapunov exponents, and basins.

mod basins;
mod exponents;
mod section;

pub use basins::{Attractor, Basins};
pub use exponents::Exponents;
pub use section::{Column, Section, SectionPoint};

use stickslip_solver::dynamic::{DynamicEvent, DynamicObserver, DynamicSwitch};
use stickslip_solver::{InvalidValue, Options, Outcome, Rest};

use crate::error::OrbitError;
use crate::watch::Watched;

/// The events of a run, and where they accumulate. The run ends if nobody waits for it.
struct Switches<'a> {
    events: Vec<DynamicSwitch<usize>>,
    rest: Option<f64>,
    watched: Watched<'a>,
}

impl<'a> From<Watched<'a>> for Switches<'a> {
    fn from(watched: Watched<'a>) -> Self {
        Self { events: Vec::new(), rest: None, watched }
    }
}

impl DynamicObserver<usize> for Switches<'_> {
    fn on_switch(&mut self, event: &DynamicEvent<'_, usize>) {
        self.events.push(event.to_switch());
    }
    fn on_rest(&mut self, rest: &Rest<usize>) {
        self.rest = Some(rest.s);
    }
    fn forget(&mut self, switches: usize) {
        self.events.truncate(self.events.len().saturating_sub(switches));
    }
    fn stops(&self, s: f64) -> bool {
        self.watched.stops(s)
    }
}

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
