//! What a study of convergence is about.

use stickslip_model::{Contact, InvalidParameter};

use crate::error::InvalidConvergence;
use crate::limits::MOST_STIFFNESS;
use crate::paper::{Reading, STIFFNESS};

/// The collisions of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The collisions whose errors are measured; κ is at most [`MOST_STIFFNESS`].
    pub contacts: Vec<Contact>,
}

impl Settings {
    /// The usual study: collisions with two to eight switches without damping, κ = 18 and 63, ψ =
    /// 0.1, 0.2, … 1.9.
    ///
    /// # Errors
    /// [`InvalidParameter`]: the damping is out of its range.
    pub fn usual(damping: f64) -> Result<Self, InvalidParameter> {
        let points = Reading::kappas(STIFFNESS)
            .into_iter()
            .flat_map(|kappa| (1..20).map(move |tenths| (kappa, f64::from(tenths) / 10.0)));
        let contacts = points.map(|(kappa, psi)| Contact::new(kappa, psi, damping));
        Ok(Self { contacts: contacts.collect::<Result<_, _>>()? })
    }

    /// Checks all settings.
    ///
    /// # Errors
    /// [`InvalidConvergence`]: there is no collision, or one is too stiff or of another law.
    pub fn validate(&self) -> Result<(), InvalidConvergence> {
        if self.contacts.is_empty() {
            return Err(InvalidConvergence::NoContacts);
        }
        for contact in &self.contacts {
            contact.require_paper("the convergence")?;
        }
        match self.contacts.iter().find(|contact| contact.kappa() > MOST_STIFFNESS) {
            Some(stiff) => Err(InvalidConvergence::Stiff { kappa: stiff.kappa() }),
            None => Ok(()),
        }
    }
}
