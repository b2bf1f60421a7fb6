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
    #[error(
        "component {component} of the state at s = {s}, where the run or a phase starts, is not finite"
    )]
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
    /// A guard is not a number; it is looked at a little beyond its zeros too.
    #[error("guard {guard} is not a number near s = {s}")]
    GuardNotANumber {
        /// The guard's index.
        guard: usize,
        /// Where the step started.
        s: f64,
    },
    /// A guard is zero throughout a step, so that its crossings mean nothing. Where a mode has no
    /// use for it, it is [`Guard::OFF`](crate::Guard::OFF).
    #[error(
        "guard {guard} is identically zero on a step from s = {s}; a mode that does not use it turns it off"
    )]
    GuardIdenticallyZero {
        /// The guard's index.
        guard: usize,
        /// Where the step started.
        s: f64,
    },
    /// A guard has more structure than any step can resolve: it is not smooth there, or does not
    /// start from the zero of which [`Guard::from_zero`](crate::Guard::from_zero) tells.
    #[error(
        "guard {guard} cannot be resolved near s = {s} by a step of {h:e}: it is not smooth, or does not start from the zero that it \
         is said to start from"
    )]
    GuardUnresolved {
        /// The guard's index.
        guard: usize,
        /// Where the step started.
        s: f64,
        /// The last step tried.
        h: f64,
    },
}
