//! What can go wrong in a study.

use std::sync::Arc;

use stickslip_figure::FigureError;
use stickslip_model::{CollisionError, Contact, EngineError, InvalidParameter};
use stickslip_plane::atlas::AtlasError;
use stickslip_solver::Outcome;

use crate::convergence::InvalidConvergence;
use crate::search::SearchError;
use crate::stiff_springs::InvalidStiffSprings;
use crate::stiff_springs::limit::StiffError;

/// Why a study has no result.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// The settings of a study of convergence are out of range.
    #[error(transparent)]
    Convergence(#[from] InvalidConvergence),
    /// The settings of a study of stiff springs are out of range.
    #[error(transparent)]
    StiffSprings(#[from] InvalidStiffSprings),
    /// No collision has these parameters.
    #[error(transparent)]
    Parameter(#[from] InvalidParameter),
    /// A collision cannot be computed.
    #[error(transparent)]
    Collision(#[from] CollisionFailure),
    /// A contact with Coulomb friction alone cannot be integrated.
    #[error("pure sliding at psi = {psi:?}: {source}")]
    Sliding {
        /// The reduced impact ratio.
        psi: f64,
        /// What the integrator reports.
        source: CollisionError,
    },
    /// A contact does not end.
    #[error("kappa = {kappa:?}, psi = {psi:?}: the contact does not end: {outcome:?}")]
    Unended {
        /// The stiffness κ.
        kappa: f64,
        /// The reduced impact ratio ψ.
        psi: f64,
        /// How its integration ended.
        outcome: Outcome,
    },
    /// The limit of stiff springs cannot be studied.
    #[error("the limit of stiff springs cannot be studied: {0}")]
    Stiff(#[from] StiffError),
    /// Boundaries cannot be traced.
    #[error("the boundaries cannot be traced: {0}")]
    Atlas(#[from] AtlasError),
    /// The points of Figure 4 cannot be named: their line crosses another number of regions than
    /// the paper has points.
    #[error("the line at κ = {kappa} crosses {found} regions; expected {expected}")]
    Regions {
        /// The stiffness κ of the line.
        kappa: f64,
        /// The number of regions that were found.
        found: usize,
        /// The number of points, with the one that has no letter.
        expected: usize,
    },
    /// The largest elongation of the spring has no closed form.
    #[error("kappa = {kappa:?}, psi = {psi:?}: the largest elongation has no closed form")]
    NoElongation {
        /// The stiffness κ.
        kappa: f64,
        /// The reduced impact ratio ψ.
        psi: f64,
    },
    /// A search for an extremum has no result.
    #[error(transparent)]
    Search(#[from] SearchError),
    /// A computation failed that several statements need.
    #[error(transparent)]
    Shared(Arc<StudyError>),
    /// A picture cannot be drawn.
    #[error(transparent)]
    Figure(#[from] FigureError),
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
