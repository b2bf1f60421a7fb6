//! A statement of the paper and what was found of it.

use std::fmt;
use std::sync::Arc;

use crate::error::StudyError;
use crate::study::Cell;

/// A statement of the paper, tested.
#[derive(Debug)]
pub struct Statement {
    /// From 1.
    pub number: u8,
    /// What it says, in other words.
    pub paraphrase: &'static str,
    /// Where it stands in the paper.
    pub place: &'static str,
    /// What was found.
    pub finding: Finding,
}

/// What was found of a statement.
#[derive(Debug)]
pub struct Finding {
    /// Whether it is true, by the rule that the explanation names.
    pub verdict: Verdict,
    /// Under which condition, if it holds under one.
    pub condition: Option<String>,
    /// The numbers from which the verdict follows.
    pub evidence: Evidence,
    /// What they mean, in sentences.
    pub explanation: String,
}

/// Whether a statement is true.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It is true.
    Holds,
    /// It is true under a condition.
    HoldsWithACondition,
    /// It is not true.
    DoesNotHold,
    /// The numbers leave it open.
    CannotBeDecided,
}

/// Why there is no finding.
#[derive(Clone, Debug)]
pub enum Stop {
    /// A collision cannot be computed.
    Failed(Arc<StudyError>),
    /// The numbers leave it open, and how.
    Open(String),
}

/// Numbers with their names.
#[derive(Debug, Default)]
pub struct Evidence(Vec<(String, Cell)>);

impl Statement {
    /// The command that tests it alone.
    #[must_use]
    pub fn command(&self) -> String {
        format!("stickslip reproduce --statement {}", self.number)
    }
}

impl Finding {
    /// A finding without a condition.
    #[must_use]
    pub fn new(verdict: Verdict, evidence: Evidence, explanation: String) -> Self {
        Self { verdict, condition: None, evidence, explanation }
    }

    /// One that holds under `condition`.
    #[must_use]
    pub fn under(condition: String, evidence: Evidence, explanation: String) -> Self {
        let verdict = Verdict::HoldsWithACondition;
        Self { verdict, condition: Some(condition), evidence, explanation }
    }

    /// One that is open, and why.
    #[must_use]
    pub fn open(reason: String) -> Self {
        Self::new(Verdict::CannotBeDecided, Evidence::default(), reason)
    }
}

impl Verdict {
    /// That of a statement which is true or not.
    #[must_use]
    pub fn of(holds: bool) -> Self {
        if holds { Self::Holds } else { Self::DoesNotHold }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Holds => "holds",
            Self::HoldsWithACondition => "holds with a condition",
            Self::DoesNotHold => "does not hold",
            Self::CannotBeDecided => "cannot be decided",
        })
    }
}

impl<E: Into<StudyError>> From<E> for Stop {
    fn from(error: E) -> Self {
        Self::Failed(Arc::new(error.into()))
    }
}

impl Evidence {
    /// With a number.
    #[must_use]
    pub fn number(mut self, name: impl Into<String>, value: f64) -> Self {
        self.0.push((name.into(), Cell::Number(value)));
        self
    }

    /// With a count.
    #[must_use]
    pub fn count(mut self, name: impl Into<String>, value: usize) -> Self {
        self.0.push((name.into(), Cell::Count(value as u64)));
        self
    }

    /// With words.
    #[must_use]
    pub fn text(mut self, name: impl Into<String>, value: impl Into<String>) -> Self {
        self.0.push((name.into(), Cell::Text(value.into())));
        self
    }

    /// All numbers with their names, in order.
    pub fn iter(&self) -> impl Iterator<Item = &(String, Cell)> {
        self.0.iter()
    }
}
