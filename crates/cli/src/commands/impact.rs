//! The impact of two bodies, computed and printed.

mod table;

use stickslip_model::{ImpactReport, document};
use stickslip_studies::CollisionFailure;

use crate::args::Format;
use crate::error::Failure;
use crate::output::console::print;
use crate::output::json;
use crate::plan::ImpactPlan;

/// Computes the impact and prints it.
///
/// # Errors
/// The impact cannot be computed, or standard output cannot be written.
pub fn run(plan: &ImpactPlan) -> Result<(), Failure> {
    let ImpactPlan { encounter, engine, format } = plan;
    let contact = encounter.contact();
    let failed = |source| CollisionFailure::new(&contact, source);
    let (collision, statistics) = engine.collide(contact).map_err(failed)?;
    let impact = ImpactReport::new(encounter, collision);
    impact.require_finite().map_err(|error| failed(error.into()))?;
    let statistics = statistics.as_ref();
    print(|out| match format {
        Format::Json => json::write(out, document::IMPACT, &impact, engine, (None, statistics)),
        Format::Table => table::write(out, engine, &impact, statistics),
    })
}
