//! The study of convergence: how errors fall with the step and the tolerance, and what they cost.
//!
//! Start reading here; then, in this order: [`plain_time`] (the law as the paper writes it),
//! `measure` (the errors of one way to integrate), `series` (all ways, over steps and tolerances),
//! `collisions` (the errors of `collide`), `findings` (what that says) and `tables`.

use rayon::prelude::*;
use serde_json::json;
use stickslip_model::{Collision, CollisionFailure, Contact, GivenValue, InvalidValue};
use stickslip_plane::progress::{Progress, Report};

use crate::error::StudyError;
use crate::paper::{Reading, STIFFNESS};
use crate::study::Study;

mod collisions;
mod findings;
mod measure;
pub mod plain_time;
mod series;
mod tables;

pub use crate::limits::MOST_STIFFNESS;
pub use collisions::{Accuracy, PairAccuracy};
pub use measure::{
    Approximation, Deviation, Errors, Formulation, LocationSettings, Spread, integrate, measure,
    reference,
};
pub use series::{Control, ErrorRow, ErrorSeries, SeriesScheme, SwitchHandling, fitted};
pub use tables::{ORDERS, TIMES};

/// The name of the layout of the JSON, with its version.
pub const SCHEMA: &str = "stickslip.convergence/1";
/// The title of the study.
pub const TITLE: &str = "Convergence of the integrators";

/// The errors of the integrators.
#[derive(Clone, Debug)]
pub struct Convergence {
    /// The collisions as they should be.
    pub references: Vec<Collision>,
    /// The errors of all ways to integrate them.
    pub series: Vec<ErrorSeries>,
    /// The errors of the methods at their usual tolerances.
    pub accuracies: Vec<Accuracy>,
}

/// Makes the study on the threads of the current pool.
///
/// # Errors
/// [`StudyError`]: there is no collision, one is too stiff or has no reference to compare with, or
/// `collide` cannot compute it.
pub fn run(
    settings: &ConvergenceSettings,
    progress: Report<'_>,
) -> Result<Convergence, StudyError> {
    settings.validate()?;
    let references = settings.contacts.iter().map(|contact| {
        reference(*contact).map_err(|source| CollisionFailure::new(contact, source))
    });
    let references: Vec<_> = references.collect::<Result<_, _>>()?;
    let accuracies = references.iter().map(Accuracy::new).collect::<Result<_, _>>()?;
    let series = measure_all(&references, progress);
    Ok(Convergence { references, series, accuracies })
}

/// Measures every row of every series. Each depends on itself alone.
fn measure_all(references: &[Collision], progress: Report<'_>) -> Vec<ErrorSeries> {
    let schemes = SeriesScheme::all();
    let tasks: Vec<(SeriesScheme, f64)> = schemes
        .iter()
        .flat_map(|scheme| scheme.values(references).into_iter().map(|value| (*scheme, value)))
        .collect();
    progress(Progress::Begin { steps: tasks.len() });
    let measured = tasks.par_iter().map(|(scheme, value)| {
        let row = ErrorRow::measure(*scheme, *value, references);
        progress(Progress::Advance { steps: 1 });
        row
    });
    let mut rows = measured.collect::<Vec<_>>().into_iter();
    schemes
        .into_iter()
        .map(|scheme| {
            let count = scheme.values(references).len();
            ErrorSeries::new(scheme, rows.by_ref().take(count).collect())
        })
        .collect()
}

impl Convergence {
    /// The study: findings, numbers and tables.
    pub fn study(&self) -> Study {
        let json = json!({
            "schema": SCHEMA,
            "reference": self.reference(),
            "collisions": self.accuracies.iter().map(Accuracy::json).collect::<Vec<_>>(),
            "series": self.series.iter().map(ErrorSeries::json).collect::<Vec<_>>(),
        });
        Study {
            name: "convergence",
            title: TITLE,
            headlines: vec![self.result()],
            findings: self.findings(),
            json,
            tables: self.tables(),
        }
    }

    /// The solution that errors are measured against.
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

/// The collisions of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvergenceSettings {
    /// The collisions whose errors are measured; κ is at most [`MOST_STIFFNESS`].
    pub contacts: Vec<Contact>,
}

impl ConvergenceSettings {
    /// The usual study: collisions with two to eight switches without damping, κ = 18 and 63, ψ =
    /// 0.1, 0.2, … 1.9.
    ///
    /// # Errors
    /// [`InvalidValue`]: the damping is out of its range.
    pub fn usual(damping: f64) -> Result<Self, InvalidValue> {
        let points = Reading::kappas(STIFFNESS)
            .into_iter()
            .flat_map(|kappa| (1..20).map(move |tenths| (kappa, f64::from(tenths) / 10.0)));
        let contacts = points.map(|(kappa, psi)| Contact::new(kappa, psi, damping));
        Ok(Self { contacts: contacts.collect::<Result<_, _>>()? })
    }

    /// Checks all settings.
    ///
    /// # Errors
    /// [`StudyError::Settings`]: there is no collision, or one is too stiff; [`StudyError::Law`].
    pub fn validate(&self) -> Result<(), StudyError> {
        if self.contacts.is_empty() {
            let none = GivenValue::Phrase("0 collisions".into());
            return Err(InvalidValue::new("a study of", none, "at least one").into());
        }
        for contact in &self.contacts {
            contact.require_paper("the convergence")?;
        }
        for kappa in self.contacts.iter().map(Contact::kappa) {
            if kappa > MOST_STIFFNESS {
                let expected = format!("a number above 0, at most {MOST_STIFFNESS:?}");
                return Err(InvalidValue::new("kappa", kappa, expected).into());
            }
        }
        Ok(())
    }
}
