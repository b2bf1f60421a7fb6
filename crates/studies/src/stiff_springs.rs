//! A study of the limit of stiff springs: how ε_t tends to 0, and why as κ^{−5/4}.
//!
//! Start reading here; then, in this order: [`limit`] (maxima of full collisions), `points` (what is measured of full collisions),
//! `profile` (the inner problem beside them), `fit` (exponent and constant), `findings`, `tables`
//! and `pictures`.

mod findings;
mod fit;
pub mod limit;
mod pictures;
mod points;
mod profile;
mod tables;

use rayon::prelude::*;
use serde_json::json;
use stickslip_model::inner::{self, Peak};
use stickslip_plane::Range;
use stickslip_plane::progress::{Progress, Report};

use crate::error::StudyError;
use crate::study::Study;
use fit::Fits;
use limit::{BOUND_FACTOR, Excess};
use points::{Lowest, Measured, Restitution};
use profile::Profile;

/// The name of the layout of the JSON, with its version.
pub const SCHEMA: &str = "stickslip.asymptote/1";

/// The stiffnesses of a study: from about 2 on all oscillations are alike, and at 10¹⁰ a collision
/// has 100 000 switches.
const STIFFNESS: Range = Range { low: 3.0, high: 1e10 };

/// Most impact ratios: lines of a picture that can be told apart.
const MOST_PSI: usize = 4;

/// What is studied.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Interval of the scaled stiffness, within 3 to 10¹⁰.
    pub kappa: Range,
    /// Reduced impact ratios, each above 0 and below 2; one to four.
    pub psi: Vec<f64>,
}

/// Settings are out of range.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum InvalidStiffSprings {
    /// The interval of the stiffness.
    #[error(
        "kappa {low:?}:{high:?} is out of range; expected LO:HI with {:?} <= LO < HI <= {:?}",
        STIFFNESS.low, STIFFNESS.high
    )]
    Kappa {
        /// Its lower end.
        low: f64,
        /// Its upper end.
        high: f64,
    },
    /// The number of impact ratios.
    #[error("psi has {count} values; expected 1 to {MOST_PSI}")]
    PsiCount {
        /// How many there are.
        count: usize,
    },
    /// An impact ratio.
    #[error(
        "psi {psi:?} is out of range; expected numbers above 0 and below 2, from where on there is no \
         switch"
    )]
    Psi {
        /// Its value.
        psi: f64,
    },
    /// An impact ratio that is given twice.
    #[error("psi has {psi:?} twice; expected each value once")]
    PsiTwice {
        /// Its value.
        psi: f64,
    },
}

impl Default for Settings {
    /// κ from 10 to 10⁸, ψ = 0.3, 1 and 1.7.
    fn default() -> Self {
        Self { kappa: Range { low: 10.0, high: 1e8 }, psi: vec![0.3, 1.0, 1.7] }
    }
}

impl Settings {
    fn validate(&self) -> Result<(), InvalidStiffSprings> {
        let Range { low, high } = self.kappa;
        if !(STIFFNESS.low <= low && low < high && high <= STIFFNESS.high) {
            return Err(InvalidStiffSprings::Kappa { low, high });
        }
        let count = self.psi.len();
        if !(1..=MOST_PSI).contains(&count) {
            return Err(InvalidStiffSprings::PsiCount { count });
        }
        for (index, &psi) in self.psi.iter().enumerate() {
            if !(psi > 0.0 && psi < 2.0) {
                return Err(InvalidStiffSprings::Psi { psi });
            }
            if self.psi[..index].contains(&psi) {
                return Err(InvalidStiffSprings::PsiTwice { psi });
            }
        }
        Ok(())
    }
}

/// Stiffnesses in a decade.
const A_DECADE: f64 = 4.0;

/// All that is measured.
struct Measurement {
    kappas: Vec<f64>,
    /// For each ψ, by κ.
    points: Vec<Vec<Measured>>,
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
/// [`StudyError`]: the settings are out of range, or a collision cannot be computed.
pub fn run(settings: &Settings, progress: Report<'_>) -> Result<Study, StudyError> {
    settings.validate()?;
    let kappas = stiffnesses(settings.kappa);
    progress(Progress::Begin { steps: kappas.len() * (settings.psi.len() + Lowest::ALL.len()) });
    let points = at_each(&kappas, &settings.psi, progress, Measured::measure)?;
    let restitutions = at_each(&kappas, &Lowest::ALL, progress, Restitution::measure)?;
    let profile = Profile::measure(settings)?;
    let fits = Fits::new(&points);
    let (peak, excess) = (inner::peak(), limit::excess()?);
    Ok(Measurement { kappas, points, restitutions, profile, peak, excess, fits }.study())
}

/// Stiffnesses evenly spread over the logarithm of the interval, with both its ends.
fn stiffnesses(Range { low, high }: Range) -> Vec<f64> {
    let steps = (A_DECADE * (high / low).log10()).ceil().max(1.0);
    let inside = (1..).map(f64::from).take_while(|step| *step < steps);
    let inside = inside.map(|step| low * (high / low).powf(step / steps));
    std::iter::once(low).chain(inside).chain([high]).collect()
}

/// Measures something for each of `values` at each stiffness; each depends on itself alone.
fn at_each<V: Copy + Sync, T: Send>(
    kappas: &[f64],
    values: &[V],
    progress: Report<'_>,
    measure: impl Fn(f64, V) -> Result<T, StudyError> + Sync,
) -> Result<Vec<Vec<T>>, StudyError> {
    let by_kappa = |value: &V| {
        // The stiffest take longest, and so they come first.
        let measured = kappas.par_iter().rev().with_max_len(1).map(|kappa| {
            let measured = measure(*kappa, *value);
            progress(Progress::Advance { steps: 1 });
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
            "schema": SCHEMA,
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
            json[name] = table.json();
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
