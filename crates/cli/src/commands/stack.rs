//! Atlases over the damping, and what changes between them.

use stickslip_figure::pictures;
use stickslip_files::output::file::{OutputFile, publish};
use stickslip_files::output::json;
use stickslip_files::output::picture::PictureFile;
use stickslip_plane::stack::{DampingStackError, StackDocument, stack};

use crate::error::Failure;
use crate::output::progress::Bar;
use crate::plan::StackPlan;
use crate::threads;

/// Traces the atlases, isolates the changes between them, and writes both.
///
/// # Errors
/// A run fails, files cannot be written, or something speaks against the stack. In the last case
/// the stack is complete and says so.
pub fn run(plan: &StackPlan) -> Result<(), Failure> {
    plan.plot.as_ref().map(PictureFile::probe).transpose()?;
    let pool = threads::pool(plan.threads)?;
    let file = OutputFile::create(&plan.out)?;
    let bar = Bar::steps();
    let report = |progress| bar.report(progress);
    let made = pool.install(|| stack(plan.frame, &plan.dampings, plan.tolerance, &report));
    drop(bar);
    let made = made.map_err(|error| match error {
        DampingStackError::Dampings { .. } => Failure::Usage(format!("--damping: {error}")),
        DampingStackError::Atlas { source, .. } => source.into(),
    })?;
    let line = json::line(&StackDocument::from(&made)).map_err(|error| file.failure(error))?;
    let mut stored = vec![file.finish(&line)?];
    if let Some(plot) = &plan.plot {
        stored.push(plot.write(Ok(pictures::stack::draw(&made)))?);
    }
    publish(stored)?;
    match made.objection() {
        Some(reason) => Err(Failure::Doubtful { path: plan.out.clone(), reason }),
        None => Ok(()),
    }
}
