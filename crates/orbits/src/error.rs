//! Why there is no orbit.

use stickslip_solver::{InvalidValue, Outcome, RunError};
use thiserror::Error;

/// Why an orbit or a branch was not found. Segments are counted from 0, in the order of the
/// itinerary.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum OrbitError {
    /// A value cannot be used.
    #[error(transparent)]
    Value(#[from] InvalidValue),
    /// The solution along a segment cannot be computed.
    #[error("segment {segment}: {error}")]
    Run {
        /// The segment.
        segment: usize,
        /// Why.
        error: RunError,
    },
    /// A rule of the itinerary does not act behind the guess.
    #[error(
        "segment {segment}: rule `{rule}` does not act within {steps} steps from the guess; \
         expected a start from which the rules of the itinerary follow each other"
    )]
    NoEvent {
        /// The segment.
        segment: usize,
        /// The name of the rule.
        rule: String,
        /// The number of steps.
        steps: usize,
    },
    /// Nothing moves the condition of a rule: it has no place.
    #[error(
        "segment {segment}: the condition of rule `{rule}` is zero or constant throughout; \
         expected one that changes along the solution"
    )]
    StillGuard {
        /// The segment.
        segment: usize,
        /// The name of the rule.
        rule: String,
    },
    /// What happens at events of a run does not repeat.
    #[error("the run does not settle: {}", not_settled(*events, *tolerance, *outcome))]
    NotSettled {
        /// The number of events that were compared.
        events: usize,
        /// How much states at repeated events may differ, of their size.
        tolerance: f64,
        /// How the run ended.
        outcome: Outcome,
    },
    /// A run does not come to its end.
    #[error("the run ends at t = {s:?}: {}", ending(*outcome))]
    Ends {
        /// How it ended.
        outcome: Outcome,
        /// When.
        s: f64,
    },
    /// A direction grows without bound at a graze.
    #[error("the condition of rule `{rule}` only touches zero at t = {s:?}; expected a crossing")]
    Grazes {
        /// The name of the rule.
        rule: String,
        /// When.
        s: f64,
    },
    /// The search found no orbit.
    #[error("no orbit near the guess: {reason} (segment {segment}, update {update:e})")]
    NotFound {
        /// What happened.
        reason: &'static str,
        /// The segment whose unknowns moved most in the last update.
        segment: usize,
        /// The length of the last update, of the size of the unknowns.
        update: f64,
    },
    /// The watch of [`Orbits::watched`](crate::Orbits::watched) was stopped.
    #[error("stopped")]
    Stopped,
    /// What a system follows at a point is not decided.
    #[error("not decided: {0}")]
    Undecided(String),
    /// Curves make no regions.
    #[error("no regions: {0}")]
    Regions(String),
    /// The search leads to a point and no orbit.
    #[error(
        "the guess leads to an orbit of length {period:e}, which is a point; expected a length \
         above {least:e}"
    )]
    NoLength {
        /// The length.
        period: f64,
        /// The least one.
        least: f64,
    },
}

impl OrbitError {
    /// There is no orbit, and no segment where it fails.
    pub(crate) const fn nowhere(reason: &'static str) -> Self {
        Self::NotFound { reason, segment: 0, update: f64::NAN }
    }
}

fn not_settled(events: usize, tolerance: f64, outcome: Outcome) -> String {
    match outcome {
        Outcome::Zeno { .. } | Outcome::EndedByGuard { .. } => ending(outcome),
        _ => format!("its last {events} events do not repeat up to {tolerance:e}"),
    }
}

fn ending(outcome: Outcome) -> String {
    match outcome {
        Outcome::Zeno { accumulation } => format!("its events accumulate at t = {accumulation:?}"),
        Outcome::EndedByGuard { .. } => "a rule ends it".to_owned(),
        Outcome::SwitchLimit => "it has too many events".to_owned(),
        Outcome::StepLimit => "it needs too many steps".to_owned(),
        Outcome::ReachedEnd | Outcome::Stopped => "it stops".to_owned(),
    }
}
