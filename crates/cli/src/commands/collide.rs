//! One collision, computed, printed and drawn.

pub mod batch;

use stickslip_figure::pictures;
use stickslip_files::output::file::publish;
use stickslip_files::output::json;
use stickslip_files::output::picture::PictureFile;
use stickslip_model::document;
use stickslip_studies::CollisionFailure;

use super::course;
use crate::args::Format;
use crate::error::Failure;
use crate::output::console::print;
use crate::output::text;
use crate::plan::SinglePlan;

/// Computes the collision, draws it and writes its course if that is wanted, and prints it.
///
/// # Errors
/// The collision cannot be computed, or a file or standard output cannot be written.
pub fn run(plan: &SinglePlan) -> Result<(), Failure> {
    let SinglePlan { contact, engine, format, plot, course, estimate } = plan;
    let failed = |source| CollisionFailure::new(contact, source);
    plot.as_ref().map_or(Ok(()), PictureFile::probe)?;
    course.as_ref().map_or(Ok(()), course::probe)?;
    let (collision, statistics, history) = if plot.is_some() || course.is_some() {
        let (collision, statistics, history) = engine.followed(*contact).map_err(failed)?;
        (collision, statistics, Some(history))
    } else {
        let (collision, statistics) = engine.collide(*contact).map_err(failed)?;
        (collision, statistics, None)
    };
    collision.energy.require_finite().map_err(|error| failed(error.into()))?;
    let estimate = estimate.then(|| engine.estimate(&collision)).transpose().map_err(failed)?;
    if let Some(history) = &history {
        let draw =
            |plot: &PictureFile| plot.write(Ok(pictures::collision::draw(&collision, history)));
        let picture = plot.as_ref().map(draw).transpose()?;
        let follow = |plan| course::scaled(plan, &collision, history);
        let course = course.as_ref().map(follow).transpose()?;
        publish(picture.into_iter().chain(course))?;
    }
    let estimates = (estimate.as_ref(), statistics.as_ref());
    print(|out| match format {
        Format::Json => json::write(out, document::COLLISION, &collision, engine, estimates),
        Format::Table => text::write(out, engine, &collision, estimates),
    })
}
