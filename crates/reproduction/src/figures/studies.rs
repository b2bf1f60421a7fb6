//! The studies as parts of the reproduction.

use stickslip_figure::pictures::studies as pictures;
use stickslip_plane::progress::SILENT;
use stickslip_studies::{convergence, stiff_springs};

use super::reproduction::Reproduction;
use super::section::Section;
use crate::error::ReproductionError;
use crate::statements;

/// The study of convergence, without the times, which differ from run to run.
pub fn convergence(_: &Reproduction) -> Result<Section, ReproductionError> {
    let measured = convergence::run(&convergence::Settings::usual(0.0)?, SILENT)?;
    let mut study = measured.study();
    study.tables.retain(|table| table.name != convergence::TIMES);
    let section = Section::new(study, pictures::convergence::draw(&measured));
    Ok(Section { shown: vec![convergence::ORDERS], ..section })
}

/// The study of stiff springs.
pub fn stiff_springs(_: &Reproduction) -> Result<Section, ReproductionError> {
    let measured = stiff_springs::run(&stiff_springs::Settings::default(), SILENT)?;
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
