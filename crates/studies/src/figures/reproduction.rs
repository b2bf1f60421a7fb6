//! Everything together: the parts of the reproduction, and what they share.

use std::sync::{Arc, OnceLock};

use stickslip_plane::Range;
use stickslip_plane::atlas::{AtlasError, Frame, VerifiedAtlas, trace};
use stickslip_plane::progress::SILENT;

use super::section::Section;
use super::{boundaries, figure1, figure2, figure3, figure4, figure5, figure6, studies};
use crate::error::StudyError;
use crate::paper::{Reading, psi};
use crate::statements::Spring;

/// The reproduction of the paper.
#[derive(Debug)]
pub struct Reproduction {
    /// Columns and rows of a map.
    pub cells: usize,
    /// The model of the spring of which the statements are tested.
    pub spring: Spring,
    /// The boundaries of Figure 4, once they are traced.
    boundaries: OnceLock<Arc<VerifiedAtlas>>,
}

/// A part of the reproduction.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// What it is about.
    pub title: &'static str,
    run: fn(&Reproduction) -> Result<Section, StudyError>,
}

/// The largest value on the axis of stiffness in Figures 3 and 4.
pub(super) const MOST_STIFFNESS: f64 = 20.0;
/// The largest g_t/g_n in Figure 4.
pub(super) const MOST_RATIO: f64 = 4.0;

/// All parts, in the order in which a reader wants them.
const PARTS: [Part; 10] = [
    Part { title: figure1::TITLE, run: figure1::run },
    Part { title: figure2::TITLE, run: figure2::run },
    Part { title: figure3::TITLE, run: figure3::run },
    Part { title: figure4::TITLE, run: figure4::run },
    Part { title: figure5::TITLE, run: figure5::run },
    Part { title: figure6::TITLE, run: figure6::run },
    Part { title: boundaries::TITLE, run: boundaries::run },
    Part { title: studies::CONVERGENCE, run: studies::convergence },
    Part { title: studies::STIFF, run: studies::stiff },
    Part { title: studies::STATEMENTS, run: studies::statements },
];

impl Reproduction {
    /// A reproduction with maps of `cells` columns and rows, which tests the statements on a model
    /// of the spring.
    #[must_use]
    pub fn new(cells: usize, spring: Spring) -> Self {
        Self { cells, spring, boundaries: OnceLock::new() }
    }

    /// All parts, in the order in which a reader wants them.
    #[must_use]
    pub fn parts() -> &'static [Part] {
        &PARTS
    }

    /// The boundaries in the plane of Figure 4, in both readings, verified.
    ///
    /// # Errors
    /// [`AtlasError`]: they cannot be traced.
    pub(super) fn boundaries(&self) -> Result<&Arc<VerifiedAtlas>, AtlasError> {
        if let Some(verified) = self.boundaries.get() {
            return Ok(verified);
        }
        // The lower ends: boundaries never end at κ = 0 or ψ = 0. Below this ψ no boundary crosses
        // the line of the points.
        let kappa = Range { low: 0.05, high: Reading::Axis.kappa(MOST_STIFFNESS) };
        let psi = Range { low: 0.002, high: psi(MOST_RATIO) };
        let frame = Frame { kappa, psi, ratio: None, damping: 0.0 };
        let verified = trace(frame, frame.tolerances().usual, SILENT)?;
        Ok(self.boundaries.get_or_init(|| Arc::new(verified)))
    }
}

impl Part {
    /// Computes the part on the threads of the current pool.
    ///
    /// # Errors
    /// [`StudyError`]: a collision cannot be computed, boundaries cannot be traced, or a picture
    /// cannot be drawn.
    pub fn run(&self, reproduction: &Reproduction) -> Result<Section, StudyError> {
        (self.run)(reproduction)
    }
}

/// What is in an atlas and how it was verified, in a sentence.
pub(super) fn summary(verified: &VerifiedAtlas) -> String {
    let (map, report) = (&verified.atlas.regions, &verified.report);
    let agree = if report.agrees { "all agree with it" } else { "not all agree with it" };
    format!(
        "Traced were {} boundaries, {} vertices and {} regions. Of {} collisions computed at random \
         points and beside boundaries {agree}; with 95 % confidence less than {} of the plane is \
         wrong.",
        map.curves().len(),
        map.vertices().len(),
        map.regions().len(),
        report.tried,
        stickslip_figure::number(report.share_wrong_bound, 2)
    )
}
