//! Errors of one time step, over impacts and start phases.

use std::cmp::Ordering;

use rayon::prelude::*;
use stickslip_model::{Collision, Contact};

use super::settings::TimeStepSettings;
use super::stepped::{Stepped, step, undamped_contact_time};

/// A result whose error is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SteppedQuantity {
    /// ε_t.
    TangentialRestitution,
    /// ε_n.
    NormalRestitution,
    /// The kinetic energy of the relative motion after the contact, divided by that before.
    Energy,
}

impl SteppedQuantity {
    /// All quantities, in the order in which they are shown.
    pub const ALL: [Self; 3] = [Self::TangentialRestitution, Self::NormalRestitution, Self::Energy];

    /// The name in files: `eps_t`, `eps_n` or `energy`.
    pub fn name(self) -> &'static str {
        match self {
            Self::TangentialRestitution => "eps_t",
            Self::NormalRestitution => "eps_n",
            Self::Energy => "energy",
        }
    }
}

/// The errors at one time step.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct TimeStepRow {
    /// The step, as the number t_c/dt of steps in the undamped contact time.
    pub steps_per_contact: f64,
    /// Whether the errors belong to a computation that resolves the contact.
    pub status: Status,
    /// Errors of ε_t; no quantity has errors if the status is [`Status::Unfinished`].
    pub eps_t: Option<TimeStepErrors>,
    /// Errors of ε_n.
    pub eps_n: Option<TimeStepErrors>,
    /// Errors of the energy after the contact, as parts of the energy before.
    pub energy: Option<TimeStepErrors>,
    /// The largest [`Stepped::stiffness`] of all contacts that have ended.
    pub stiffness: f64,
    /// Number of contacts, of impacts times phases, in which a spring is not resolved.
    pub unstable: usize,
    /// Number of contacts that did not end.
    pub unfinished: usize,
}

/// What the errors at one time step are worth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// All contacts have ended, and the steps resolve their springs.
    Ok,
    /// All contacts have ended, but in some the steps do not resolve a spring, whose oscillation
    /// then grows. The errors belong to such computations.
    Unstable,
    /// Some contacts did not end, so that there are no errors.
    Unfinished,
}

impl Status {
    /// The name of the status in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ok => "ok",
            Self::Unstable => "unstable",
            Self::Unfinished => "unfinished",
        }
    }
}

/// Absolute errors of one quantity over impacts and start phases.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct TimeStepErrors {
    /// The median; of an even number, the mean of the two in the middle.
    pub median: f64,
    /// The root mean square of the errors themselves, not of their scatter around a mean.
    pub root_mean_square: f64,
    /// The largest error, and where it is.
    pub worst: Worst,
}

/// The largest error.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Worst {
    /// The error.
    pub error: f64,
    /// The index of the impact.
    pub contact: usize,
    /// The part of a step after which the contact begins.
    pub phase: f64,
}

impl TimeStepRow {
    /// The errors of `quantity`.
    pub fn errors(&self, quantity: SteppedQuantity) -> Option<TimeStepErrors> {
        match quantity {
            SteppedQuantity::TangentialRestitution => self.eps_t,
            SteppedQuantity::NormalRestitution => self.eps_n,
            SteppedQuantity::Energy => self.energy,
        }
    }

