//! Single collisions and their course in time.

use stickslip_model::{Collision, Contact, History};

use super::reading::{Reading, psi};
use crate::engine::{Engine, EngineError};
use crate::error::Failure;
use crate::figure::course::Course;
use crate::study::{Cell, Column};

/// The undamped collision at κ and ψ, by the exact solution.
///
/// # Errors
/// It cannot be computed.
pub fn collide(kappa: f64, psi: f64) -> Result<Collision, Failure> {
    let contact = contact(kappa, psi)?;
    let collided = Engine::Exact.collide(contact);
    collided.map(|(collision, _)| collision).map_err(|source| failure(&contact, source))
}

/// The same where the axis of stiffness shows `value`, at an impact ratio, with its course by
/// Dormand–Prince 8(5,3).
///
/// # Errors
/// It cannot be computed.
pub fn followed(reading: Reading, value: f64, ratio: f64) -> Result<(Collision, History), Failure> {
    let collision = collide(reading.kappa(value), psi(ratio))?;
    let contact = collision.contact;
    let history = Engine::Exact.history(contact).map_err(|source| failure(&contact, source))?;
    Ok((collision, history))
}

fn contact(kappa: f64, psi: f64) -> Result<Contact, Failure> {
    Contact::new(kappa, psi, 0.0).map_err(|error| Failure::Usage(error.to_string()))
}

fn failure(contact: &Contact, source: EngineError) -> Failure {
    let (kappa, psi, damping) = (contact.kappa(), contact.psi(), contact.damping());
    Failure::Computation { kappa, psi, damping, source }
}

/// Times of the first and the last switch; NaN if there is none.
pub fn first_and_last(collision: &Collision) -> [f64; 2] {
    let switches = &collision.switches;
    [switches.first(), switches.last()].map(|switch| switch.map_or(f64::NAN, |switch| switch.time))
}

/// The time of the largest compression; without damping the contact is symmetric.
pub fn largest_compression(collision: &Collision) -> f64 {
    0.5 * collision.contact_time
}

/// Columns of [`rows`].
pub const COLUMNS: [Column; 4] = [
    Column { name: "time", meaning: "scaled time" },
    Column { name: "normal_force", meaning: "F_n in units of m β^{2/5} g_n^{6/5}" },
    Column { name: "tangential_force", meaning: "F_t/μ in the same units" },
    Column { name: "velocity", meaning: "w = (α/μ) g_t/g_n" },
];

/// A course as it is drawn in a panel `width` pixels wide; at a switch there are two rows.
pub fn rows(collision: &Collision, history: &History, width: f64) -> Vec<Vec<Cell>> {
    let course = Course::new(collision, history, width);
    let row = |s: &stickslip_model::Snapshot| {
        [s.time, s.normal_force, s.tangential_force, s.velocity].map(Cell::Number).to_vec()
    };
    course.samples().iter().map(row).collect()
}
