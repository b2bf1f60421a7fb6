//! A file of impacts.

use stickslip_files::input::rows::Input;
use stickslip_files::output::csv::Rows;
use stickslip_files::output::impact_rows::{self, EVENTS};
use stickslip_model::{Encounter, ImpactReport};

use crate::commands::batch::{self, Work};
use crate::error::Failure;
use crate::plan::{Engines, ImpactBatch};

/// Computes every row of the input.
///
/// # Errors
/// The input cannot be used, an output cannot be written, or some rows have no result. In the last
/// case the outputs are complete.
pub fn run(plan: ImpactBatch) -> Result<(), Failure> {
    let ImpactBatch { files, bodies, velocities, engines } = plan;
    let work = Impacts { engines, names: impact_rows::names(bodies.spheres()) };
    let columns = |header: &_| bodies.with_columns(header, velocities, &work.names);
    let input = Input::open(&files.input, columns)?;
    batch::run(&files, input, &work)
}

/// Impacts in SI units.
struct Impacts {
    engines: Engines,
    /// The columns of results.
    names: Vec<&'static str>,
}

impl Work for Impacts {
    type Case = Encounter;

    fn results(&self) -> &[&'static str] {
        &self.names
    }

    fn events(&self) -> &'static [&'static str] {
        &EVENTS
    }

    fn switches(&self, encounter: &Encounter) -> f64 {
        // Without damping their number grows as √κ t_c/π.
        encounter.contact().kappa().sqrt()
    }

    fn write(
        &self,
        encounter: &Encounter,
        results: &mut Rows,
        wanted: Option<(&mut Rows, u64)>,
    ) -> Result<bool, String> {
        let engine = self.engines.of(encounter).map_err(|failure| failure.to_string())?;
        let (collision, _) =
            engine.collide(encounter.contact()).map_err(|error| error.to_string())?;
        let impact = ImpactReport::new(encounter, collision);
        impact.require_finite().map_err(|error| error.to_string())?;
        impact_rows::write(results, &impact, "ok");
        if let Some((events, number)) = wanted {
            impact_rows::write_switches(events, number, &impact.outcome.switches);
        }
        Ok(true)
    }
}
