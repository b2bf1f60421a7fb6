//! The impact of two bodies, computed and printed.

pub mod batch;
mod table;

use stickslip_files::output::file::publish;
use stickslip_files::output::json;
use stickslip_model::{ImpactReport, document};
use stickslip_studies::CollisionFailure;

use super::course;
use crate::args::Format;
use crate::error::Failure;
use crate::output::console::print;
use crate::plan::SingleImpact;

/// Computes the impact, writes its course if that is wanted, and prints it.
///
/// # Errors
/// The impact cannot be computed, or the course or standard output cannot be written.
pub fn run(plan: &SingleImpact) -> Result<(), Failure> {
    let SingleImpact { encounter, engine, format, course } = plan;
    let contact = encounter.contact();
    let failed = |source| CollisionFailure::new(&contact, source);
    course.as_ref().map_or(Ok(()), course::probe)?;
    let (collision, statistics, history) = if course.is_some() {
        let (collision, statistics, history) = engine.followed(contact).map_err(failed)?;
        (collision, statistics, Some(history))
    } else {
        let (collision, statistics) = engine.collide(contact).map_err(failed)?;
        (collision, statistics, None)
    };
    let impact = ImpactReport::new(encounter, collision);
    impact.require_finite().map_err(|error| failed(error.into()))?;
    if let (Some(course), Some(history)) = (course, &history) {
        publish([course::in_si(course, encounter, (&impact.collision, history))?])?;
    }
    let statistics = statistics.as_ref();
    print(|out| match format {
        Format::Json => json::write(out, document::IMPACT, &impact, engine, (None, statistics)),
        Format::Table => table::write(out, engine, &impact, statistics),
    })
}
