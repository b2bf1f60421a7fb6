//! What can go wrong in a study.

use stickslip_figure::FigureError;
use stickslip_model::{Contact, EngineError};

use crate::contact_laws::InvalidContactLaws;
use crate::convergence::InvalidConvergence;
use crate::stiff_springs::InvalidStiffSprings;
use crate::stiff_springs::limit::StiffError;

/// Why a study has no result.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// The settings of a study of convergence are out of range.
    #[error(transparent)]
    Convergence(#[from] InvalidConvergence),
    /// The settings of a study of contact laws are out of range.
    #[error(transparent)]
    ContactLaws(#[from] InvalidContactLaws),
    /// A picture cannot be drawn.
    #[error(transparent)]
    Picture(#[from] FigureError),
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

/// A collision cannot be computed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
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
