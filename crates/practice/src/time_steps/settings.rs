//! The settings of a study of time steps.

use stickslip_model::{Contact, Reduction, quantity};

use super::scheme::Scheme;

/// The impacts and time steps whose errors are measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The impacts: at most [`Self::MOST_CONTACTS`], each counted once for every start phase.
    pub contacts: Vec<Contact>,
    /// The steps, as numbers t_c/dt of steps in the undamped contact time, from
    /// [`Self::FEWEST_STEPS`] to [`Self::MOST_STEPS`], in any order.
    pub steps_per_contact: Vec<f64>,
    /// The number n of start phases, from 1 to [`Self::MOST_PHASES`]: contacts begin after the
    /// parts (k + ½)/n of a step.
    pub phases: usize,
    /// The scheme.
    pub scheme: Scheme,
    /// The numbers μ and α. Only the energy depends on them: its tangential part is (μ²/α) ψ² of
    /// its normal part.
    pub reduction: Reduction,
}

impl Default for Settings {
    /// No impacts, and 10 to 1000 steps a contact.
    fn default() -> Self {
        Self {
            contacts: Vec::new(),
            steps_per_contact: vec![10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0],
            phases: 16,
            scheme: Scheme::default(),
            reduction: Reduction::default(),
        }
    }
}

impl Settings {
    /// Fewest steps in a contact.
    pub const FEWEST_STEPS: f64 = 1.0;
    /// Most steps in a contact.
    pub const MOST_STEPS: f64 = 1e7;
    /// Most start phases.
    pub const MOST_PHASES: usize = 4096;
    /// Most contacts, of impacts times phases, for which there is memory: half a gigabyte.
    pub const MOST_CONTACTS: usize = 10_000_000;

    /// Checks all settings.
    ///
    /// # Errors
    /// [`InvalidTimeSteps`] names the first that is out of its range.
    pub fn validate(&self) -> Result<(), InvalidTimeSteps> {
        if self.contacts.is_empty() {
            return Err(InvalidTimeSteps::NoContacts);
        }
        if self.steps_per_contact.is_empty() {
            return Err(InvalidTimeSteps::NoSteps);
        }
        let range = Self::FEWEST_STEPS..=Self::MOST_STEPS;
        if let Some(&value) = self.steps_per_contact.iter().find(|steps| !range.contains(steps)) {
            return Err(InvalidTimeSteps::Steps { value });
        }
        if !(1..=Self::MOST_PHASES).contains(&self.phases) {
            return Err(InvalidTimeSteps::Phases { value: self.phases });
        }
        let (impacts, phases) = (self.contacts.len(), self.phases);
        if impacts.saturating_mul(phases) > Self::MOST_CONTACTS {
            return Err(InvalidTimeSteps::Many { impacts, phases });
        }
        let Reduction { mu, alpha } = self.reduction;
        if quantity::FRICTION.check(mu).is_err() {
            return Err(InvalidTimeSteps::Mu { value: mu });
        }
        if quantity::INERTIA.check(alpha).is_err() {
            return Err(InvalidTimeSteps::Alpha { value: alpha });
        }
        Ok(())
    }
}

/// Settings are out of range.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum InvalidTimeSteps {
    /// There is no impact.
    #[error("contacts: 0 impacts; expected at least one")]
    NoContacts,
    /// There is no step.
    #[error("steps: 0 time steps; expected at least one")]
    NoSteps,
    /// A number of steps is out of range.
    #[error(
        "steps = {value:?} is out of range; expected a number of steps in a contact from {:?} to \
         {:?}",
        Settings::FEWEST_STEPS,
        Settings::MOST_STEPS
    )]
    Steps {
        /// The number of steps in a contact.
        value: f64,
    },
    /// The number of phases is out of range.
    #[error("phases = {value} is out of range; expected 1 to {}", Settings::MOST_PHASES)]
    Phases {
        /// The number.
        value: usize,
    },
    /// There are too many contacts.
    #[error(
        "phases = {phases} with {impacts} impacts make too many contacts; expected a product of at \
         most {}",
        Settings::MOST_CONTACTS
    )]
    Many {
        /// The number of impacts.
        impacts: usize,
        /// The number of phases.
        phases: usize,
    },
    /// The coefficient of friction is out of range.
    #[error("mu = {value:?} is out of range; expected a finite number above 0")]
    Mu {
        /// The number.
        value: f64,
    },
    /// The tangential inertia is out of range.
    #[error("alpha = {value:?} is out of range; expected a number above 0, at most 1")]
    Alpha {
        /// The number.
        value: f64,
    },
}
