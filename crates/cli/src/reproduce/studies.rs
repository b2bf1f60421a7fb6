//! Studies that are commands of their own, as parts of the report.

use indicatif::ProgressBar;

use super::bench::Bench;
use super::section::Section;
use crate::error::Failure;
use crate::plan::{AsymptotePlan, ConvergePlan};
use crate::{asymptote, audit, converge};

/// Title of [`convergence`].
pub const CONVERGENCE: &str = "Convergence of the integrators";
/// Title of [`stiff`].
pub const STIFF: &str = "The limit of stiff springs";
/// Title of [`statements`].
pub const STATEMENTS: &str = "Statements of the paper";

/// The study of convergence, without what differs from run to run.
pub fn convergence(bench: &Bench) -> Result<Section, Failure> {
    let plan = ConvergePlan::usual(&bench.out)?;
    let mut study = bench.pool.install(|| converge::run(&plan, &ProgressBar::hidden()))?;
    study.tables.retain(|table| table.name != converge::TIMES);
    Ok(Section { shown: vec![converge::ORDERS], ..study.into() })
}

/// The study of stiff springs.
pub fn stiff(bench: &Bench) -> Result<Section, Failure> {
    let plan = AsymptotePlan::usual(&bench.out);
    let study = bench.pool.install(|| asymptote::run(&plan, &ProgressBar::hidden()))?;
    Ok(study.into())
}

/// The statements of the paper, each with its verdict.
pub fn statements(bench: &Bench) -> Result<Section, Failure> {
    let numbers: Vec<u8> = (1..=audit::COUNT).collect();
    let test = || audit::run(bench.model, &numbers, &ProgressBar::hidden());
    let study = bench.pool.install(test)?.study();
    let shown = study.tables.iter().map(|table| table.name).collect();
    Ok(Section { shown, ..study.into() })
}
