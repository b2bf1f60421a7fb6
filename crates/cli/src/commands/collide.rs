//! One collision, computed, printed and drawn.

use stickslip_figure::pictures;
use stickslip_model::document;
use stickslip_studies::CollisionFailure;

use crate::args::Format;
use crate::error::Failure;
use crate::output::console::print;
use crate::output::file::publish;
use crate::output::{json, text};
use crate::plan::SinglePlan;

/// Computes the collision, draws it if that is wanted, and prints it.
///
/// # Errors
/// The collision cannot be computed, or the picture or standard output cannot be written.
pub fn run(plan: &SinglePlan) -> Result<(), Failure> {
    let SinglePlan { contact, engine, format, plot, estimate } = plan;
    let failed = |source| CollisionFailure::new(contact, source);
    if let Some(plot) = plot {
        plot.probe()?;
    }
    let (collision, statistics, history) = if plot.is_some() {
        let (collision, statistics, history) = engine.followed(*contact).map_err(failed)?;
        (collision, statistics, Some(history))
    } else {
        let (collision, statistics) = engine.collide(*contact).map_err(failed)?;
        (collision, statistics, None)
    };
    collision.energy.require_finite().map_err(|error| failed(error.into()))?;
    let estimate = estimate.then(|| engine.estimate(&collision)).transpose().map_err(failed)?;
    if let (Some(plot), Some(history)) = (plot, &history) {
        publish([plot.write(Ok(pictures::collision::draw(&collision, history)))?])?;
    }
    let estimates = (estimate.as_ref(), statistics.as_ref());
    print(|out| match format {
        Format::Json => json::write(out, document::COLLISION, &collision, engine, estimates),
        Format::Table => text::write(out, engine, &collision, estimates),
    })
}
