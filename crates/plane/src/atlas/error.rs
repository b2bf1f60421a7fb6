//! Why a window has no atlas.

use stickslip_model::{CollisionError, InvalidValue, OutOfDomain};
use stickslip_tracer::{SubdivisionError, TraceError, VerifyError};

use crate::family::{CollisionFamilyError, CollisionPlane};
use crate::sheet::TooNarrow;

/// The reason why a window has no atlas.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AtlasError {
    /// No collision has the parameters of the window.
    #[error(transparent)]
    Parameter(#[from] InvalidValue),
    /// The window is too narrow.
    #[error(transparent)]
    Narrow(#[from] TooNarrow),
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
        source: CollisionFamilyError,
    },
    /// The tracer failed for another reason than a run.
    #[error(transparent)]
    Trace(#[from] TraceError<CollisionFamilyError>),
    /// The curves do not make regions.
    #[error(transparent)]
    Subdivision(#[from] SubdivisionError),
    /// The verification failed.
    #[error(transparent)]
    Verify(#[from] VerifyError),
    /// A collision cannot be computed.
    #[error(transparent)]
    Label(#[from] LabelError),
}

/// The collision at a place of the window cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LabelError {
    /// No collision has these parameters.
    #[error(transparent)]
    Parameter(#[from] InvalidValue),
    /// The integration failed.
    #[error(transparent)]
    Collision(#[from] CollisionError),
}

impl AtlasError {
    /// The error of a trace of `plane`.
    #[must_use]
    pub fn of(plane: &CollisionPlane, error: TraceError<CollisionFamilyError>) -> Self {
        match error {
            TraceError::Run { point, source } => {
                let contact = plane.contact_or_any(&point);
                Self::Run { kappa: contact.kappa(), psi: contact.psi(), source }
            }
            error => Self::Trace(error),
        }
    }

    /// The error of an atlas of `plane`.
    pub(crate) fn of_atlas(
        plane: &CollisionPlane,
        error: stickslip_tracer::AtlasError<CollisionFamilyError>,
    ) -> Self {
        match error {
            stickslip_tracer::AtlasError::Trace(error) => Self::of(plane, error),
            stickslip_tracer::AtlasError::Subdivision(error) => Self::Subdivision(error),
            stickslip_tracer::AtlasError::Verify(error) => Self::Verify(error),
        }
    }
}
