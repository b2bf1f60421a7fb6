//! The study of contact laws: what the laws of particle codes do over the plane of stiffness and
//! impact ratio.
//!
//! Start reading here; then, in this order: `settings` (which laws, over which window), `law` (what
//! is computed of each), `findings` and `tables`.

use rayon::prelude::*;
use serde_json::json;
use stickslip_model::SpringEnergy;
use stickslip_model::text::number;
use stickslip_plane::progress::{Progress, Report};

use crate::error::StudyError;
use crate::study::Study;

mod law;
mod settings;
mod tables;

pub use crate::limits::MOST_CELLS;
pub use law::{Kinds, LawOnPlane};
pub use settings::{ContactLawSettings, Named, distinct};
pub use tables::LAWS;

/// The name of the layout of the JSON, with its version.
pub const SCHEMA: &str = "stickslip.contact-laws/1";
/// The title of the study.
pub const TITLE: &str = "Contact laws of particle codes";

/// The laws of particle codes over a window.
#[derive(Clone, Debug)]
pub struct ContactLaws {
    /// The laws and the window.
    pub settings: ContactLawSettings,
    /// What each law does, in the order of the settings.
    pub laws: Vec<LawOnPlane>,
}

/// Makes the study on the threads of the current pool. Progress counts laws.
///
/// ```
/// use stickslip_plane::progress;
/// use stickslip_studies::contact_laws::{self, ContactLawSettings};
///
/// let settings = ContactLawSettings { cells: 4, ..ContactLawSettings::default() };
/// let computed = contact_laws::run(&settings, progress::SILENT)?;
/// assert_eq!(computed.study().tables[0].rows.len(), settings.laws.len());
/// # Ok::<(), stickslip_studies::StudyError>(())
/// ```
///
/// # Errors
/// [`StudyError`]: the settings are out of range, or a collision cannot be computed.
pub fn run(settings: &ContactLawSettings, progress: Report<'_>) -> Result<ContactLaws, StudyError> {
    settings.validate()?;
    progress(Progress::Begin { steps: settings.laws.len() });
    let laws = settings.laws.par_iter().map(|named| {
        let law = LawOnPlane::new(settings, named);
        progress(Progress::Advance { steps: 1 });
        law
    });
    let laws = laws.collect::<Result<_, _>>()?;
    Ok(ContactLaws { settings: settings.clone(), laws })
}

impl ContactLaws {
    /// The study: findings, numbers and a table.
    pub fn study(&self) -> Study {
        let json = json!({
            "schema": SCHEMA,
            "window": { "kappa": self.settings.kappa, "psi": self.settings.psi },
            "cells": self.settings.cells,
            "damping": self.settings.damping,
            "tangential_damping": self.settings.tangential_damping,
            "laws": self.laws.iter().map(LawOnPlane::json).collect::<Vec<_>>(),
        });
        Study {
            name: "contact_laws",
            title: TITLE,
            headlines: Vec::new(),
            findings: self.findings(),
            json,
            tables: vec![self.table()],
        }
    }
}

impl ContactLaws {
    fn findings(&self) -> Vec<String> {
        let count = self.laws.len();
        let cells = self.settings.cells;
        let created = |spring: SpringEnergy| spring.creates();
        let creating = self.laws.iter().filter(|law| created(law.spring())).count();
        let mut findings = vec![
            format!(
                "{count} laws over {cells} × {cells} collisions each, κ from {} to {} and ψ from {} \
                 to {}, without damping and with a = {}, b = {}.",
                number(self.settings.kappa.low, 4),
                number(self.settings.kappa.high, 4),
                number(self.settings.psi.low, 4),
                number(self.settings.psi.high, 4),
                number(self.settings.damping, 4),
                number(self.settings.tangential_damping, 4),
            ),
            format!(
                "The springs of {creating} of the {count} laws can create energy: their stiffness \
                 changes with the load, and their history is not rescaled where it must be."
            ),
        ];
        let gaining: Vec<_> = self.laws.iter().filter(|law| law.undamped.gaining > 0).collect();
        for law in &gaining {
            let (eps_t, [kappa, psi]) = law.undamped.largest;
            findings.push(format!(
                "`{}` without damping: {} of {} collisions have |ε_t| above 1, at most {} at κ = {}, \
                 ψ = {}; with damping {}.",
                law.named.names[0],
                law.undamped.gaining,
                law.undamped.collisions,
                number(eps_t, 5),
                number(kappa, 4),
                number(psi, 4),
                law.damped.gaining,
            ));
        }
        if gaining.is_empty() {
            findings.push("No collision has |ε_t| above 1.".to_owned());
        }
        findings
    }
}
