//! The laws in pictures: maps, and the forces of the standard impact.

use stickslip_figure::number;
use stickslip_figure::pictures::collision;
use stickslip_figure::pictures::map::{self, MapAxis, MapPanel, Values};

use super::Laws;
use super::law::LawOnPlane;
use crate::error::StudyError;
use crate::study::Picture;

/// The names of the pictures of each law: maps, and forces.
pub const NAMES: [[&str; 2]; 24] = [
    ["law_01_maps", "law_01_forces"],
    ["law_02_maps", "law_02_forces"],
    ["law_03_maps", "law_03_forces"],
    ["law_04_maps", "law_04_forces"],
    ["law_05_maps", "law_05_forces"],
    ["law_06_maps", "law_06_forces"],
    ["law_07_maps", "law_07_forces"],
    ["law_08_maps", "law_08_forces"],
    ["law_09_maps", "law_09_forces"],
    ["law_10_maps", "law_10_forces"],
    ["law_11_maps", "law_11_forces"],
    ["law_12_maps", "law_12_forces"],
    ["law_13_maps", "law_13_forces"],
    ["law_14_maps", "law_14_forces"],
    ["law_15_maps", "law_15_forces"],
    ["law_16_maps", "law_16_forces"],
    ["law_17_maps", "law_17_forces"],
    ["law_18_maps", "law_18_forces"],
    ["law_19_maps", "law_19_forces"],
    ["law_20_maps", "law_20_forces"],
    ["law_21_maps", "law_21_forces"],
    ["law_22_maps", "law_22_forces"],
    ["law_23_maps", "law_23_forces"],
    ["law_24_maps", "law_24_forces"],
];

impl Laws<'_> {
    pub(super) fn pictures(&self) -> Result<Vec<Picture>, StudyError> {
        let mut pictures = Vec::new();
        for (law, [maps, forces]) in self.laws.iter().zip(NAMES) {
            let names = law.named.names.join("`, `");
            let (collision, history) = &law.standard;
            let contact = &collision.contact;
            let damping = number(contact.damping(), 4);
            let b = number(contact.tangential_damping(), 4);
            pictures.push(Picture {
                name: maps,
                caption: format!(
                    "`{names}`: {}. ε_t, number of switches, and ε_t less that of the paper's law, \
                     with a = {damping}, b = {b}.",
                    law.named.law.equations()
                ),
                svg: self.maps(law)?,
            });
            pictures.push(Picture {
                name: forces,
                caption: format!("`{names}`: forces and velocity of the standard impact."),
                svg: collision::draw(collision, history),
            });
        }
        Ok(pictures)
    }

    fn maps(&self, law: &LawOnPlane) -> Result<stickslip_figure::Svg, StudyError> {
        let axis =
            |name, range: stickslip_plane::Range| MapAxis { name, range: (range.low, range.high) };
        let panel = |heading, values| MapPanel {
            heading,
            horizontal: axis("scaled stiffness κ", self.settings.kappa),
            vertical: axis("ψ = (α/μ) g_t/g_n", self.settings.psi),
            columns: self.settings.cells,
            rows: self.settings.cells,
            values,
            lines: Vec::new(),
            points: Vec::new(),
        };
        Ok(map::draw(
            &format!("`{}`", law.named.names[0]),
            &[
                panel("tangential restitution ε_t", Values::Restitution(&law.eps_t)),
                panel("number of switches", Values::Switches(&law.switches)),
                panel("ε_t less that of the paper's law", Values::Restitution(&law.difference)),
            ],
        )?)
    }
}
