//! Why a run fails.

use stickslip_number::InvalidValue;

use crate::hybrid::Outcome;

/// Why a run failed. Every variant carries the numbers that say where.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// An option is out of its range.
    #[error(transparent)]
    Option(#[from] InvalidValue),
    /// The end of the run does not lie after its start, in the direction of the run, or the start
    /// is not finite.
    #[error(
        "cannot run from s = {from} to s = {to}: the end must lie after a finite start, or before \
         it if the run goes backwards"
    )]
    Span {
        /// The start of the run.
        from: f64,
        /// The end of the run.
        to: f64,
    },
    /// A state from which the run or one of its phases starts is not finite.
    #[error(
        "component {component} of the state at s = {s}, where the run or a phase starts, is not \
         finite"
    )]
    State {
        /// Where the run or the phase starts.
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
    /// The error exceeds the tolerance on every step that still moves the time.
    #[error("the tolerance cannot be met at s = {s}: a step of {h:e} is too long (step {step})")]
    Tolerance {
        /// Where the step started.
        s: f64,
        /// The size of the last step tried.
        h: f64,
        /// Steps tried so far.
        step: usize,
    },
    /// A guard is not a number. Guards are evaluated a little beyond their zeros too.
    #[error("guard {guard} is not a number near s = {s}")]
    GuardNotANumber {
        /// The guard's index.
        guard: usize,
        /// Where the step started.
        s: f64,
    },
    /// A guard is zero throughout a step, so that its crossings have no meaning. A mode that does
    /// not use a guard returns [`Guard::OFF`](crate::Guard::OFF) for it.
    #[error(
        "guard {guard} is zero on a whole step from s = {s}, or its rounding hides that it is not; \
         expected that a mode turns off a guard that it does not use, and a form without \
         cancellation, such as expm1(x) instead of exp(x) - 1"
    )]
    GuardIdenticallyZero {
        /// The guard's index.
        guard: usize,
        /// Where the step started.
        s: f64,
    },
    /// The schedule of a clock is not valid: its period is not a finite number above 0, or its
    /// phase or a time is not a number.
    #[error(
        "the schedule of a clock has no time after s = {s}; expected a period above 0 and times that \
         are numbers"
    )]
    Schedule {
        /// The place from which the next time was computed.
        s: f64,
    },
    /// Transitions lead to further transitions and no time passes
    /// ([`Options::max_at_one_instant`](crate::Options::max_at_one_instant)). Observers do not keep
    /// these transitions.
    #[error(
        "{count} transitions follow each other at s = {s}, and no end is in sight: {}, again and \
         again. Guards may contradict each other there, or the state has to slide along a surface",
        listed(cycle)
    )]
    Cycle {
        /// The place of the transitions.
        s: f64,
        /// Their number.
        count: usize,
        /// The guards that repeat, or the last ones, each with its mode as `Debug` writes it.
        cycle: Vec<(usize, String)>,
    },
    /// A guard has more structure than any step can resolve. It is not smooth there, or it starts
    /// from a zero of another order than [`Guard::from_zero`](crate::Guard::from_zero) declares.
    #[error(
        "guard {guard} cannot be resolved near s = {s} by a step of {h:e}: it is not smooth there, \
         or starts from a zero of another order than was declared for it"
    )]
    GuardUnresolved {
        /// The guard's index.
        guard: usize,
        /// Where the step started.
        s: f64,
        /// The size of the last step tried.
        h: f64,
    },
    /// The run ended before it reached the end of its span or a terminal guard. Only
    /// [`Run::finished`](crate::Run::finished) makes this an error.
    #[error("the run ended early, at s = {s}: {outcome:?}")]
    Unfinished {
        /// Why the run ended.
        outcome: Outcome,
        /// Where the run ended.
        s: f64,
    },
}

impl RunError {
    /// Nothing if a run with this `outcome` came to a regular end, at `s`.
    pub(crate) fn unless_regular(outcome: Outcome, s: f64) -> Result<(), Self> {
        match outcome {
            Outcome::ReachedEnd | Outcome::EndedByGuard { .. } => Ok(()),
            outcome => Err(Self::Unfinished { outcome, s }),
        }
    }

    /// No step from `s`, the last one of size `h`, resolves a guard. `known` says whether it has
    /// values there.
    pub(crate) fn unresolved(guard: usize, (s, h): (f64, f64), known: bool) -> Self {
        if known {
            Self::GuardUnresolved { guard, s, h }
        } else {
            Self::GuardNotANumber { guard, s }
        }
    }

    /// The error of a run in s that failed as a run in −s.
    pub(crate) fn reversed(mut self) -> Self {
        match &mut self {
            Self::Option(_) => {}
            Self::Span { from, to } => (*from, *to) = (0.0 - *from, 0.0 - *to),
            Self::State { s, .. }
            | Self::Field { s, .. }
            | Self::Schedule { s }
            | Self::Cycle { s, .. }
            | Self::Tolerance { s, .. }
            | Self::GuardNotANumber { s, .. }
            | Self::GuardIdenticallyZero { s, .. }
            | Self::GuardUnresolved { s, .. }
            | Self::Unfinished { s, .. } => *s = 0.0 - *s,
        }
        self
    }
}

fn listed(cycle: &[(usize, String)]) -> String {
    let named = cycle.iter().map(|(guard, mode)| format!("guard {guard} of mode {mode}"));
    named.collect::<Vec<_>>().join(", ")
}
