//! The figures of the paper computed anew, and all parts of the reproduction.
//!
//! Start reading in [`Part`]; then, in this order: [`ReportSection`] (the result of a part),
//! [`Reproduction`] (what parts share), `figure1` to `figure6` and `boundaries` (the parts),
//! `points` (where the points a to o of Figure 4 are), `stiffness_map`, [`Sweep`] and
//! `course` (what several figures need).

pub mod boundaries;
mod course;
mod figure1;
pub mod figure2;
mod figure3;
mod figure4;
mod figure5;
mod figure6;
mod points;
mod reproduction;
mod section;
mod stiffness_map;
mod sweep;

pub use reproduction::Reproduction;
pub use section::{Content, DataFile, ReportSection, headlines};
pub use sweep::Sweep;

use stickslip_figure::pictures::studies as pictures;
use stickslip_plane::progress::SILENT;
use stickslip_studies::{convergence, stiff_springs};

use crate::error::ReproductionError;
use crate::statements;

/// A part of the reproduction.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// The title of the part.
    pub title: &'static str,
    run: fn(&Reproduction) -> Result<ReportSection, ReproductionError>,
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
    ///
    /// # Errors
    /// [`ReproductionError`]: maps have no cells, a collision cannot be computed, boundaries cannot
    /// be traced, or a picture cannot be drawn.
    pub fn run(&self, reproduction: &Reproduction) -> Result<ReportSection, ReproductionError> {
        if reproduction.cells == 0 {
            return Err(ReproductionError::NoCells);
        }
        (self.run)(reproduction)
    }
}

/// The study of convergence, without the times, which differ from run to run.
fn convergence(_: &Reproduction) -> Result<ReportSection, ReproductionError> {
    let measured = convergence::run(&convergence::ConvergenceSettings::usual(0.0)?, SILENT)?;
    let mut study = measured.study();
    study.tables.retain(|table| table.name != convergence::TIMES);
    let section = ReportSection::new(study, pictures::convergence::draw(&measured));
    Ok(ReportSection { shown: vec![convergence::ORDERS], ..section })
}

/// The study of stiff springs.
fn stiff_springs(_: &Reproduction) -> Result<ReportSection, ReproductionError> {
    let measured = stiff_springs::run(&stiff_springs::StiffSpringSettings::default(), SILENT)?;
    Ok(ReportSection::new(measured.study(), pictures::stiff_springs::draw(&measured)))
}

/// The statements of the paper, each with its verdict.
fn statements(reproduction: &Reproduction) -> Result<ReportSection, ReproductionError> {
    let numbers: Vec<u8> = (1..=statements::COUNT).collect();
    let audit = statements::run(reproduction.spring, &numbers, SILENT)?;
    let study = audit.study();
    let shown = study.tables.iter().map(|table| table.name).collect();
    Ok(ReportSection { shown, audit: Some(audit), ..ReportSection::new(study, Vec::new()) })
}
