//! What a study of convergence is about.

use stickslip_model::{Contact, GivenValue, InvalidValue};

use crate::error::StudyError;
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
    /// [`InvalidValue`]: the damping is out of its range.
    pub fn usual(damping: f64) -> Result<Self, InvalidValue> {
        let points = Reading::kappas(STIFFNESS)
            .into_iter()
            .flat_map(|kappa| (1..20).map(move |tenths| (kappa, f64::from(tenths) / 10.0)));
        let contacts = points.map(|(kappa, psi)| Contact::new(kappa, psi, damping));
        Ok(Self { contacts: contacts.collect::<Result<_, _>>()? })
    }

    /// Checks all settings.
    ///
    /// # Errors
    /// [`StudyError::Settings`]: there is no collision, or one is too stiff; [`StudyError::Law`].
    pub fn validate(&self) -> Result<(), StudyError> {
        if self.contacts.is_empty() {
            let none = GivenValue::Phrase("0 collisions".into());
            return Err(InvalidValue::new("a study of", none, "at least one").into());
        }
        for contact in &self.contacts {
            contact.require_paper("the convergence")?;
        }
        for kappa in self.contacts.iter().map(Contact::kappa) {
            if kappa > MOST_STIFFNESS {
                let expected = format!("a number above 0, at most {MOST_STIFFNESS:?}");
                return Err(InvalidValue::new("kappa", kappa, expected).into());
            }
        }
        Ok(())
    }
}
