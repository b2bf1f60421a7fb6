//! What a study of contact laws is about.

use stickslip_model::presets::{self, Preset};
use stickslip_model::{Contact, Damping, InvalidValue, Law};
use stickslip_plane::Range;

use crate::limits::{MOST_CELLS, MOST_LAWS};

/// The laws of a study, and the window over which they are computed.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactLawSettings {
    /// The laws, at most 1000.
    pub laws: Vec<Named>,
    /// Interval of the scaled stiffness κ.
    pub kappa: Range,
    /// Interval of the reduced impact ratio ψ.
    pub psi: Range,
    /// Number of columns and of rows of each map, at most [`MOST_CELLS`].
    pub cells: usize,
    /// Scaled damping of the maps and of the standard impact; laws without damping have 0.
    pub damping: f64,
    /// Tangential damping b of the maps and of the standard impact.
    pub tangential_damping: f64,
    /// κ and ψ of the standard impact.
    pub standard: (f64, f64),
}

/// A law with the names under which particle codes have it.
#[derive(Clone, Debug, PartialEq)]
pub struct Named {
    /// One name or more.
    pub names: Vec<&'static str>,
    /// The law.
    pub law: Law,
    /// Whether the codes' laws have this form with tangential damping too; otherwise it is 0.
    pub tangential_damping: bool,
}

impl Default for ContactLawSettings {
    /// The laws that have names, each once; κ up to 30, ψ up to 3; damping 0.2.
    fn default() -> Self {
        Self {
            laws: distinct(),
            kappa: Range { low: 0.0, high: 30.0 },
            psi: Range { low: 0.0, high: 3.0 },
            cells: 60,
            damping: 0.2,
            tangential_damping: 0.0,
            standard: (12.0, 0.6),
        }
    }
}

/// The laws that have names, each with all of its names, in the order of the presets. A law is
/// there twice if only one of its codes has tangential damping in this form.
pub fn distinct() -> Vec<Named> {
    let mut laws: Vec<Named> = Vec::new();
    for preset in presets::ALL {
        let Preset { name, law, tangential_damping, .. } = *preset;
        let same =
            |named: &&mut Named| (named.law, named.tangential_damping) == (law, tangential_damping);
        match laws.iter_mut().find(same) {
            Some(named) => named.names.push(name),
            None => laws.push(Named { names: vec![name], law, tangential_damping }),
        }
    }
    laws
}

impl ContactLawSettings {
    /// Checks all settings.
    ///
    /// # Errors
    /// [`InvalidValue`] names the first that is out of range.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        let (count, cells) = (self.laws.len(), self.cells);
        for (name, count, most) in [("laws", count, MOST_LAWS), ("cells", cells, MOST_CELLS)] {
            if !(1..=most).contains(&count) {
                return Err(InvalidValue::new(name, count, format!("1 to {most}")));
            }
        }
        for (name, Range { low, high }) in [("kappa", self.kappa), ("psi", self.psi)] {
            let accepted = 0.0 <= low && low < high && high.is_finite();
            InvalidValue::check(name, [low, high], "LO:HI with 0 <= LO < HI", accepted)?;
        }
        for named in &self.laws {
            named.law.require_no_adhesion("the study of laws is")?;
            self.contact(named, self.standard, true)?;
        }
        Ok(())
    }

    /// The contact with a law at κ and ψ, with or without the dampings.
    pub(super) fn contact(
        &self,
        named: &Named,
        (kappa, psi): (f64, f64),
        damped: bool,
    ) -> Result<Contact, InvalidValue> {
        let damped = damped && named.law.damping != Damping::None;
        // Bodies yield from a = 1 on.
        let least = if named.law.damping == Damping::Yielding { 1.0 } else { 0.0 };
        let a = if damped { least + self.damping } else { 0.0 };
        let b = if damped && named.tangential_damping { self.tangential_damping } else { 0.0 };
        Contact::new(kappa, psi, a)?.with_law(named.law, b)
    }
}
