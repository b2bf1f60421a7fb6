//! Why a collision cannot be computed.

use stickslip_contact::domain::OutOfDomain;
use stickslip_contact::{Contact, InvalidValue, NotFinite, OtherLaw};
use stickslip_exact::exact::ExactError;
use stickslip_solver::{Outcome, RunError};

/// The reason why a collision cannot be computed, or why there is none.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CollisionError {
    /// No collision has these parameters.
    #[error(transparent)]
    Parameter(#[from] InvalidValue),
    /// The exact solution does not apply to the contact.
    #[error(transparent)]
    Exact(#[from] ExactError),
    /// The contact is out of the integrator's range.
    #[error(transparent)]
    Domain(#[from] OutOfDomain),
    /// The integration failed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The contact has another law than the paper's.
    #[error(transparent)]
    Law(#[from] OtherLaw),
    /// The contact did not end.
    #[error("the contact has not ended at scaled time {time}: {outcome:?}")]
    Unfinished {
        /// The reason why the run stopped.
        outcome: Outcome,
        /// Scaled time reached.
        time: f64,
    },
    /// The contact creeps. Where Coulomb's limit holds for the spring alone, a strong dashpot may
    /// keep the spring at its limit: in stick it would exceed the limit at once, and in slip it
    /// would stick at once.
    #[error(
        "the contact creeps from scaled time {time} on: its spring stays at its limit, between stick \
         and slip, which is not computed; expected a weaker tangential damping, or 0"
    )]
    Creeping {
        /// Scaled time at which that begins.
        time: f64,
    },
    /// The bodies stay together for ever, held by adhesion, and what is asked for needs an end of
    /// the contact.
    #[error(
        "the bodies stay together, held by adhesion: that is certain from scaled time {time} on"
    )]
    Adheres {
        /// Scaled time at which that is certain.
        time: f64,
    },
    /// A result is beyond the range of doubles.
    #[error(transparent)]
    NotFinite(#[from] NotFinite),
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
    pub source: CollisionError,
}

impl CollisionFailure {
    /// The failure of an engine at `contact`.
    pub fn new(contact: &Contact, source: impl Into<CollisionError>) -> Self {
        let (kappa, psi, damping) = (contact.kappa(), contact.psi(), contact.damping());
        Self { kappa, psi, damping, source: source.into() }
    }
}
