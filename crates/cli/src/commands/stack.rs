//! Atlases over the damping, or over a parameter of a system of one's own, and what changes between
//! them.

use std::error::Error;

use stickslip_figure::pictures;
use stickslip_files::output::file::{OutputFile, publish};
use stickslip_files::output::json;
use stickslip_files::output::picture::PictureFile;
use stickslip_plane::progress::InParallel;
use stickslip_plane::stack::{DampingStackError, StackDocument, stack};
use stickslip_tracer::{Stack, Watch};

use crate::error::Failure;
use crate::output::progress::Bar;
use crate::plan::{StackPlan, SystemStackPlan};
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

/// Traces the atlases of a system of one's own over a third parameter, isolates the changes
/// between them, and writes both.
///
/// # Errors
/// As of [`run`].
pub fn system(plan: &SystemStackPlan) -> Result<(), Failure> {
    let SystemStackPlan { plane, over: (third, name), values, options, out, plot, threads } = plan;
    plot.as_ref().map(PictureFile::probe).transpose()?;
    let pool = threads::pool(*threads)?;
    let file = OutputFile::create(out)?;
    let bar = Bar::steps();
    let report = |progress| bar.report(progress);
    let family = |value| plane.family.with(*third, value);
    let (window, watch) = (&plane.window, Watch::from(&report));
    let stacked = || Stack::watched(family, window, values, options, InParallel, watch);
    let made = pool.install(stacked);
    drop(bar);
    let made = made.map_err(|error| {
        let at = error.source().map_or_else(String::new, |source| format!(": {source}"));
        Failure::Family(format!("{error}{at}"))
    })?;
    let [x, y] = &plane.axes;
    let axes = [x.as_str(), y, name];
    let mut document = stickslip_tracer::StackDocument::new(&made, options, &plane.name, axes);
    document.guards = plane.family.rules().to_vec();
    let line = json::line(&document).map_err(|error| file.failure(error))?;
    let mut stored = vec![file.finish(&line)?];
    if let Some(plot) = plot {
        let picture = pictures::stack::draw_runs(&made, &plane.name, [x, y], name);
        stored.push(plot.write(Ok(picture))?);
    }
    publish(stored)?;
    match document.objection {
        Some(reason) => Err(Failure::Doubtful { path: out.clone(), reason }),
        None => Ok(()),
    }
}
