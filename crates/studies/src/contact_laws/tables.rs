//! The laws as a table.

use stickslip_model::{ContactEnd, Damping};

use super::ContactLaws;
use super::law::LawOnPlane;
use crate::study::{Cell, StudyColumn, StudyTable};

/// The name of the table.
pub const LAWS: &str = "contact_laws";

const COLUMNS: [StudyColumn; 10] = [
    StudyColumn::headed("names", "law", "the names under which particle codes have the law"),
    StudyColumn::headed("equations", "equations", "its equations in scaled units"),
    StudyColumn::headed("ends", "ends at", "where the contact ends"),
    StudyColumn::headed("starts", "starts in", "the first phases of the damped collisions"),
    StudyColumn::headed("parity", "switches", "the parity of the numbers of switches, damped"),
    StudyColumn::headed("spring", "spring", "what becomes of the energy in the spring"),
    StudyColumn::headed("largest", "largest |ε_t|", "the largest |ε_t| without damping"),
    StudyColumn::headed("at_kappa", "at κ", "κ of the largest |ε_t|"),
    StudyColumn::headed("at_psi", "at ψ", "ψ of the largest |ε_t|"),
    StudyColumn::headed("largest_damped", "damped", "the largest |ε_t| with damping"),
];

impl ContactLaws {
    pub(super) fn table(&self) -> StudyTable {
        let (kappa, psi, cells) = (self.settings.kappa, self.settings.psi, self.settings.cells);
        StudyTable {
            name: LAWS,
            title: format!(
                "The laws, from {cells} × {cells} collisions each with κ in {:?} … {:?} and ψ in \
                 {:?} … {:?}",
                kappa.low, kappa.high, psi.low, psi.high
            ),
            columns: COLUMNS.to_vec(),
            rows: self.laws.iter().map(row).collect(),
        }
    }
}

fn row(law: &LawOnPlane) -> Vec<Cell> {
    let terms = law.named.law;
    let (largest, [kappa, psi]) = law.undamped.largest;
    let attracts = terms.damping != Damping::None && !terms.limit_damping;
    let ends = match terms.end {
        ContactEnd::Force => "F = 0",
        ContactEnd::Overlap if attracts => "x = 0, attracting",
        ContactEnd::Overlap => "x = 0",
    };
    let names: Vec<_> = law.named.names.iter().map(|name| format!("`{name}`")).collect();
    vec![
        names.join(", ").into(),
        terms.equations().into(),
        ends.into(),
        law.damped.starts().into(),
        law.damped.parity().into(),
        law.spring().to_string().into(),
        largest.into(),
        kappa.into(),
        psi.into(),
        law.damped.largest.0.into(),
    ]
}
