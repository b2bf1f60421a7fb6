//! The laws in pictures: maps, and the forces of the standard impact.

use stickslip_figure::number;
use stickslip_figure::pictures::collision;
use stickslip_figure::pictures::map::{self, MapAxis, MapPanel, Values};

use super::Laws;
use super::law::LawOnPlane;
use super::names::NAMES;
use crate::error::StudyError;
use crate::study::Picture;

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
