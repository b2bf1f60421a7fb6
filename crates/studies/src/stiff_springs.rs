//! The study of the limit of stiff springs: how ε_t tends to 0, and why as κ^{−5/4}.
//!
//! Start reading here; then, in this order: [`limit`] (maxima of full collisions), `maxima` (what
//! is measured of them), `profile` (the inner problem beside them), `fit` (exponent and constant),
//! `findings` and `tables`.
//!
//! # What is measured
//!
//! Collisions have no damping, ψ is between 0 and 2, and names are those of docs/physics.md.
//!
//! **One number for each κ.** A stick phase starts where s y = L and s w = dL/dt. The time of this
//! *onset* decides all that follows. In the decompression a collision is therefore a map from one
//! onset to the next, half a swing later and on the other side, and |w_final| is a function of the
//! last onset alone. As ψ moves, the last onset runs through the same interval again and again.
//! The largest |w_final|, E(κ), is therefore the same for all ψ
//! (`stickslip::studies::stiff_springs::limit`).
//!
//! **The next order.** x = τ(1 − (4/35)τ^{5/2} + …), and τ^{5/2} = κ^{−5/4} σ^{5/2}. The limit
//! becomes σ^{3/2} − (6/35)κ^{−5/4} σ⁴. As G is stationary in σ₀ and in σ₁, only the change of the
//! limit counts:
//!
//! ```text
//! κ^{5/4} E(κ) = F + F₁ κ^{−5/4} + O(κ^{−5/2})     F₁ = −(6/35)σ₀⁴ + (6/175)σ₁⁵ = −26.8733479956…
//! ```
//!
//! **The phase** φ(σ) = σ/π + 2√(3/π) σ^{−1/2} + … falls by 1 from each onset to the next, and F
//! is a function of it with period 1. √κ/π times the time left at the first switch is the phase up
//! to O(κ^{−1/4}).
//!
//! **The count.** Half a swing has two switches if the spring reaches its limit: for ψ ≥ 1 from
//! the first switch on, which is at the time t₁, and for ψ < 1 from its mirror image on. The count
//! is therefore 2√κ min(t₁, t_c − t₁)/π, except for a few switches: √κ t_c/π at ψ = 1 and less
//! elsewhere.
//!
//! **The range (30)**, in which ε_t is said to be close to 0, is read as ψ from m/√κ, where the
//! bound (27) is 1/m, to 2, where sliding lasts. The largest |ε_t| lies at the lower end and is F
//! κ^{−3/4}/m. From a fixed ψ on it is F κ^{−5/4}/ψ. Below ψ ≈ 20 κ^{−5/4} ε_t is of order 1.

use rayon::prelude::*;
use serde_json::json;
use stickslip_model::limits::inner;
use stickslip_model::limits::inner::Peak;
use stickslip_model::{GivenValue, InvalidValue};
use stickslip_plane::Range;
use stickslip_plane::progress::{Progress, Report};

use crate::error::StudyError;
use crate::limits::{MOST_PSI, STIFFNESSES};
use crate::study::Study;
use limit::BOUND_FACTOR;

mod findings;
mod fit;
pub mod limit;
mod maxima;
mod profile;
mod tables;

pub use fit::{Fits, FittedConstant};
pub use limit::Excess;
pub use maxima::{LargestRestitution, LargestVelocity, MOST_RESOLVED, RangeStart};
pub use profile::{ComparedCollision, CurvePoint, OtherStart, Profile};

/// The name of the layout of the JSON, with its version.
pub const SCHEMA: &str = "stickslip.asymptote/1";
/// The title of the study.
pub const TITLE: &str = "The limit of stiff springs";

/// Stiffnesses per decade.
const PER_DECADE: f64 = 4.0;

/// How ε_t tends to 0 for stiff springs.
#[derive(Clone, Debug)]
pub struct StiffSprings {
    /// The stiffnesses, in rising order.
    pub kappas: Vec<f64>,
    /// The largest final velocities, for each ψ, by κ.
    pub velocities: Vec<Vec<LargestVelocity>>,
    /// The largest |ε_t|, for each range of ψ, by κ.
    pub restitutions: Vec<Vec<LargestRestitution>>,
    /// The ψ of `single`.
    pub single_psi: f64,
    /// κ and |w_final| at one ψ, as far as single oscillations are resolved.
    pub single: Vec<(f64, f64)>,
    /// F(phase) of the inner problem.
    pub profile: Profile,
    /// The largest F.
    pub peak: Peak,
    /// Where the bound (27) is exceeded.
    pub excess: Excess,
    /// Exponent and constant; `None` if too few collisions are stiff.
    pub fits: Option<Fits>,
}

