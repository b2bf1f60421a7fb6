//! A study of convergence: how errors fall with the step and the tolerance, and what they cost.
//!
//! Start reading here; then, in this order: `series` (what is measured), `collisions` (each
//! collision as `collide` computes it), `findings` (what that says), `tables` and `pictures`.

mod collisions;
mod findings;
mod pictures;
mod series;
mod tables;

use indicatif::ProgressBar;
use rayon::prelude::*;
use serde_json::json;
use stickslip_model::Collision;
use stickslip_model::convergence::{ReferenceError, reference};

use crate::error::Failure;
use crate::plan::ConvergePlan;
use crate::schema;
use crate::study::Study;
use collisions::Accuracy;
use series::{Row, Scheme, Series};
pub use tables::{ORDERS, TIMES};

/// All that is measured.
struct Measurement {
    /// The collisions as they should be.
    references: Vec<Collision>,
    /// Errors of all ways to integrate them.
    series: Vec<Series>,
    /// Errors of the methods as they are used.
    accuracies: Vec<Accuracy>,
}

/// Makes the study on the threads of the current pool.
///
/// # Errors
/// A collision has no reference to compare with, or `collide` cannot compute it.
pub fn run(plan: &ConvergePlan, progress: &ProgressBar) -> Result<Study, Failure> {
    let references = plan.contacts.iter().map(|contact| {
        reference(*contact).map_err(|error| {
            let source = match error {
                ReferenceError::Exact(error) => error.into(),
                ReferenceError::Collision(error) => error.into(),
            };
            Failure::computation(contact, source)
        })
    });
    let references: Vec<_> = references.collect::<Result<_, _>>()?;
    let accuracies = references.iter().map(Accuracy::new).collect::<Result<_, _>>()?;
    let series = measure(&references, progress);
    Ok(Measurement { references, series, accuracies }.study())
}

/// Measures every row of every series; each depends on itself alone.
fn measure(references: &[Collision], progress: &ProgressBar) -> Vec<Series> {
    let schemes = Scheme::all();
    let tasks: Vec<(Scheme, f64)> = schemes
        .iter()
        .flat_map(|scheme| scheme.values(references).into_iter().map(|value| (*scheme, value)))
        .collect();
    progress.set_length(tasks.len() as u64);
    let measured = tasks.par_iter().map(|(scheme, value)| {
        let row = Row::measure(*scheme, *value, references);
        progress.inc(1);
        row
    });
    let mut rows = measured.collect::<Vec<_>>().into_iter();
    schemes
        .into_iter()
        .map(|scheme| {
            let count = scheme.values(references).len();
            Series::new(scheme, rows.by_ref().take(count).collect())
        })
        .collect()
}

impl Measurement {
    fn study(&self) -> Study {
        let json = json!({
            "schema": schema::CONVERGENCE,
            "reference": self.reference(),
            "collisions": self.accuracies.iter().map(Accuracy::json).collect::<Vec<_>>(),
            "series": self.series.iter().map(Series::json).collect::<Vec<_>>(),
        });
        Study {
            name: "convergence",
            title: "Convergence of the integrators",
            findings: self.findings(),
            json,
            tables: self.tables(),
            pictures: self.pictures(),
        }
    }

    /// What errors are measured against.
    fn reference(&self) -> &'static str {
        if self.is_damped() {
            "dop853 in regularised coordinates at a tolerance of 1e-15"
        } else {
            "the exact solution"
        }
    }

    fn is_damped(&self) -> bool {
        self.references.iter().any(|collision| collision.contact.damping() > 0.0)
    }
}
