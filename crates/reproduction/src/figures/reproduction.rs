//! What the parts of the reproduction share.

use std::sync::{Arc, OnceLock};

use stickslip_figure::pictures::studies as pictures;
use stickslip_plane::Range;
use stickslip_plane::atlas::{AtlasError, CollisionAtlas, Frame, trace};
use stickslip_plane::progress::SILENT;
use stickslip_studies::paper::{MOST_RATIO_4, MOST_STIFFNESS, Reading, psi};
use stickslip_studies::{convergence, stiff_springs};

use super::section::Section;
use super::{boundaries, figure1, figure2, figure3, figure4, figure5, figure6};
use crate::error::ReproductionError;
use crate::statements;
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
    Part { title: convergence::TITLE, run: convergence },
    Part { title: stiff_springs::TITLE, run: stiff_springs },
    Part { title: statements::TITLE, run: statements },
];

impl Reproduction {
    /// All parts, in the order in which a reader wants them.
    pub fn parts() -> &'static [Part] {
        &PARTS
    }
}

impl Part {
    /// Computes the part on the threads of the current pool.
    pub fn run(&self, reproduction: &Reproduction) -> Result<Section, ReproductionError> {
        if reproduction.cells == 0 {
            return Err(ReproductionError::NoCells);
        }
        (self.run)(reproduction)
    }
}

/// The study of convergence, without the times, which differ from run to run.
pub fn convergence(_: &Reproduction) -> Result<Section, ReproductionError> {
    let measured = convergence::run(&convergence::ConvergenceSettings::usual(0.0)?, SILENT)?;
    let mut study = measured.study();
    study.tables.retain(|table| table.name != convergence::TIMES);
    let section = Section::new(study, pictures::convergence::draw(&measured));
    Ok(Section { shown: vec![convergence::ORDERS], ..section })
}

/// The study of stiff springs.
pub fn stiff_springs(_: &Reproduction) -> Result<Section, ReproductionError> {
    let measured = stiff_springs::run(&stiff_springs::StiffSpringSettings::default(), SILENT)?;
    Ok(Section::new(measured.study(), pictures::stiff_springs::draw(&measured)))
}

/// The statements of the paper, each with its verdict.
pub fn statements(reproduction: &Reproduction) -> Result<Section, ReproductionError> {
    let numbers: Vec<u8> = (1..=statements::COUNT).collect();
    let audit = statements::run(reproduction.spring, &numbers, SILENT)?;
    let study = audit.study();
    let shown = study.tables.iter().map(|table| table.name).collect();
    Ok(Section { shown, audit: Some(audit), ..Section::new(study, Vec::new()) })
}
