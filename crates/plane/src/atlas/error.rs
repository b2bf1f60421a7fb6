//! Why a window has no atlas.

use stickslip_model::{CollisionError, InvalidValue, OutOfDomain};
use stickslip_tracer::TraceError;

use crate::family::CollisionPlane;

/// The reason why a window has no atlas or no stack.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AtlasError {
    /// No collision has the parameters of the window, or the window is too narrow.
    #[error(transparent)]
    Parameter(#[from] InvalidValue),
    /// The window is out of the range of the integrator, which verifies an atlas.
    #[error("an atlas is verified by integration: {0}")]
    Unverifiable(#[from] OutOfDomain),
    /// The boundaries cannot have this accuracy in the window.
    #[error(
        "the tolerance {tolerance:?} is out of range; expected {finest:e} to {coarsest:e} in this window"
    )]
    Tolerance {
        /// The accuracy that was asked for.
        tolerance: f64,
        /// The finest possible.
        finest: f64,
        /// The coarsest possible.
        coarsest: f64,
    },
    /// A run of the tracer failed.
    #[error("kappa = {kappa:?}, psi = {psi:?}: {source}")]
    Run {
        /// κ of the run.
        kappa: f64,
        /// ψ of the run.
        psi: f64,
        /// The error of the run.
        source: CollisionError,
    },
    /// The tracer failed for another reason than a run, or the curves do not make regions.
    #[error(transparent)]
    Trace(#[from] TraceError<CollisionError>),
    /// A collision cannot be computed.
    #[error(transparent)]
    Collision(#[from] CollisionError),
    /// The dampings of a stack are not possible.
    #[error(
        "{dampings:?}; expected two dampings above 0 or more, in ascending order, and 0 before \
         them or not"
    )]
    Dampings {
        /// The dampings.
        dampings: Vec<f64>,
    },
    /// An atlas of a stack failed.
    #[error("damping = {damping:?}: {source}")]
    Layer {
        /// The damping.
        damping: f64,
        /// The error of the atlas.
        source: Box<Self>,
    },
}

impl AtlasError {
    /// The error of a trace of `plane`.
    pub fn of(plane: &CollisionPlane, error: TraceError<CollisionError>) -> Self {
        match error {
            TraceError::Run { point, source } => {
                let contact = plane.contact_or_any(&point);
                Self::Run { kappa: contact.kappa(), psi: contact.psi(), source }
            }
            error => Self::Trace(error),
        }
    }
}
