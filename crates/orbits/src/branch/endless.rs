//! The end of a branch whose period grows without bound, as towards an orbit that comes to rest.
//!
//! The parameter then comes to rest too, and its way falls in proportion from step to step. What
//! is left of it soon vanishes in rounding: whatever is seen beyond that is not there.

use crate::orbit::Orbit;

/// A parameter is at rest that moves less in a step, in parts of its range.
const RESTS: f64 = 1e-11;
/// So many steps at rest are an end, whatever they look like.
const MOST: usize = 10;

/// What a branch does that no longer moves along its parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Rest {
    /// The segment's duration grows without bound.
    Endless(usize),
    /// It goes on at one value of the parameter.
    Upright,
}

/// The last steps of a branch.
pub(super) struct Steps {
    parameter: usize,
    range: f64,
    before: Orbit,
    /// The ways along the parameter, in parts of its range, since they are short.
    short: Vec<f64>,
}

impl Steps {
    /// The steps from an orbit on.
    pub fn new(start: &Orbit, parameter: usize, [low, high]: [f64; 2]) -> Self {
        Self { parameter, range: high - low, before: start.clone(), short: Vec::new() }
    }

    /// Takes the next orbit; whether the branch is at rest there.
    pub fn rest(&mut self, next: &Orbit) -> Option<Rest> {
        let before = std::mem::replace(&mut self.before, next.clone());
        let way =
            (next.parameters[self.parameter] - before.parameters[self.parameter]) / self.range;
        if way.abs() >= RESTS {
            self.short.clear();
            return None;
        }
        self.short.push(way);
        let growth = |k: usize| next.segments[k].duration.abs() - before.segments[k].duration.abs();
        let most = (0..next.segments.len()).max_by(|a, b| growth(*a).total_cmp(&growth(*b)))?;
        let falls = self.short.windows(2).all(|pair| (0.0..1.0).contains(&(pair[1] / pair[0])));
        match self.short.len() {
            3.. if falls && growth(most) > 0.0 => Some(Rest::Endless(most)),
            MOST.. => Some(Rest::Upright),
            _ => None,
        }
    }
}
