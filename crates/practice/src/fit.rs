//! Fits of contact laws to measured impacts.
//!
//! [`run`] finds the tangential stiffness and the friction, or another number, with which a contact
//! law comes closest to measured restitution, spins or rebound angles. Such problems have many
//! minima: the tangential spring swings more often in a contact when it is stiffer, and at each
//! further swing the data may be met again. All minima in a range are found and reported, and the
//! intervals take them into account.
//!
//! 1. The damping is fitted to ε_n alone, on which the tangential motion has no effect; or it
//!    follows from a given ε_n.
//! 2. The misfit of the tangential motion is computed on a grid. Its places are a twelfth of half a
//!    period of the spring apart, in the phase √κ t_c of the stiffest impact, and 6 % in μ. Along
//!    every line of the grid, in both directions, all minima are improved. A minimum that is
//!    narrower than the grid can be missed.
//! 3. From each minimum of the plane, a simplex descends, which no kink of ε_t hinders. With the
//!    paper's law, Gauss–Newton steps follow with the sensitivities of the collisions.
//! 4. A confidence interval holds all values of a number for which the least misfit over the other
//!    ones is not above a threshold: it is computed over the whole range, and may have several
//!    pieces.
//! 5. The angles at which the switches of the best fit change are traced.
//!
//! Start reading here; then, in this order: `data`, `columns`, `bodies`, `free`, `settings` (the
//! question), `problem` (what the model says), `axis`, `scan`, `local`, `survey` (the search),
//! `quantile`, `intervals`, `normal` (damping), `course`.

mod axis;
mod bodies;
mod columns;
mod course;
mod data;
mod free;
mod intervals;
mod local;
mod normal;
mod problem;
mod quantile;
mod scan;
mod search;
mod settings;
mod survey;

use stickslip_model::spheres::BodyPair;
use stickslip_model::{CollisionError, CollisionFailure, InvalidValue, Law};
use stickslip_plane::atlas::AtlasError;
use stickslip_plane::progress::Report;

pub use bodies::{FittedBodies, Values};
pub use columns::{MeasuredColumn, data};
pub use course::{Boundary, FittedCourse, FittedCurve};
pub use data::{Datum, Measured};
pub use free::{Free, Ranges};
pub use intervals::{ConfidenceInterval, IntervalPiece};
pub use normal::DampingFit;
pub use settings::FitSettings;
pub use survey::Survey;

/// The name of the layout of the JSON, with its version.
pub const SCHEMA: &str = "stickslip.fit/1";

/// A fit.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Fit {
    /// [`SCHEMA`].
    pub schema: &'static str,
    /// The contact law, as the bodies have it: a decay of friction is that at their μ.
    pub law: Law,
    /// α.
    pub alpha: f64,
    /// The speed in m/s to which "at normal incidence" refers: the largest of the data. `None` in
    /// scaled units.
    pub speed_m_per_s: Option<f64>,
    /// κ at normal incidence of a tangential stiffness of 1, in the unit of [`Minimum::stiffness`].
    /// `None` in scaled units.
    pub kappa_of_unit_stiffness: Option<f64>,
    /// What was fitted.
    pub free: Vec<Free>,
    /// Where it was looked for.
    pub ranges: Ranges,
    /// The number of data of the tangential motion.
    pub data: usize,
    /// Whether the size of the errors was estimated from the residuals.
    pub estimated_errors: bool,
    /// The part of the cases in which intervals hold the true value.
    pub level: f64,
    /// The misfit up to which values are in the intervals. `None` without intervals.
    pub threshold: Option<f64>,
    /// The fit of the damping to ε_n, if it is free.
    pub damping: Option<DampingFit>,
    /// ε_n at normal incidence.
    pub eps_n: f64,
    /// All minima, the best one first.
    pub minima: Vec<Minimum>,
    /// The intervals of all free numbers.
    pub intervals: Vec<ConfidenceInterval>,
    /// The best fit with Mindlin's stiffness of the materials.
    pub mindlin: Option<Mindlin>,
    /// What is left of each datum at the best minimum.
    pub residuals: Vec<Residual>,
    /// The best fit at all angles. `None` where nothing was measured at an angle, and where only a
    /// [`Survey`] was made.
    pub course: Option<FittedCourse>,
}

/// A minimum of the misfit.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Minimum {
    /// Where it is.
    #[serde(flatten)]
    pub values: Values,
    /// The tangential stiffness: k_t in kg/s² where it is constant, K in kg/(s² √m) where it is
    /// Mindlin's. `None` in scaled units.
    pub stiffness: Option<f64>,
    /// Sum of the squares of the residuals over their errors; an error that is not known counts as
    /// 1.
    pub misfit: f64,
    /// Root mean squares of the residuals.
    pub root_mean_squares: Vec<RootMeanSquare>,
    /// Whether a free number is at an end of its range, beyond which the misfit may fall further.
    pub at_end_of_range: bool,
}

/// The root mean square of the residuals of one quantity.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct RootMeanSquare {
    /// The quantity.
    pub quantity: Measured,
    /// The number of data.
    pub data: usize,
    /// The root mean square, in the unit of the quantity.
    pub value: f64,
}

