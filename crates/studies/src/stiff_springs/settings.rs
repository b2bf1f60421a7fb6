//! What a study of stiff springs is about.

use stickslip_model::{GivenValue, InvalidValue};
use stickslip_plane::Range;

use crate::limits::{MOST_PSI, STIFFNESSES};

/// The stiffnesses and impact ratios of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Interval of the scaled stiffness κ, within 3 to 10¹⁰.
    pub kappa: Range,
    /// Reduced impact ratios ψ, each above 0 and below 2; one to four.
    pub psi: Vec<f64>,
}

impl Default for Settings {
    /// κ from 10 to 10⁸, ψ = 0.3, 1 and 1.7.
    fn default() -> Self {
        Self { kappa: Range { low: 10.0, high: 1e8 }, psi: vec![0.3, 1.0, 1.7] }
    }
}

impl Settings {
    /// Checks all settings.
    ///
    /// # Errors
    /// [`InvalidValue`] names the first that is out of range.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        let Range { low, high } = self.kappa;
        let (least, most) = (STIFFNESSES.low, STIFFNESSES.high);
        if !(least <= low && low < high && high <= most) {
            let expected = format!("LO:HI with {least:?} <= LO < HI <= {most:?}");
            return Err(InvalidValue::new("kappa", [low, high], expected));
        }
        let count = self.psi.len();
        if !(1..=MOST_PSI).contains(&count) {
            let given = GivenValue::Phrase(format!("has {count} values").into());
            return Err(InvalidValue::new("psi", given, format!("1 to {MOST_PSI}")));
        }
        for (index, &psi) in self.psi.iter().enumerate() {
            let (phrase, expected) = if !(psi > 0.0 && psi < 2.0) {
                let expected = "numbers above 0 and below 2, from where on there is no switch";
                (format!("{psi:?} is out of range"), expected)
            } else if self.psi[..index].contains(&psi) {
                (format!("has {psi:?} twice"), "each value once")
            } else {
                continue;
            };
            return Err(InvalidValue::new("psi", GivenValue::Phrase(phrase.into()), expected));
        }
        Ok(())
    }
}
