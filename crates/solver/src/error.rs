//! Why a run failed.

use crate::options::InvalidOption;

/// A run failed; every variant carries the numbers that tell where.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RunError {
    /// An option is out of its range.
    #[error(transparent)]
    Option(#[from] InvalidOption),
    /// The span of the run is not a forward one.
    #[error("cannot run from s = {from} to s = {to}: the end must lie after a finite start")]
    Span {
        /// Start of the run.
        from: f64,
        /// Its end.
        to: f64,
    },
    /// The initial state, or one that a transition returned, is not finite.
    #[error("the state at s = {s} is not finite (component {component})")]
    State {
        /// Where.
        s: f64,
        /// The first component that is not finite.
        component: usize,
    },
    /// The right-hand side is not finite.
    #[error("the right-hand side is not finite near s = {s} (step {step})")]
    Field {
        /// Where the step started.
        s: f64,
        /// Steps tried so far.
        step: usize,
    },
    /// No step is short enough for the tolerance.
    #[error("the tolerance cannot be met at s = {s}: a step of {h:e} is too long (step {step})")]
    Tolerance {
        /// Where the step started.
        s: f64,
        /// The last step tried.
        h: f64,
        /// Steps tried so far.
        step: usize,
    },
    /// A guard is not a number.
    #[error("guard {guard} is not a number near s = {s}")]
    GuardNotANumber {
        /// The guard's index.
        guard: usize,
        /// Where the step started.
        s: f64,
    },
    /// A guard is zero throughout a step, so that its crossings mean nothing.
    #[error("guard {guard} is identically zero on a step from s = {s}")]
    GuardIdenticallyZero {
        /// The guard's index.
        guard: usize,
        /// Where the step started.
        s: f64,
    },
    /// A guard has more structure than any step can resolve.
    #[error("guard {guard} cannot be resolved near s = {s} by a step of {h:e}")]
    GuardUnresolved {
        /// The guard's index.
        guard: usize,
        /// Where the step started.
        s: f64,
        /// The last step tried.
        h: f64,
    },
}
