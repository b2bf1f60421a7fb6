//! Errors of the time steps of particle codes.
//!
//! A particle code computes a contact in steps of fixed length. Its results have errors of the
//! order of the step, which depend on where in a step the contact begins. [`run`] computes impacts
//! in the steps of a code ([`Scheme`]) and without steps ([`Engine::Auto`]), and measures the
//! difference in ε_t, in ε_n and in the energy after the contact. Steps are given as numbers t_c/dt
//! of steps in the undamped contact time t_c ([`undamped_contact_time`]).
//!
//! Start reading here; then, in this order: `stepped` (what codes do in a step, and one collision
//! in steps), `adhesion` (its normal force), `turning` (spheres with a normal that turns),
//! `settings`, `measure` (errors over impacts and start phases), `seconds` (times in SI units).
//!
//! Against LAMMPS itself, in 264 impacts with 28 laws: the root mean square of the error of ε_t
//! differs from the error of LAMMPS' own collisions by at most 0.3 % at t_c/20, 2.5 % at t_c/50 and
//! 3.1 % at t_c/100. Exceptions are five elastic impacts at t_c/100, whose errors below 4e-6 depend
//! on the overlap of LAMMPS' spheres (`docs/validation.md`). With adhesion and turning normals, 801
//! impacts in 20 to 200 steps are those of LAMMPS to 1e-10, or 1e-6 with synchronized dashpots.
//!
//! The contact is a point, unless an overlap is given ([`Stepping::overlap`]): then the normal
//! turns during the contact, and what that changes is in the errors too, however short steps are.

mod adhesion;
mod measure;
mod seconds;
mod settings;
mod stepped;
mod turning;

use rayon::prelude::*;
use stickslip_model::{Collision, CollisionError, CollisionFailure, Contact, Engine, InvalidValue};
use stickslip_plane::progress::{Progress, Report};

pub use measure::{Status, SteppedQuantity, TimeStepErrors, TimeStepRow, Worst};
pub use seconds::{Seconds, rayleigh_time_s};
pub use settings::TimeStepSettings;
pub use stepped::{Scheme, Stepped, Stepping, step, undamped_contact_time};

/// The name of the layout of the JSON, with its version.
pub const SCHEMA: &str = "stickslip.timestep/1";

/// The errors of time steps.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct TimeSteps {
    /// [`SCHEMA`].
    pub schema: &'static str,
    /// The scheme.
    pub scheme: Scheme,
    /// The greatest overlap over the distance of the centres; 0 for a normal that stands still.
    #[serde(skip_serializing_if = "is_zero")]
    pub overlap: f64,
    /// The number of start phases.
    pub phases: usize,
    /// The numbers by which tangential energy is compared with normal energy.
    pub reduction: stickslip_model::Reduction,
    /// The impacts.
    pub contacts: Vec<Contact>,
    /// The errors for each time step, from the longest to the shortest.
    pub rows: Vec<TimeStepRow>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// Measures the errors of all time steps, on the threads of the current pool.
///
/// It takes about 15 ns for each step of each contact, ten times as long with JKR, and memory for
/// 40 bytes times impacts times phases. A time step that occurs twice is measured once. The results
/// without steps are good to about 1e-12: errors of this size may come from either.
///
/// # Errors
/// [`TimeStepsError`]: the settings are out of range, an impact cannot be computed without steps,
/// or adhesion holds its bodies together, so that there is no restitution to compare with.
pub fn run(settings: &TimeStepSettings, progress: Report<'_>) -> Result<TimeSteps, TimeStepsError> {
    settings.validate()?;
    let mut steps = settings.steps_per_contact.clone();
    steps.sort_by(f64::total_cmp);
    steps.dedup();
    progress(Progress::Begin { steps: steps.len() * settings.contacts.len() });
    let exact = settings.contacts.par_iter().map(|contact| {
        let (collision, _) = Engine::Auto.collide(*contact)?;
        if collision.adheres {
            return Err(CollisionError::Adheres { time: collision.contact_time });
        }
        Ok(collision)
    });
    let exact: Vec<Result<Collision, CollisionError>> = exact.collect();
    // The first failure is the same for any number of threads.
    let exact = exact.into_iter().zip(&settings.contacts).map(|(collision, contact)| {
        collision.map_err(|source| CollisionFailure::new(contact, source))
    });
    let exact: Vec<Collision> = exact.collect::<Result<_, _>>()?;
    let done = || progress(Progress::Advance { steps: 1 });
    let rows =
        steps.iter().map(|steps| TimeStepRow::measure(settings, *steps, &exact, done)).collect();
    Ok(TimeSteps {
        schema: SCHEMA,
        scheme: settings.stepping.scheme,
        overlap: settings.stepping.overlap,
        phases: settings.phases,
        reduction: settings.stepping.reduction,
        contacts: settings.contacts.clone(),
        rows,
    })
}

impl TimeSteps {
    /// The largest step dt/t_c at which errors of `quantity` are at most `wanted`: there, and at
    /// every shorter step of [`Self::rows`], all errors over impacts and start phases are at most
    /// `wanted`, and all contacts end with resolved springs. `None` if that does not hold at the
    /// shortest step.
    ///
    /// Errors do not fall evenly with the step. Nothing is promised of steps that were not
    /// measured, between those that were or below them, nor of other impacts and phases.
    pub fn largest_step(&self, quantity: SteppedQuantity, wanted: f64) -> Option<f64> {
        let holds = |row: &&TimeStepRow| {
            let error = row.errors(quantity).map(|errors| errors.worst.error);
            row.status == Status::Ok && error.is_some_and(|error| error <= wanted)
        };
        self.rows.iter().rev().take_while(holds).last().map(|row| 1.0 / row.steps_per_contact)
    }
}

/// Why there are no errors of time steps.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TimeStepsError {
    /// Settings are out of range.
    #[error(transparent)]
    Settings(#[from] InvalidValue),
    /// An impact cannot be computed without steps.
    #[error(transparent)]
    Contact(#[from] CollisionFailure),
}
