//! An atlas, traced, verified and written.

use serde::Serialize;
use stickslip_figure::pictures;
use stickslip_files::output::file::{OutputFile, StoredFile, publish};
use stickslip_files::output::json;
use stickslip_files::output::picture::PictureFile;
use stickslip_plane::atlas::{self, Document, geojson};
use stickslip_plane::gaining;
use stickslip_plane::progress::InParallel;
use stickslip_tracer::{Surveyor, Watch};

use crate::error::Failure;
use crate::output::progress::Bar;
use crate::plan::{SystemTracePlan, TracePlan};
use crate::threads;

/// Traces the boundaries of the window and writes its atlas.
///
/// # Errors
/// A run fails, files cannot be written, or something speaks against the atlas or the lines on
/// which |ε_t| is 1. In the last case the files are complete and say so.
pub fn run(plan: &TracePlan) -> Result<(), Failure> {
    plan.plot.as_ref().map(PictureFile::probe).transpose()?;
    let pool = threads::pool(plan.threads)?;
    let file = OutputFile::create(&plan.out)?;
    let geography = plan.geojson.as_deref().map(OutputFile::create).transpose()?;
    let lines = plan.gaining.as_deref().map(OutputFile::create).transpose()?;

    let bar = Bar::steps();
    let report = |progress| bar.report(progress);
    let verified = pool.install(|| atlas::trace(plan.frame, plan.tolerance, &report));
    let gained = lines.as_ref().map(|_| {
        let traced = || gaining::trace(plan.frame, plan.tolerance, &report);
        pool.install(traced)
    });
    drop(bar);
    let (verified, gained) = (verified?, gained.transpose()?);
    let mut stored = vec![write_json(file, &Document::new(&verified))?];
    if let Some(file) = geography {
        stored.push(write_json(file, &geojson(&verified))?);
    }
    if let (Some(file), Some(gained)) = (lines, &gained) {
        stored.push(write_json(file, &gaining::Document::from(gained))?);
    }
    if let Some(plot) = &plan.plot {
        stored.push(plot.write(Ok(pictures::atlas::draw(&verified.atlas)))?);
    }
    publish(stored)?;
    if let Some(reason) = verified.report.objection() {
        return Err(Failure::Doubtful { path: plan.out.clone(), reason });
    }
    match (&plan.gaining, gained.and_then(|gained| gained.objection())) {
        (Some(path), Some(reason)) => Err(Failure::Doubtful { path: path.clone(), reason }),
        _ => Ok(()),
    }
}

/// Traces the boundaries of a system of one's own, and writes its atlas.
///
/// # Errors
/// A run fails, files cannot be written, or something speaks against the atlas. In the last case
/// the files are complete and say so.
pub fn system(plan: &SystemTracePlan) -> Result<(), Failure> {
    let SystemTracePlan { plane, options, out, plot, threads } = plan;
    plot.as_ref().map(PictureFile::probe).transpose()?;
    let pool = threads::pool(*threads)?;
    let file = OutputFile::create(out)?;
    let bar = Bar::steps();
    let report = |progress| bar.report(progress);
    let (options, executor, watch) = (*options, InParallel, Watch::from(&report));
    let surveyor = Surveyor { options, executor, watch };
    let atlas = pool.install(|| surveyor.atlas(&plane.family, &plane.window));
    drop(bar);
    let atlas = atlas.map_err(|error| Failure::Family(error.to_string()))?;
    let [x, y] = &plane.axes;
    let mut document = stickslip_tracer::Document::new(&atlas, &options, &plane.name, [x, y]);
    document.guards = plane.family.rules().to_vec();
    let mut stored = vec![write_json(file, &document)?];
    if let Some(plot) = plot {
        stored.push(plot.write(Ok(pictures::family::draw_runs(&atlas, &plane.name, [x, y])))?);
    }
    publish(stored)?;
    match atlas.objection() {
        Some(reason) => Err(Failure::Doubtful { path: out.clone(), reason }),
        None => Ok(()),
    }
}

/// Writes `content` on one line, completely except for the name of the file.
fn write_json(file: OutputFile, content: &impl Serialize) -> Result<StoredFile, Failure> {
    let line = json::line(content).map_err(|error| file.failure(error))?;
    Ok(file.finish(&line)?)
}
