//! A study, computed, written into a directory, and summarised on standard output.

use stickslip_files::output::directory::prepare;
use stickslip_files::output::study::write_study;
use stickslip_plane::progress::Report;
use stickslip_studies::{Study, StudyError};

use crate::error::Failure;
use crate::output::console::print;
use crate::output::progress::Bar;
use crate::plan::StudyPlan;
use crate::threads;

/// Makes a study of the settings of `plan`, writes its files and prints its findings.
///
/// # Errors
/// Files cannot be written, which is tried first, or `make` fails.
pub fn run<S: Sync>(
    plan: &StudyPlan<S>,
    make: impl FnOnce(&S, Report<'_>) -> Result<Study, StudyError> + Send,
) -> Result<(), Failure> {
    prepare(&plan.out)?;
    let pool = threads::pool(plan.threads)?;
    let bar = Bar::steps();
    let study = pool.install(|| make(&plan.settings, &|progress| bar.report(progress)));
    drop(bar);
    let study = study?;
    write_study(&study, &plan.out)?;
    print(|out| study.findings.iter().try_for_each(|line| writeln!(out, "{line}")))
}
