//! What the parts of the reproduction share.

use std::sync::{Arc, OnceLock};

use stickslip_plane::Range;
use stickslip_plane::atlas::{AtlasError, CollisionAtlas, Frame, trace};
use stickslip_plane::progress::SILENT;
use stickslip_studies::paper::{MOST_RATIO_4, MOST_STIFFNESS, Reading, psi};

use crate::statements::Spring;

/// The reproduction of the paper.
#[derive(Debug)]
pub struct Reproduction {
    /// The number of columns and of rows of a map.
    pub cells: usize,
    /// The model of the spring on which the statements are tested.
    pub spring: Spring,
    /// The boundaries of Figure 4, once they are traced.
    boundaries: OnceLock<Arc<CollisionAtlas>>,
}

impl Reproduction {
    /// A reproduction with maps of `cells` columns and rows, which tests the statements on a model
    /// of the spring.
    pub fn new(cells: usize, spring: Spring) -> Self {
        Self { cells, spring, boundaries: OnceLock::new() }
    }

    /// The boundaries in the plane of Figure 4, in both readings, verified.
    ///
    /// # Errors
    /// [`AtlasError`]: they cannot be traced.
    pub(super) fn boundaries(&self) -> Result<&Arc<CollisionAtlas>, AtlasError> {
        if let Some(verified) = self.boundaries.get() {
            return Ok(verified);
        }
        // Boundaries go on towards κ = 0 and ψ = 0 without end, so the window must stop above 0.
        // Below this ψ no boundary crosses the line of the points.
        let kappa = Range { low: 0.05, high: Reading::Axis.kappa(MOST_STIFFNESS) };
        let psi = Range { low: 0.002, high: psi(MOST_RATIO_4) };
        let frame = Frame::new(kappa, psi, 0.0);
        let verified = trace(frame, frame.tolerances().usual, SILENT)?;
        Ok(self.boundaries.get_or_init(|| Arc::new(verified)))
    }
}
