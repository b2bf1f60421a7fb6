//! What can go wrong in a study.

use std::sync::Arc;

use stickslip_figure::FigureError;
use stickslip_model::{CollisionError, Contact, EngineError, InvalidParameter};
use stickslip_plane::atlas::AtlasError;
use stickslip_plane::family::CollisionFamilyError;
use stickslip_solver::{Outcome, RunError};
use stickslip_tracer::TraceError;

use crate::convergence::InvalidConvergence;
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
    /// A collision cannot be computed.
    #[error(transparent)]
    Collision(#[from] CollisionFailure),
    /// No collision has these parameters.
    #[error(transparent)]
    Parameter(#[from] InvalidParameter),
    /// A contact with Coulomb friction alone cannot be integrated.
    #[error("pure sliding: {0}")]
    Sliding(#[from] CollisionError),
    /// A run that is not a collision failed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A contact does not end.
    #[error("a contact does not end: {outcome:?}")]
    Unended {
        /// How the run ended.
        outcome: Outcome,
    },
    /// The limit of stiff springs cannot be studied.
    #[error("the limit of stiff springs cannot be studied: {0}")]
    Stiff(#[from] StiffError),
    /// Boundaries cannot be traced.
    #[error("the boundaries cannot be traced: {0}")]
    Atlas(#[from] AtlasError),
    /// The boundaries near a line of one stiffness cannot be traced.
    #[error("the boundaries cannot be traced: {0}")]
    Trace(#[from] TraceError<CollisionFamilyError>),
    /// A margin cannot be computed.
    #[error("the boundaries cannot be traced: {0}")]
    Margin(#[from] CollisionFamilyError),
    /// A line of one stiffness crosses another number of regions than the paper has points.
    #[error("the line at κ = {kappa} crosses {found} regions; expected {expected}")]
    Regions {
        /// The stiffness.
        kappa: f64,
        /// The number of regions.
        found: usize,
        /// The number of points.
        expected: usize,
    },
    /// A collision has no phase on its spring, whose elongation was asked for.
    #[error("no spring at κ = {kappa:?}, ψ = {psi:?}")]
    NoSpring {
        /// The stiffness.
        kappa: f64,
        /// The impact ratio.
        psi: f64,
    },
    /// There are switches above the boundary of pure sliding.
    #[error("κ = {kappa}: switches at ψ = {psi} above {boundary}, where they had ended")]
    SwitchesAbove {
        /// The stiffness.
        kappa: f64,
        /// The impact ratio with switches.
        psi: f64,
        /// The boundary that was found.
        boundary: f64,
    },
    /// A search for an extremum has no place to start from.
    #[error("a search for an extremum has no places")]
    NoPlaces,
    /// A search for an extremum failed.
    #[error("a search for an extremum failed: {0}")]
    Search(#[from] argmin::core::Error),
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
