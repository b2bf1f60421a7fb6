//! Single collisions and their course in time.

use stickslip_figure::pictures::course::Course;
use stickslip_model::history::{History, Snapshot};
use stickslip_model::{Collision, CollisionFailure, Contact, Engine};
use stickslip_studies::Cell;
use stickslip_studies::paper::{Reading, psi};

use crate::error::ReproductionError;
use crate::statements::Spring;

/// The undamped collision at κ and ψ, by the exact solution.
///
/// # Errors
/// [`ReproductionError`]: it cannot be computed.
pub fn collide(kappa: f64, psi: f64) -> Result<Collision, ReproductionError> {
    Spring::Reset.collide(kappa, psi, 0.0)
}

/// The collision where the axis of stiffness shows `value`, at an impact ratio, and its course by
/// Dormand–Prince 8(5,3).
///
/// # Errors
/// [`ReproductionError`]: it cannot be computed.
pub fn followed(
    reading: Reading,
    value: f64,
    ratio: f64,
) -> Result<(Collision, History), ReproductionError> {
    let contact = Contact::new(reading.kappa(value), psi(ratio), 0.0)?;
    let failed = |source| CollisionFailure::new(&contact, source);
    let (collision, _, history) = Engine::Exact.followed(contact).map_err(failed)?;
    Ok((collision, history))
}

/// The times of the first and the last switch; NaN if there is none.
pub fn first_and_last(collision: &Collision) -> [f64; 2] {
    let switches = &collision.switches;
    [switches.first(), switches.last()].map(|switch| switch.map_or(f64::NAN, |switch| switch.time))
}

/// The time of the largest compression. Without damping the contact is symmetric.
pub fn largest_compression(collision: &Collision) -> f64 {
    0.5 * collision.contact_time
}

/// The rows of [`super::section::COURSE`]: a course as it is drawn in a panel `width` pixels wide.
/// At a switch there are two rows.
pub fn rows(collision: &Collision, history: &History, width: f64) -> Vec<Vec<Cell>> {
    let course = Course::new(collision, history, width);
    let row = |moment: &Snapshot| {
        let Snapshot { time, normal_force, tangential_force, velocity, .. } = *moment;
        [time, normal_force, tangential_force, velocity].map(Cell::Number).to_vec()
    };
    course.samples().iter().map(row).collect()
}