    /// Measures the errors against `exact`, on the threads of the current pool. `done` is called
    /// once for each impact.
    pub(super) fn measure(
        settings: &TimeStepSettings,
        steps_per_contact: f64,
        exact: &[Collision],
        done: impl Fn() + Sync,
    ) -> Self {
        let contacts: Vec<Vec<Option<Stepped>>> = exact
            .par_iter()
            .map(|collision| {
                let stepped = stepped(settings, steps_per_contact, collision);
                done();
                stepped
            })
            .collect();
        let all = || contacts.iter().flatten();
        let ended = || all().flatten();
        let unfinished = all().filter(|stepped| stepped.is_none()).count();
        let unstable = ended().filter(|stepped| !stepped.is_stable()).count();
        let errors = |quantity| {
            (unfinished == 0).then(|| errors(settings, quantity, exact, &contacts)).flatten()
        };
        Self {
            steps_per_contact,
            status: match (unfinished, unstable) {
                (0, 0) => Status::Ok,
                (0, _) => Status::Unstable,
                _ => Status::Unfinished,
            },
            eps_t: errors(SteppedQuantity::TangentialRestitution),
            eps_n: errors(SteppedQuantity::NormalRestitution),
            energy: errors(SteppedQuantity::Energy),
            stiffness: ended().map(|stepped| stepped.stiffness).fold(0.0, f64::max),
            unstable,
            unfinished,
        }
    }
}

/// The start phase with an index, a part of a step.
fn phase(settings: &TimeStepSettings, index: usize) -> f64 {
    (index as f64 + 0.5) / settings.phases as f64
}

/// The collision in steps, for every start phase.
fn stepped(settings: &TimeStepSettings, steps: f64, exact: &Collision) -> Vec<Option<Stepped>> {
    let dt = undamped_contact_time(exact.contact.law()) / steps;
    let phases = (0..settings.phases).map(|index| phase(settings, index));
    phases
        .map(|phase| step(&exact.contact, dt, phase, &settings.stepping, exact.contact_time))
        .collect()
}

/// The errors of `quantity`, if there are any numbers.
fn errors(
    settings: &TimeStepSettings,
    quantity: SteppedQuantity,
    exact: &[Collision],
    contacts: &[Vec<Option<Stepped>>],
) -> Option<TimeStepErrors> {
    let mut errors = Vec::new();
    let mut worst: Option<Worst> = None;
    for (contact, (collision, phases)) in exact.iter().zip(contacts).enumerate() {
        let true_value = value(settings, quantity, collision.contact, exact_result(collision));
        for (index, stepped) in phases.iter().enumerate() {
            let Stepped { eps_n, eps_t, .. } = (*stepped)?;
            let found = value(settings, quantity, collision.contact, (eps_n, eps_t));
            let error = (found - true_value).abs();
            if !worst.is_some_and(|worst| error <= worst.error) {
                worst = Some(Worst { error, contact, phase: phase(settings, index) });
            }
            errors.push(error);
        }
    }
    let squares: f64 = errors.iter().map(|error| error * error).sum();
    let root_mean_square = (squares / errors.len() as f64).sqrt();
    Some(TimeStepErrors { median: median(errors)?, root_mean_square, worst: worst? })
}

fn exact_result(collision: &Collision) -> (f64, f64) {
    (collision.eps_n, collision.eps_t())
}

fn value(
    settings: &TimeStepSettings,
    quantity: SteppedQuantity,
    contact: Contact,
    (eps_n, eps_t): (f64, f64),
) -> f64 {
    match quantity {
        SteppedQuantity::TangentialRestitution => eps_t,
        SteppedQuantity::NormalRestitution => eps_n,
        SteppedQuantity::Energy => {
            let ratio = settings.stepping.reduction.ratio(contact.psi());
            // Tangential over normal energy before the contact.
            let share = settings.stepping.reduction.alpha * ratio * ratio;
            let (normal, tangential) = (1.0 / (1.0 + share), 1.0 / (1.0 + 1.0 / share));
            normal * eps_n * eps_n + tangential * eps_t * eps_t
        }
    }
}

fn median(mut errors: Vec<f64>) -> Option<f64> {
    errors.sort_by(f64::total_cmp);
    let middle = errors.len() / 2;
    match (errors.len() % 2).cmp(&1) {
        Ordering::Equal => errors.get(middle).copied(),
        _ => Some(0.5 * (errors.get(middle.checked_sub(1)?)? + errors.get(middle)?)),
    }
}
