//! The settings of a study of time steps.

use stickslip_model::spheres::quantity;
use stickslip_model::{Contact, GivenValue, InvalidValue, Reduction};

use super::stepped::Stepping;

/// The impacts and time steps whose errors are measured.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeStepSettings {
    /// The impacts: at most [`Self::MOST_CONTACTS`], each counted once for every start phase.
    pub contacts: Vec<Contact>,
    /// The steps, as numbers t_c/dt of steps in the undamped contact time, from
    /// [`Self::FEWEST_STEPS`] to [`Self::MOST_STEPS`], in any order.
    pub steps_per_contact: Vec<f64>,
    /// The number n of start phases, from 1 to [`Self::MOST_PHASES`]: contacts begin after the
    /// parts (k + ½)/n of a step.
    pub phases: usize,
    /// What a step is. The tangential part of the energy is (μ²/α) ψ² of its normal part.
    pub stepping: Stepping,
}

impl Default for TimeStepSettings {
    /// No impacts, and 10 to 1000 steps a contact.
    fn default() -> Self {
        Self {
            contacts: Vec::new(),
            steps_per_contact: vec![10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0],
            phases: 16,
            stepping: Stepping::default(),
        }
    }
}

impl TimeStepSettings {
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
    /// [`InvalidValue`] names the first that is out of its range.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        let (impacts, phases) = (self.contacts.len(), self.phases);
        if impacts == 0 {
            return Err(invalid("contacts:", "0 impacts", "at least one".to_owned()));
        }
        let steps = &self.steps_per_contact;
        if steps.is_empty() {
            return Err(invalid("steps:", "0 time steps", "at least one".to_owned()));
        }
        let range = Self::FEWEST_STEPS..=Self::MOST_STEPS;
        if let Some(&value) = steps.iter().find(|steps| !range.contains(steps)) {
            let (low, high) = (range.start(), range.end());
            let expected = format!("a number of steps in a contact from {low:?} to {high:?}");
            return Err(InvalidValue::new("steps", value, expected));
        }
        if !(1..=Self::MOST_PHASES).contains(&phases) {
            let expected = format!("1 to {}", Self::MOST_PHASES);
            return Err(InvalidValue::new("phases", phases, expected));
        }
        if impacts.saturating_mul(phases) > Self::MOST_CONTACTS {
            let most = Self::MOST_CONTACTS;
            let given = format!("= {phases} with {impacts} impacts make too many contacts");
            return Err(invalid("phases", &given, format!("a product of at most {most}")));
        }
        let Stepping { overlap, reduction: Reduction { mu, alpha }, .. } = self.stepping;
        let expected = "a number from 0 to 0.5, a part of the distance of the centres";
        InvalidValue::check("overlap", overlap, expected, (0.0..=0.5).contains(&overlap))?;
        let accepted = mu > 0.0 && quantity::FRICTION.check(mu).is_ok();
        InvalidValue::check("mu", mu, "a finite number above 0", accepted)?;
        let accepted = quantity::INERTIA.check(alpha).is_ok();
        InvalidValue::check("alpha", alpha, "a number above 0, at most 1", accepted)
    }
}

/// The error of `name`, with the words that say what is wrong.
fn invalid(name: &'static str, phrase: &str, expected: String) -> InvalidValue {
    InvalidValue::new(name, GivenValue::Phrase(phrase.into()), expected)
}
