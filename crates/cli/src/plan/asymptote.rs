//! What `asymptote` is to do.

use std::path::{Path, PathBuf};

use crate::args::AsymptoteArguments;
use crate::error::Failure;
use crate::range::Range;

/// The stiffnesses of a study: from about 2 on all oscillations are alike, and at 10¹⁰ a collision
/// has 100 000 switches.
const STIFFNESS: Range = Range { low: 3.0, high: 1e10 };

/// Most impact ratios: lines of a picture that can be told apart.
const MOST_PSI: usize = 4;

/// A study of the limit of stiff springs.
#[derive(Clone, Debug, PartialEq)]
pub struct AsymptotePlan {
    /// Interval of the scaled stiffness.
    pub kappa: Range,
    /// Reduced impact ratios, each above 0 and below 2.
    pub psi: Vec<f64>,
    /// The directory of its files.
    pub out: PathBuf,
    /// Number of threads; `None` is one for each core.
    pub threads: Option<usize>,
}

impl AsymptotePlan {
    /// The usual study.
    pub fn usual(out: &Path) -> Self {
        let kappa = Range { low: 10.0, high: 1e8 };
        Self { kappa, psi: vec![0.3, 1.0, 1.7], out: out.to_owned(), threads: None }
    }

    /// The plan that `arguments` make.
    ///
    /// # Errors
    /// [`Failure::Usage`] says which value is out of its range.
    pub fn new(arguments: &AsymptoteArguments) -> Result<Self, Failure> {
        let AsymptoteArguments { kappa, psi, out, threads } = arguments;
        if kappa.low < STIFFNESS.low || kappa.high > STIFFNESS.high {
            return Err(Failure::Usage(format!(
                "--kappa {:?}:{:?} is out of range; expected LO:HI with {:?} <= LO < HI <= {:?}",
                kappa.low, kappa.high, STIFFNESS.low, STIFFNESS.high
            )));
        }
        if psi.len() > MOST_PSI {
            return Err(Failure::Usage(format!(
                "--psi has {} values; expected at most {MOST_PSI}",
                psi.len()
            )));
        }
        if let Some(psi) = psi.iter().find(|psi| **psi >= 2.0) {
            return Err(Failure::Usage(format!(
                "--psi {psi:?} is out of range; expected numbers above 0 and below 2, from where \
                 on there is no switch"
            )));
        }
        if let Some((_, psi)) = psi.iter().enumerate().find(|(i, value)| psi[..*i].contains(value))
        {
            return Err(Failure::Usage(format!(
                "--psi has {psi:?} twice; expected each value once"
            )));
        }
        Ok(Self {
            kappa: *kappa,
            psi: psi.clone(),
            out: out.clone(),
            threads: threads.map(usize::from),
        })
    }
}
