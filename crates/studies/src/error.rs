//! What can go wrong in a study.

use stickslip_model::exact::ExactError;
use stickslip_model::{Contact, EngineError, InvalidParameter, OtherLaw};

use crate::limits::{MOST_CELLS, MOST_LAWS, MOST_PSI, MOST_STIFFNESS, STIFFNESSES};
use crate::search::SearchError;

/// Why a study has no result.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// The settings of a study of convergence are out of range.
    #[error(transparent)]
    Convergence(#[from] InvalidConvergence),
    /// The settings of a study of contact laws are out of range.
    #[error(transparent)]
    ContactLaws(#[from] InvalidContactLaws),
    /// The run of a system fails.
    #[error("the run failed: {0}")]
    Run(String),
    /// The settings of a study of stiff springs are out of range.
    #[error(transparent)]
    StiffSprings(#[from] InvalidStiffSprings),
    /// A collision cannot be computed.
    #[error(transparent)]
    Collision(#[from] CollisionFailure),
    /// The limit of stiff springs cannot be studied.
    #[error("the limit of stiff springs cannot be studied: {0}")]
    Stiff(#[from] StiffError),
}

/// The settings of a study of convergence are out of range.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum InvalidConvergence {
    /// There is nothing to measure.
    #[error("a study of 0 collisions; expected at least one")]
    NoContacts,
    /// A collision is too stiff.
    #[error(
        "kappa = {kappa:?} is out of range; expected a number above 0, at most {MOST_STIFFNESS:?}"
    )]
    Stiff {
        /// The stiffness of the collision.
        kappa: f64,
    },
    /// A collision has another law than the paper's.
    #[error(transparent)]
    Law(#[from] OtherLaw),
}

/// The settings of a study of contact laws are out of range.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum InvalidContactLaws {
    /// There are no laws, or too many.
    #[error("{count} laws; expected 1 to {MOST_LAWS}")]
    LawCount {
        /// The number of laws.
        count: usize,
    },
    /// There are no cells, or too many.
    #[error("{cells} cells along an axis; expected 1 to {MOST_CELLS}")]
    Cells {
        /// The number of cells.
        cells: usize,
    },
    /// An interval is empty, or reaches below 0.
    #[error("{name} {low:?}:{high:?} is out of range; expected LO:HI with 0 <= LO < HI")]
    Window {
        /// The name of the axis.
        name: &'static str,
        /// The lower end of the interval.
        low: f64,
        /// The upper end of the interval.
        high: f64,
    },
    /// A parameter is out of range for one of the laws.
    #[error(transparent)]
    Parameter(#[from] InvalidParameter),
}

/// The settings of a study of stiff springs are out of range.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum InvalidStiffSprings {
    /// The interval of the stiffness is out of range.
    #[error(
        "kappa {low:?}:{high:?} is out of range; expected LO:HI with {:?} <= LO < HI <= {:?}",
        STIFFNESSES.low, STIFFNESSES.high
    )]
    Kappa {
        /// The lower end of the interval.
        low: f64,
        /// The upper end of the interval.
        high: f64,
    },
    /// There are too few or too many impact ratios.
    #[error("psi has {count} values; expected 1 to {MOST_PSI}")]
    PsiCount {
        /// The number of impact ratios.
        count: usize,
    },
    /// An impact ratio is out of range.
    #[error(
        "psi {psi:?} is out of range; expected numbers above 0 and below 2, from where on there is no \
         switch"
    )]
    Psi {
        /// The impact ratio.
        psi: f64,
    },
    /// An impact ratio is given twice.
    #[error("psi has {psi:?} twice; expected each value once")]
    PsiTwice {
        /// The impact ratio.
        psi: f64,
    },
}

/// Why the limit of stiff springs has no maximum.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StiffError {
    /// A parameter is out of its range.
    #[error(transparent)]
    Parameter(#[from] InvalidParameter),
    /// The exact engine refuses a collision.
    #[error(transparent)]
    Exact(#[from] ExactError),
    /// The search for a maximum failed.
    #[error(transparent)]
    Search(#[from] SearchError),
}

/// A collision cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("kappa = {kappa:?}, psi = {psi:?}, damping = {damping:?}: {source}")]
pub struct CollisionFailure {
    /// Scaled stiffness of the contact.
    pub kappa: f64,
    /// Its reduced impact ratio.
    pub psi: f64,
    /// Its scaled damping.
    pub damping: f64,
    /// What the engine reports.
    pub source: EngineError,
}

impl CollisionFailure {
    /// The failure of an engine at `contact`.
    pub fn new(contact: &Contact, source: impl Into<EngineError>) -> Self {
        let (kappa, psi, damping) = (contact.kappa(), contact.psi(), contact.damping());
        Self { kappa, psi, damping, source: source.into() }
    }
}
