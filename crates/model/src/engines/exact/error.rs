//! Collisions that the exact engine does not compute.

use super::trajectory::Moment;
use crate::contact::Contact;
use crate::engines::domain::{self, OutOfDomain};

/// The reason why the exact engine does not compute a collision.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ExactError {
    /// The contact is damped, and there is no closed form.
    #[error("the exact solution holds without damping; the scaled damping is {damping}")]
    Damped {
        /// Scaled damping of the contact.
        damping: f64,
    },
    /// The contact is out of range.
    #[error(transparent)]
    Domain(#[from] OutOfDomain),
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

/// Checks that `contact` has no damping and is in the range of the engine.
pub fn undamped(contact: &Contact) -> Result<(), ExactError> {
    if contact.damping() != 0.0 {
        return Err(ExactError::Damped { damping: contact.damping() });
    }
    Ok(domain::exact(contact)?)
}

/// The error of a collision that has more than `limit` switches, the first of them at `onset`.
pub fn too_many(contact: &Contact, limit: usize, onset: Moment) -> ExactError {
    let (kappa, psi) = (contact.kappa(), contact.psi());
    ExactError::TooManySwitches { limit, kappa, psi, time_left: onset.time_left() }
}
