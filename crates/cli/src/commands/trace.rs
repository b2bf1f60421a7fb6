//! An atlas traced, verified and written.

use std::io::Write;

use serde::Serialize;
use stickslip_figure::pictures;
use stickslip_plane::atlas::{self, Document, geojson};

use crate::error::Failure;
use crate::output::file::{OutputFile, StoredFile, publish};
use crate::output::picture::PictureFile;
use crate::output::progress::{Bar, threads};
use crate::plan::TracePlan;

/// Traces the boundaries of the window and writes its atlas.
///
/// # Errors
/// A run fails, files cannot be written, or something speaks against the atlas; in the last case it
/// is complete and says so.
pub fn run(plan: &TracePlan) -> Result<(), Failure> {
    plan.plot.as_ref().map(PictureFile::probe).transpose()?;
    let pool = threads(plan.threads)?;
    let file = OutputFile::create(&plan.out)?;
    let geography = plan.geojson.as_deref().map(OutputFile::create).transpose()?;

    let bar = Bar::steps();
    let report = |progress| bar.report(progress);
    let verified = pool.install(|| atlas::trace(plan.frame, plan.tolerance, &report));
    bar.finish();
    let verified = verified?;
    let mut stored = vec![write_json(file, &Document::new(&verified))?];
    if let Some(file) = geography {
        stored.push(write_json(file, &geojson(&verified))?);
    }
    if let Some(plot) = &plan.plot {
        stored.push(plot.write(Ok(pictures::atlas::draw(&verified.atlas)))?);
    }
    publish(stored)?;
    match verified.report.objection() {
        Some(reason) => Err(Failure::Doubtful { path: plan.out.clone(), reason }),
        None => Ok(()),
    }
}

/// Writes `content` in one line.
fn write_json(mut file: OutputFile, content: &impl Serialize) -> Result<StoredFile, Failure> {
    let bytes = serde_json::to_vec(content).map_err(|error| file.failure(error))?;
    file.write_all(&bytes).and_then(|()| file.write_all(b"\n")).map_err(|e| file.failure(e))?;
    file.store()
}
