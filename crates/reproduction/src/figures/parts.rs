//! All parts of the reproduction, in order.

use stickslip_studies::{convergence, stiff_springs};

use super::reproduction::Reproduction;
use super::section::Section;
use super::{boundaries, figure1, figure2, figure3, figure4, figure5, figure6, studies};
use crate::error::ReproductionError;
use crate::statements;

/// A part of the reproduction.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// The title of the part.
    pub title: &'static str,
    run: fn(&Reproduction) -> Result<Section, ReproductionError>,
}

const PARTS: [Part; 10] = [
    Part { title: figure1::TITLE, run: figure1::run },
    Part { title: figure2::TITLE, run: figure2::run },
    Part { title: figure3::TITLE, run: figure3::run },
    Part { title: figure4::TITLE, run: figure4::run },
    Part { title: figure5::TITLE, run: figure5::run },
    Part { title: figure6::TITLE, run: figure6::run },
    Part { title: boundaries::TITLE, run: boundaries::run },
    Part { title: convergence::TITLE, run: studies::convergence },
    Part { title: stiff_springs::TITLE, run: studies::stiff_springs },
    Part { title: statements::TITLE, run: studies::statements },
];

impl Reproduction {
    /// All parts, in the order in which a reader wants them.
    #[must_use]
    pub fn parts() -> &'static [Part] {
        &PARTS
    }
}

impl Part {
    /// Computes the part on the threads of the current pool.
    ///
    /// # Errors
    /// [`ReproductionError`]: maps have no cells, a collision cannot be computed, boundaries cannot
    /// be traced, or a picture cannot be drawn.
    pub fn run(&self, reproduction: &Reproduction) -> Result<Section, ReproductionError> {
        if reproduction.cells == 0 {
            return Err(ReproductionError::NoCells);
        }
        (self.run)(reproduction)
    }
}
