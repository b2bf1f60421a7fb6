//! A statement of the paper and what was found of it.

use std::fmt;

use crate::error::Failure;
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
    Holds,
    HoldsWithACondition,
    DoesNotHold,
    CannotBeDecided,
}

/// Why there is no finding.
pub enum Stop {
    /// A collision cannot be computed.
    Failed(Failure),
    /// The numbers leave it open, and how.
    Open(String),
}

/// Numbers with their names.
#[derive(Debug, Default)]
pub struct Evidence(Vec<(String, Cell)>);

impl Statement {
    /// The command that tests it alone.
    pub fn command(&self) -> String {
        format!("stickslip reproduce --statement {}", self.number)
    }
}

impl Finding {
    /// A finding without a condition.
    pub fn new(verdict: Verdict, evidence: Evidence, explanation: String) -> Self {
        Self { verdict, condition: None, evidence, explanation }
    }

    /// One that holds under `condition`.
    pub fn under(condition: String, evidence: Evidence, explanation: String) -> Self {
        let verdict = Verdict::HoldsWithACondition;
        Self { verdict, condition: Some(condition), evidence, explanation }
    }

    /// One that is open, and why.
    pub fn open(reason: String) -> Self {
        Self::new(Verdict::CannotBeDecided, Evidence::default(), reason)
    }
}

impl Verdict {
    /// That of a statement which is true or not.
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

impl From<Failure> for Stop {
    fn from(failure: Failure) -> Self {
        Self::Failed(failure)
    }
}

impl Evidence {
    /// With a number.
    pub fn number(mut self, name: impl Into<String>, value: f64) -> Self {
        self.0.push((name.into(), Cell::Number(value)));
        self
    }

    /// With a count.
    pub fn count(mut self, name: impl Into<String>, value: usize) -> Self {
        self.0.push((name.into(), Cell::Count(value as u64)));
        self
    }

    /// With words.
    pub fn text(mut self, name: impl Into<String>, value: impl Into<String>) -> Self {
        self.0.push((name.into(), Cell::Text(value.into())));
        self
    }

    /// In order.
    pub fn iter(&self) -> impl Iterator<Item = &(String, Cell)> {
        self.0.iter()
    }
}
