//! A map made of its parts.

use stickslip_files::map::{Parts, Stored};
use stickslip_files::output::file::{OutputFile, publish};
use stickslip_files::output::picture::PictureFile;

use super::map::{finish, require_all};
use crate::error::Failure;
use crate::output::progress::Bar;
use crate::plan::JoinPlan;
use crate::version;

/// Writes the map whose parts are in the files, with one tile in memory at a time.
///
/// # Errors
/// A part is missing, damaged or that of another map, a file cannot be written, or some points have
/// no result. In the last case the map is complete.
pub fn run(plan: &JoinPlan) -> Result<(), Failure> {
    plan.plot.as_ref().map(PictureFile::probe).transpose()?;
    let parts = Parts::open(&plan.parts, &version::program())?;
    let file = OutputFile::create(&plan.out)?;
    let bar = Bar::points(parts.task().points());
    let failures = parts.check(|points| bar.advance(points))?;
    drop(bar);
    publish(finish(&parts, file, plan.format, plan.plot.as_ref())?)?;
    require_all(&failures, &parts, &plan.out)
}
