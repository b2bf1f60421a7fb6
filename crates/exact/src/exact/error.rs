//! Collisions that the exact engine does not compute.

use stickslip_contact::Contact;
use stickslip_contact::domain::OutOfDomain;

use super::moment::Moment;
use super::normal::Trajectory;
use super::slide::Slide;
use crate::domain;

/// The reason why the exact engine does not compute a collision.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ExactError {
    /// The contact is out of range.
    #[error(transparent)]
    Domain(#[from] OutOfDomain),
    /// There is an exact solution of the paper's law only.
    #[error("there is no exact solution of this contact law; expected dop853 or dopri5")]
    Law,
    /// The collision has too many switches for a list.
    #[error(
        "more than {limit} switches at kappa = {kappa}, psi = {psi}: \
         the limit is reached a scaled time {time_left} before the end of contact"
    )]
    TooManySwitches {
        /// The largest number of switches.
        limit: usize,
        /// Scaled stiffness of the contact.
        kappa: f64,
        /// Reduced impact ratio of the contact.
        psi: f64,
        /// Scaled time left at the first switch beyond the limit.
        time_left: f64,
    },
}

/// Checks that `contact` is in the range of the engine.
pub fn checked(contact: &Contact) -> Result<(), ExactError> {
    if !contact.obeys_paper() {
        return Err(ExactError::Law);
    }
    Ok(domain::exact(contact)?)
}

/// The error of a collision that has more than `limit` switches, the first of them at `onset`.
pub fn too_many<T: Trajectory>(
    contact: &Contact,
    limit: usize,
    slide: &Slide<T>,
    onset: Moment,
) -> ExactError {
    let (kappa, psi) = (contact.kappa(), contact.psi());
    let path = slide.path;
    let time_left = path.time_left(&path.at(onset)) * path.time_unit();
    ExactError::TooManySwitches { limit, kappa, psi, time_left }
}
