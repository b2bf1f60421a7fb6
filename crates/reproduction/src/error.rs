//! What can go wrong in the reproduction of the paper.

use std::sync::Arc;

use stickslip_figure::FigureError;
use stickslip_model::{CollisionError, CollisionFailure, InvalidValue};
use stickslip_plane::atlas::AtlasError;
use stickslip_solver::Outcome;
use stickslip_studies::StudyError;

/// Why a part of the reproduction has no result.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReproductionError {
    /// A study that is a part of the reproduction has no result.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// The paper has no such statement.
    #[error("there is no statement {number}; expected 1 to {last}")]
    Statement {
        /// The number of the statement.
        number: u8,
        /// The number of the last one.
        last: u8,
    },
    /// Maps have no cells.
    #[error("maps of 0 cells; expected at least one")]
    NoCells,
    /// No collision has these parameters, or a search for an extremum or a zero failed.
    #[error(transparent)]
    Parameter(#[from] InvalidValue),
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
    /// A computation failed that several statements need.
    #[error(transparent)]
    Shared(Arc<ReproductionError>),
    /// A picture cannot be drawn.
    #[error(transparent)]
    Figure(#[from] FigureError),
}
