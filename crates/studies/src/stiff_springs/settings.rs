//! What a study of stiff springs is about.

use stickslip_plane::Range;

/// The stiffnesses of a study: from about 2 on all oscillations are alike, and at 10¹⁰ a collision
/// has 100 000 switches.
const STIFFNESS: Range = Range { low: 3.0, high: 1e10 };

/// The most impact ratios: as many lines can be told apart in a picture.
const MOST_PSI: usize = 4;

/// The stiffnesses and impact ratios of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Interval of the scaled stiffness κ, within 3 to 10¹⁰.
    pub kappa: Range,
    /// Reduced impact ratios ψ, each above 0 and below 2; one to four.
    pub psi: Vec<f64>,
}

/// Settings are out of range.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum InvalidStiffSprings {
    /// The interval of the stiffness is out of range.
    #[error(
        "kappa {low:?}:{high:?} is out of range; expected LO:HI with {:?} <= LO < HI <= {:?}",
        STIFFNESS.low, STIFFNESS.high
    )]
    Kappa {
        /// The lower end of the interval.
        low: f64,
        /// The upper end of the interval.
        high: f64,
    },
    /// There are too few or too many impact ratios.
    #[error("psi has {count} values; expected 1 to {MOST_PSI}")]
    PsiCount {
        /// The number of impact ratios.
        count: usize,
    },
    /// An impact ratio is out of range.
    #[error(
        "psi {psi:?} is out of range; expected numbers above 0 and below 2, from where on there is no \
         switch"
    )]
    Psi {
        /// The impact ratio.
        psi: f64,
    },
    /// An impact ratio is given twice.
    #[error("psi has {psi:?} twice; expected each value once")]
    PsiTwice {
        /// The impact ratio.
        psi: f64,
    },
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
        if !(STIFFNESS.low <= low && low < high && high <= STIFFNESS.high) {
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
