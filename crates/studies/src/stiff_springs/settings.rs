//! What a study of stiff springs is about.

use stickslip_plane::Range;

use crate::error::InvalidStiffSprings;
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
    /// [`InvalidStiffSprings`]: a setting is out of range.
    pub fn validate(&self) -> Result<(), InvalidStiffSprings> {
        let Range { low, high } = self.kappa;
        if !(STIFFNESSES.low <= low && low < high && high <= STIFFNESSES.high) {
            return Err(InvalidStiffSprings::Kappa { low, high });
        }
        let count = self.psi.len();
        if !(1..=MOST_PSI).contains(&count) {
            return Err(InvalidStiffSprings::PsiCount { count });
        }
        for (index, &psi) in self.psi.iter().enumerate() {
            if !(psi > 0.0 && psi < 2.0) {
                return Err(InvalidStiffSprings::Psi { psi });
            }
            if self.psi[..index].contains(&psi) {
                return Err(InvalidStiffSprings::PsiTwice { psi });
            }
        }
        Ok(())
    }
}
