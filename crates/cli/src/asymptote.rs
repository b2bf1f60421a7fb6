//! A study of the limit of stiff springs: how ε_t tends to 0, and why as κ^{−5/4}.
//!
//! Start reading here; then, in this order: `points` (what is measured of full collisions),
//! `profile` (the inner problem beside them), `fit` (exponent and constant), `findings`, `tables`
//! and `pictures`.

mod findings;
mod fit;
mod pictures;
mod points;
mod profile;
mod tables;

use indicatif::ProgressBar;
use rayon::prelude::*;
use serde_json::{Map, Value, json};
use stickslip_model::inner::{self, Peak};
use stickslip_model::stiff::{self, BOUND_FACTOR, Excess};

use crate::error::Failure;
use crate::plan::AsymptotePlan;
use crate::schema;
use crate::study::{Cell, Study, Table};
use fit::Fits;
use points::{Lowest, Point, Restitution};
use profile::Profile;

/// Stiffnesses in a decade.
const A_DECADE: f64 = 4.0;

/// All that is measured.
struct Measurement {
    kappas: Vec<f64>,
    /// For each ψ, by κ.
    points: Vec<Vec<Point>>,
    /// For each range of ψ, by κ.
    restitutions: Vec<Vec<Restitution>>,
    profile: Profile,
    peak: Peak,
    excess: Excess,
    /// None with too few stiff collisions.
    fits: Option<Fits>,
}

/// Makes the study on the threads of the current pool.
///
/// # Errors
/// A collision cannot be computed.
pub fn run(plan: &AsymptotePlan, progress: &ProgressBar) -> Result<Study, Failure> {
    let kappas = stiffnesses(plan);
    progress.set_length((kappas.len() * (plan.psi.len() + Lowest::ALL.len())) as u64);
    let points = at_each(&kappas, &plan.psi, progress, Point::measure)?;
    let restitutions = at_each(&kappas, &Lowest::ALL, progress, Restitution::measure)?;
    let profile = Profile::measure(plan)?;
    let fits = Fits::new(&points);
    let (peak, excess) = (inner::peak(), stiff::excess()?);
    Ok(Measurement { kappas, points, restitutions, profile, peak, excess, fits }.study())
}

/// Stiffnesses evenly spread over the logarithm of the interval, with both its ends.
fn stiffnesses(plan: &AsymptotePlan) -> Vec<f64> {
    let (low, high) = (plan.kappa.low, plan.kappa.high);
    let steps = (A_DECADE * (high / low).log10()).ceil().max(1.0);
    let inside = (1..).map(f64::from).take_while(|step| *step < steps);
    let inside = inside.map(|step| low * (high / low).powf(step / steps));
    std::iter::once(low).chain(inside).chain([high]).collect()
}

/// Measures something for each of `values` at each stiffness; each depends on itself alone.
fn at_each<V: Copy + Sync, T: Send>(
    kappas: &[f64],
    values: &[V],
    progress: &ProgressBar,
    measure: impl Fn(f64, V) -> Result<T, Failure> + Sync,
) -> Result<Vec<Vec<T>>, Failure> {
    let by_kappa = |value: &V| {
        // The stiffest take longest, and so they come first.
        let measured = kappas.par_iter().rev().with_max_len(1).map(|kappa| {
            let measured = measure(*kappa, *value);
            progress.inc(1);
            measured
        });
        let mut measured: Vec<T> = measured.collect::<Result<_, _>>()?;
        measured.reverse();
        Ok(measured)
    };
    values.iter().map(by_kappa).collect()
}

impl Measurement {
    fn study(&self) -> Study {
        let (findings, tables) = (self.findings(), self.tables());
        let mut json = json!({
            "schema": schema::ASYMPTOTE,
            "inner_problem": {
                "largest": self.peak.velocity,
                "last_onset": self.peak.onset,
                "last_release": self.peak.release,
                "phase": self.profile.peak_phase,
                "correction": self.peak.correction,
            },
            "fits": self.fits.as_ref().map(Fits::json),
            "bound": {
                "factor": BOUND_FACTOR,
                "largest": self.excess.ratio,
                "kappa": self.excess.worst.kappa,
                "psi": self.excess.worst.psi,
                "exceeded": [self.excess.kappa.0, self.excess.kappa.1],
            },
        });
        for table in &tables {
            let name = table.name.trim_start_matches("asymptote_");
            json[name] = table.rows.iter().map(|row| object(table, row)).collect();
        }
        Study {
            name: "asymptote",
            title: "The limit of stiff springs",
            findings,
            json,
            tables,
            pictures: self.pictures(),
        }
    }
}

/// A row of a table with the names of its columns.
fn object(table: &Table, row: &[Cell]) -> Value {
    let cell = |cell: &Cell| match cell {
        Cell::Number(value) => json!(value),
        Cell::Count(count) => json!(count),
        Cell::Text(text) => json!(text),
    };
    let named = table.columns.iter().zip(row);
    named.map(|(column, value)| (column.name.to_owned(), cell(value))).collect::<Map<_, _>>().into()
}
