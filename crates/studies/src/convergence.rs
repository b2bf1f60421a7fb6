//! A study of convergence: how errors fall with the step and the tolerance, and what they cost.
//!
//! Start reading here; then, in this order: [`plain_time`] (the law as the paper writes it), `measure`
//! (errors of a way to integrate), `series` (what is measured), `collisions` (each
//! collision as `collide` computes it), `findings` (what that says), `tables` and `pictures`.

mod collisions;
mod findings;
mod measure;
mod pictures;
pub mod plain_time;
mod series;
mod tables;

use rayon::prelude::*;
use serde_json::json;
use stickslip_model::{Collision, Contact, InvalidParameter};
use stickslip_plane::progress::{Progress, Report};

use crate::error::CollisionFailure;
use crate::error::StudyError;
use crate::study::Study;
use collisions::Accuracy;
use series::{Row, Scheme, Series};

pub use measure::{
    Approximation, Coordinates, Errors, ReferenceError, Spread, Switching, integrate, measure,
    reference,
};
pub use tables::{ORDERS, TIMES};

/// The name of the layout of the JSON, with its version.
pub const SCHEMA: &str = "stickslip.convergence/1";

/// The largest stiffness of a study, which takes seconds at it; work grows as √κ.
pub const MOST_STIFFNESS: f64 = 1e6;

/// What is studied.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The collisions whose errors are measured; κ is at most [`MOST_STIFFNESS`].
    pub contacts: Vec<Contact>,
}

/// A collision is too stiff for a study.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("kappa = {kappa:?} is out of range; expected a number above 0, at most {MOST_STIFFNESS:?}")]
pub struct InvalidConvergence {
    /// The stiffness of the collision.
    pub kappa: f64,
}

impl Settings {
    /// The usual study: collisions with two to eight switches without damping, κ = 18 and 63, ψ =
    /// 0.1, 0.2, … 1.9.
    ///
    /// # Errors
    /// [`InvalidParameter`]: the damping is out of its range.
    pub fn usual(damping: f64) -> Result<Self, InvalidParameter> {
        let points = [18.0, 63.0]
            .into_iter()
            .flat_map(|kappa| (1..20).map(move |tenths| (kappa, f64::from(tenths) / 10.0)));
        let contacts = points.map(|(kappa, psi)| Contact::new(kappa, psi, damping));
        Ok(Self { contacts: contacts.collect::<Result<_, _>>()? })
    }

    fn validate(&self) -> Result<(), InvalidConvergence> {
        match self.contacts.iter().find(|contact| contact.kappa() > MOST_STIFFNESS) {
            Some(stiff) => Err(InvalidConvergence { kappa: stiff.kappa() }),
            None => Ok(()),
        }
    }
}

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
/// [`StudyError`]: a collision is too stiff, has no reference to compare with, or `collide` cannot
/// compute it.
pub fn run(settings: &Settings, progress: Report<'_>) -> Result<Study, StudyError> {
    settings.validate()?;
    let references = settings.contacts.iter().map(|contact| {
        reference(*contact).map_err(|error| match error {
            ReferenceError::Exact(error) => CollisionFailure::new(contact, error),
            ReferenceError::Collision(error) => CollisionFailure::new(contact, error),
        })
    });
    let references: Vec<_> = references.collect::<Result<_, _>>()?;
    let accuracies = references.iter().map(Accuracy::new).collect::<Result<_, _>>()?;
    let series = measure_all(&references, progress);
    Ok(Measurement { references, series, accuracies }.study())
}

/// Measures every row of every series; each depends on itself alone.
fn measure_all(references: &[Collision], progress: Report<'_>) -> Vec<Series> {
    let schemes = Scheme::all();
    let tasks: Vec<(Scheme, f64)> = schemes
        .iter()
        .flat_map(|scheme| scheme.values(references).into_iter().map(|value| (*scheme, value)))
        .collect();
    progress(Progress::Begin { steps: tasks.len() });
    let measured = tasks.par_iter().map(|(scheme, value)| {
        let row = Row::measure(*scheme, *value, references);
        progress(Progress::Advance { steps: 1 });
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
            "schema": SCHEMA,
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
