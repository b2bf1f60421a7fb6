//! What can go wrong in a study.

use stickslip_model::exact::ExactError;
use stickslip_model::{CollisionFailure, InvalidValue, OtherLaw};

/// Why a study has no result.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StudyError {
    /// Settings are out of range, or a search for a maximum or a zero failed.
    #[error(transparent)]
    Settings(#[from] InvalidValue),
    /// A collision has another law than the paper's.
    #[error(transparent)]
    Law(#[from] OtherLaw),
    /// The run of a system fails.
    #[error("the run failed: {0}")]
    Run(String),
    /// A collision cannot be computed.
    #[error(transparent)]
    Collision(#[from] CollisionFailure),
    /// The exact engine refuses a collision with a stiff spring.
    #[error("the limit of stiff springs cannot be studied: {0}")]
    Exact(#[from] ExactError),
}
