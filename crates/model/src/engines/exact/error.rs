//! Collisions that the exact engine refuses.

use super::trajectory::Moment;
use crate::contact::Contact;
use crate::engines::domain::{self, OutOfDomain};

/// A collision that the exact engine does not take.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ExactError {
    /// The closed form holds without damping only.
    #[error("the exact solution holds without damping; the scaled damping is {damping}")]
    Damped {
        /// The contact's scaled damping.
        damping: f64,
    },
    /// The contact is out of range.
    #[error(transparent)]
    Domain(#[from] OutOfDomain),
    /// The spring is too stiff for a list of its switches.
    #[error(
        "more than {limit} switches at kappa = {kappa}, psi = {psi}: \
         the limit is reached a scaled time {time_left} before the end of contact"
    )]
    TooManySwitches {
        /// The most switches accepted.
        limit: usize,
        /// The contact's scaled stiffness.
        kappa: f64,
        /// The contact's reduced impact ratio.
        psi: f64,
        /// Scaled time left at the first switch beyond the limit.
        time_left: f64,
    },
}

pub fn undamped(contact: &Contact) -> Result<(), ExactError> {
    if contact.damping() != 0.0 {
        return Err(ExactError::Damped { damping: contact.damping() });
    }
    Ok(domain::exact(contact)?)
}

pub fn too_many(contact: &Contact, limit: usize, onset: Moment) -> ExactError {
    let (kappa, psi) = (contact.kappa(), contact.psi());
    ExactError::TooManySwitches { limit, kappa, psi, time_left: onset.time_left() }
}