/// Makes the study on the threads of the current pool.
///
/// # Errors
/// [`StudyError`]: the settings are out of range, or a collision cannot be computed.
pub fn run(
    settings: &StiffSpringSettings,
    progress: Report<'_>,
) -> Result<StiffSprings, StudyError> {
    settings.validate()?;
    let kappas = stiffnesses(settings.kappa);
    progress(Progress::Begin {
        steps: kappas.len() * (settings.psi.len() + RangeStart::ALL.len()),
    });
    let velocities = at_each(&kappas, &settings.psi, progress, LargestVelocity::measure)?;
    let restitutions = at_each(&kappas, &RangeStart::ALL, progress, LargestRestitution::measure)?;
    let single_psi = settings.psi[settings.psi.len() / 2];
    Ok(StiffSprings {
        single_psi,
        single: maxima::single(settings.kappa, single_psi)?,
        profile: Profile::measure(settings)?,
        peak: inner::peak(),
        excess: limit::excess()?,
        fits: Fits::new(&velocities),
        kappas,
        velocities,
        restitutions,
    })
}

/// Stiffnesses evenly spread over the logarithm of the interval, both ends included.
fn stiffnesses(Range { low, high }: Range) -> Vec<f64> {
    let steps = (PER_DECADE * (high / low).log10()).ceil().max(1.0);
    let inside = (1..).map(f64::from).take_while(|step| *step < steps);
    let inside = inside.map(|step| low * (high / low).powf(step / steps));
    std::iter::once(low).chain(inside).chain([high]).collect()
}

/// Measures something for each of `values` at each stiffness. Each result depends on itself alone.
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

impl StiffSprings {
    /// The study: findings, numbers and tables.
    pub fn study(&self) -> Study {
        let tables = self.tables();
        let mut json = json!({
            "schema": SCHEMA,
            "inner_problem": {
                "largest": self.peak.velocity,
                "last_onset": self.peak.onset,
                "last_release": self.peak.release,
                "phase": self.profile.peak_phase,
                "correction": self.peak.correction,
            },
            "fits": self.fits,
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
            title: TITLE,
            headlines: self.headlines(),
            findings: self.findings(),
            json,
            tables,
        }
    }
}

/// The stiffnesses and impact ratios of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct StiffSpringSettings {
    /// Interval of the scaled stiffness κ, within 3 to 10¹⁰.
    pub kappa: Range,
    /// Reduced impact ratios ψ, each above 0 and below 2; one to four.
    pub psi: Vec<f64>,
}

impl Default for StiffSpringSettings {
    /// κ from 10 to 10⁸, ψ = 0.3, 1 and 1.7.
    fn default() -> Self {
        Self { kappa: Range { low: 10.0, high: 1e8 }, psi: vec![0.3, 1.0, 1.7] }
    }
}

impl StiffSpringSettings {
    /// Checks all settings.
    ///
    /// # Errors
    /// [`InvalidValue`] names the first that is out of range.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        let Range { low, high } = self.kappa;
        let (least, most) = (STIFFNESSES.low, STIFFNESSES.high);
        if !(least <= low && low < high && high <= most) {
            let expected = format!("LO:HI with {least:?} <= LO < HI <= {most:?}");
            return Err(InvalidValue::new("kappa", [low, high], expected));
        }
        let count = self.psi.len();
        if !(1..=MOST_PSI).contains(&count) {
            let given = GivenValue::Phrase(format!("has {count} values").into());
            return Err(InvalidValue::new("psi", given, format!("1 to {MOST_PSI}")));
        }
        for (index, &psi) in self.psi.iter().enumerate() {
            let (phrase, expected) = if !(psi > 0.0 && psi < 2.0) {
                let expected = "numbers above 0 and below 2, from where on there is no switch";
                (format!("{psi:?} is out of range"), expected)
            } else if self.psi[..index].contains(&psi) {
                (format!("has {psi:?} twice"), "each value once")
            } else {
                continue;
            };
            return Err(InvalidValue::new("psi", GivenValue::Phrase(phrase.into()), expected));
        }
        Ok(())
    }
}
