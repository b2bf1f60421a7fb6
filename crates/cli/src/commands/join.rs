//! A map made of its parts.

use super::map::{Parts, finish, require_all};
use crate::error::Failure;
use crate::output::file::{OutputFile, publish};
use crate::output::picture::PictureFile;
use crate::plan::JoinPlan;

/// Writes the map whose parts are in the files, with one tile in memory at a time.
///
/// # Errors
/// A part is missing, damaged or that of another map, a file cannot be written, or some points have
/// no result. In the last case the map is complete.
pub fn run(plan: &JoinPlan) -> Result<(), Failure> {
    plan.plot.as_ref().map(PictureFile::probe).transpose()?;
    let parts = Parts::open(&plan.parts)?;
    let file = OutputFile::create(&plan.out)?;
    let failures = parts.check()?;
    publish(finish(&parts, file, plan.format, plan.plot.as_ref())?)?;
    require_all(&failures, &parts, &plan.out)
}
