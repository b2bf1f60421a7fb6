//! A statement of the paper, and what was found of it.

use std::fmt;
use std::sync::Arc;

use fastrand::Rng;
use rayon::prelude::*;
use stickslip_model::text::minus;
use stickslip_studies::Cell;

use crate::error::ReproductionError;

/// A statement of the paper, tested.
#[derive(Debug)]
pub struct Statement {
    /// The number of the statement, from 1.
    pub number: u8,
    /// The statement in other words.
    pub paraphrase: &'static str,
    /// The place of the statement in the paper.
    pub place: &'static str,
    /// What was found of it.
    pub finding: StatementFinding,
}

/// What was found of a statement.
#[derive(Debug)]
pub struct StatementFinding {
    /// Whether the statement is true, by the rule that the explanation names.
    pub verdict: StatementVerdict,
    /// The condition under which it holds, if there is one.
    pub condition: Option<String>,
    /// The numbers from which the verdict follows.
    pub evidence: Evidence,
    /// What they mean, in sentences.
    pub explanation: String,
}

/// Whether a statement is true.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StatementVerdict {
    /// The statement is true.
    Holds,
    /// The statement is true under a condition.
    HoldsWithACondition,
    /// The statement is not true.
    DoesNotHold,
    /// The numbers leave the statement open.
    CannotBeDecided,
}

/// Why a test ends early.
#[derive(Clone, Debug)]
pub enum Stop {
    /// A collision cannot be computed. This is an error of the audit.
    Failed(Arc<ReproductionError>),
    /// The numbers leave the statement open, for this reason. This is a verdict.
    Open(String),
}

/// Numbers with their names.
#[derive(Debug, Default)]
pub struct Evidence(Vec<(String, Cell)>);

impl Statement {
    /// The command that tests this statement alone.
    pub fn command(&self) -> String {
        format!("stickslip reproduce --statement {}", self.number)
    }
}

impl StatementFinding {
    /// A finding without a condition.
    pub fn new(verdict: StatementVerdict, evidence: Evidence, explanation: String) -> Self {
        Self { verdict, condition: None, evidence, explanation }
    }

    /// The finding that a statement holds under `condition`.
    pub fn under(condition: String, evidence: Evidence, explanation: String) -> Self {
        let verdict = StatementVerdict::HoldsWithACondition;
        Self { verdict, condition: Some(condition), evidence, explanation }
    }

    /// The finding of a statement that is true or not in both readings of the axis of stiffness:
    /// as κ of (24), and as ακ.
    pub(super) fn by_reading(
        [printed, axis]: [bool; 2],
        evidence: Evidence,
        explanation: String,
    ) -> Self {
        match (printed, axis) {
            (true, _) => Self::new(StatementVerdict::Holds, evidence, explanation),
            (false, true) => {
                let condition = "if the figures' κ is α times that of (24)".to_owned();
                Self::under(condition, evidence, explanation)
            }
            (false, false) => Self::new(StatementVerdict::DoesNotHold, evidence, explanation),
        }
    }
}

impl StatementVerdict {
    /// The verdict on a statement that is either true or not.
    pub fn of(holds: bool) -> Self {
        if holds { Self::Holds } else { Self::DoesNotHold }
    }
}

impl fmt::Display for StatementVerdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Holds => "holds",
            Self::HoldsWithACondition => "holds with a condition",
            Self::DoesNotHold => "does not hold",
            Self::CannotBeDecided => "cannot be decided",
        })
    }
}

impl Stop {
    /// The finding of a test. If the test leaves the statement open, that is a finding too, with
    /// the verdict "cannot be decided".
    ///
    /// # Errors
    /// [`ReproductionError`]: a collision cannot be computed.
    pub fn into_finding(
        tested: Result<StatementFinding, Self>,
    ) -> Result<StatementFinding, ReproductionError> {
        match tested {
            Ok(finding) => Ok(finding),
            Err(Self::Open(reason)) => Ok(StatementFinding::new(
                StatementVerdict::CannotBeDecided,
                Evidence::default(),
                reason,
            )),
            Err(Self::Failed(error)) => {
                Err(Arc::try_unwrap(error).unwrap_or_else(ReproductionError::Shared))
            }
        }
    }
}

impl<E: Into<ReproductionError>> From<E> for Stop {
    fn from(error: E) -> Self {
        Self::Failed(Arc::new(error.into()))
    }
}

impl Evidence {
    /// The evidence with a further number.
    pub fn number(mut self, name: impl Into<String>, value: f64) -> Self {
        self.0.push((name.into(), value.into()));
        self
    }

    /// The evidence with a further count.
    pub fn count(mut self, name: impl Into<String>, value: usize) -> Self {
        self.0.push((name.into(), value.into()));
        self
    }

    /// The evidence with further words.
    pub fn text(mut self, name: impl Into<String>, value: impl Into<String>) -> Self {
        self.0.push((name.into(), Cell::Text(value.into())));
        self
    }

    /// All numbers with their names, in order.
    pub fn iter(&self) -> impl Iterator<Item = &(String, Cell)> {
        self.0.iter()
    }
}

/// The results of `of` for all `inputs`, in their order, on the threads of the current pool.
///
/// # Errors
/// The first error in that order, whatever the number of threads.
pub fn each<T: Sync, U: Send>(
    inputs: &[T],
    of: impl Fn(&T) -> Result<U, ReproductionError> + Send + Sync,
) -> Result<Vec<U>, ReproductionError> {
    let results: Vec<_> = inputs.par_iter().map(of).collect();
    results.into_iter().collect()
}

/// Random collisions [κ, ψ, a]: κ from 0.05 to 1000 and, if damped, a from 0.001 to 1, evenly in
/// the logarithm; ψ from 0.01 to 3.
pub fn random(count: usize, seed: u64, damped: bool) -> Vec<[f64; 3]> {
    let mut random = Rng::with_seed(seed);
    let mut draw = || {
        let kappa = 0.05 * 20_000_f64.powf(random.f64());
        let psi = 0.01 + 2.99 * random.f64();
        [kappa, psi, if damped { 1e-3 * 1e3_f64.powf(random.f64()) } else { 0.0 }]
    };
    (0..count).map(|_| draw()).collect()
}

/// `count` numbers from `low` to `high`, evenly in the logarithm.
pub fn geometric(low: f64, high: f64, count: usize) -> impl Iterator<Item = f64> + Clone {
    (0..count).map(move |i| low * (high / low).powf(i as f64 / (count - 1) as f64))
}

/// `value` to so many places, without zeros at its end.
pub fn digits(value: f64, places: usize) -> String {
    // Adding 0 makes −0 a 0.
    minus(&(format!("{value:.places$}").parse().unwrap_or(value) + 0.0).to_string())
}
