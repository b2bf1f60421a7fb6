//! A file of collisions.

use stickslip_files::input::rows::{Columns, Input};
use stickslip_files::output::csv::Rows;
use stickslip_files::output::rows::{self, ESTIMATES, EVENTS, RESULTS};
use stickslip_model::{Contact, Engine};

use crate::commands::batch::{self, Work};
use crate::error::Failure;
use crate::plan::BatchPlan;

/// Computes every row of the input.
///
/// # Errors
/// The input cannot be used, an output cannot be written, or some rows have no result. In the last
/// case the outputs are complete.
pub fn run(plan: &BatchPlan) -> Result<(), Failure> {
    let work = Collisions { engine: plan.engine, estimate: plan.estimate };
    let columns = Columns::of_collisions(work.names());
    let input = Input::open(&plan.files.input, |header| columns.recipe(header, &plan.given))?;
    batch::run(&plan.files, input, &work)
}

/// Collisions in scaled parameters.
struct Collisions {
    engine: Engine,
    /// Whether errors are estimated.
    estimate: bool,
}

/// The columns of results with estimates.
const ESTIMATED: [&str; RESULTS.len() + ESTIMATES.len()] = {
    let mut names = [""; RESULTS.len() + ESTIMATES.len()];
    names.split_at_mut(RESULTS.len()).0.copy_from_slice(&RESULTS);
    names.split_at_mut(RESULTS.len()).1.copy_from_slice(&ESTIMATES);
    names
};

impl Collisions {
    fn names(&self) -> &'static [&'static str] {
        if self.estimate { &ESTIMATED } else { &RESULTS }
    }
}

impl Work for Collisions {
    type Case = Contact;

    fn results(&self) -> &[&'static str] {
        self.names()
    }

    fn events(&self) -> &'static [&'static str] {
        &EVENTS
    }

    fn switches(&self, contact: &Contact) -> f64 {
        // Without damping their number grows as √κ t_c/π.
        contact.kappa().sqrt()
    }

    fn write(
        &self,
        contact: &Contact,
        results: &mut Rows,
        wanted: Option<(&mut Rows, u64)>,
    ) -> Result<bool, String> {
        let (collision, _) = self.engine.collide(*contact).map_err(|error| error.to_string())?;
        let estimate = self.estimate.then(|| self.engine.estimate(&collision));
        let complete = !matches!(estimate, Some(Err(_)));
        match estimate {
            None => rows::write_collision(results, &collision, "ok"),
            Some(Ok(estimate)) => {
                rows::write_collision(results, &collision, "ok");
                rows::write_estimate(results, &estimate);
            }
            Some(Err(error)) => {
                let status = format!("no estimate: {error}");
                rows::write_collision(results, &collision, &status);
                results.fields([""; ESTIMATES.len()]);
            }
        }
        if let Some((events, number)) = wanted {
            rows::write_switches(events, number, &collision);
        }
        Ok(complete)
    }
}