/// A datum and what the model says of it.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Residual {
    /// The datum.
    #[serde(flatten)]
    pub datum: Datum,
    /// What the model says.
    pub predicted: f64,
    /// Measured less predicted.
    pub residual: f64,
}

/// The best fit with the tangential stiffness that Mindlin's theory gives the materials.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Mindlin {
    /// The best fit.
    pub best: Minimum,
    /// Whether its κ is outside the interval of κ. `None` if there is no interval, or if κ is
    /// outside the range.
    pub excluded: Option<bool>,
}

/// Fits the settings' numbers, on the threads of the current pool.
///
/// With the default ranges and the paper's law, ten data take about half a second on one core, and
/// with other laws, whose collisions are integrated, thirty times as long.
///
/// ```
/// use stickslip_model::Law;
/// use stickslip_plane::{Range, progress};
/// use stickslip_practice::fit::{self, FittedBodies, Datum, Measured, FitSettings, Values};
///
/// // What would be measured of homogeneous spheres with κ = 5 and μ = 0.1.
/// let values = Values { kappa: 5.0, mu: 0.1, tangential_damping: 0.0, damping: 0.0 };
/// let bodies = FittedBodies::scaled(Law::PAPER, 2.0 / 7.0, &values)?;
/// let angles = [5.0_f64, 10.0, 20.0, 30.0, 45.0, 60.0].map(f64::to_radians);
/// let predicted = fit::predicted(&bodies, 1.0, Measured::CentreRestitution, &angles)?;
/// let data = angles.iter().zip(&predicted).map(|(angle, e_t)| {
///     Datum::at_angle(*angle, 1.0, Measured::CentreRestitution, *e_t, Some(0.01))
/// });
///
/// let mut settings = FitSettings::new(bodies, data.collect());
/// settings.ranges.kappa = Range { low: 1.0, high: 20.0 };
/// let found = fit::run(&settings, progress::SILENT)?;
/// let best = &found.minima[0].values;
/// assert!((best.kappa - 5.0).abs() < 1e-6 && (best.mu - 0.1).abs() < 1e-8);
/// assert_eq!(found.intervals[0].holds(5.0), Some(true));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`FitError`]: the settings are out of range, or an impact cannot be computed.
pub fn run(settings: &FitSettings, progress: Report<'_>) -> Result<Fit, FitError> {
    let survey = Survey::new(settings, progress)?;
    survey.with_course(survey.fit()?)
}

/// What the model says of `quantity` at `angles_rad` from the normal, at `speed_m_per_s`, with the
/// bodies' own values.
///
/// # Errors
/// [`FitError`]: an impact cannot be computed.
pub fn predicted(
    bodies: &FittedBodies,
    speed_m_per_s: f64,
    quantity: Measured,
    angles_rad: &[f64],
) -> Result<Vec<f64>, FitError> {
    let units = bodies.units(speed_m_per_s)?;
    let values = bodies.values(&units);
    let predicted = |angle: &f64| problem::predicted_at(bodies, &units, &values, quantity, *angle);
    angles_rad.iter().map(predicted).collect()
}

impl Fit {
    /// The two bodies with the values of the best minimum. `None` in scaled units.
    ///
    /// # Errors
    /// [`FitError`]: they have no impact at the speed of the fit.
    pub fn best_pair(&self, bodies: &FittedBodies) -> Result<Option<BodyPair>, FitError> {
        let (Some(speed), Some(best)) = (self.speed_m_per_s, self.minima.first()) else {
            return Ok(None);
        };
        let units = bodies.units(speed)?;
        Ok(Some(bodies.with(&units, &best.values)))
    }
}

/// Why there is no fit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// Settings or data cannot be used, or an impact has no scaled parameters.
    #[error(transparent)]
    Value(#[from] InvalidValue),
    /// An impact cannot be computed.
    #[error(transparent)]
    Contact(#[from] CollisionFailure),
    /// The boundaries cannot be traced.
    #[error(transparent)]
    Boundaries(#[from] Box<AtlasError>),
    /// No damping has a given ε_n, or it cannot be found.
    #[error(transparent)]
    Restitution(#[from] CollisionError),
    /// A search has no places to start from.
    #[error("a search has no places to start from")]
    NoPlaces,
    /// Brent's method for a minimum failed.
    #[error("Brent's method for a minimum failed from {low:?} to {high:?}")]
    Minimum {
        /// The beginning of the interval.
        low: f64,
        /// Its end.
        high: f64,
    },
    /// Brent's method for a zero failed.
    #[error(
        "Brent's method for a zero failed from {low:?} to {high:?}; expected values of two signs \
         at the ends"
    )]
    Zero {
        /// The beginning of the interval.
        low: f64,
        /// Its end.
        high: f64,
    },
    /// The simplex method of Nelder and Mead failed.
    #[error("the simplex method failed from {start:?} with the sides {sides:?}")]
    Simplex {
        /// The place at which it began.
        start: [f64; 2],
        /// The sides of the triangle.
        sides: [f64; 2],
    },
}
