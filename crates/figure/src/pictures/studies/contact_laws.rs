//! The pictures of the study of contact laws: maps, and the forces of the standard impact.

use stickslip_model::text::number;
use stickslip_plane::Range;
use stickslip_studies::contact_laws::{ContactLaws, LawOnPlane};

use super::Picture;
use crate::canvas::svg::Svg;
use crate::error::FigureError;
use crate::pictures::collision;
use crate::pictures::map::{self, MapAxis, MapPanel, MapValues};

/// Draws the pictures of a study: for each law maps and the forces of the standard impact.
///
/// # Errors
/// [`FigureError`]: a map has too many cells.
pub fn draw(study: &ContactLaws) -> Result<Vec<Picture>, FigureError> {
    let mut pictures = Vec::new();
    for (index, law) in study.laws.iter().enumerate() {
        let name = |what: &str| format!("law_{:02}_{what}", index + 1);
        let names = law.named.names.join("`, `");
        let (collision, history) = &law.standard;
        let contact = &collision.contact;
        let damping = number(contact.damping(), 4);
        let b = number(contact.tangential_damping(), 4);
        pictures.push(Picture {
            name: name("maps"),
            caption: format!(
                "`{names}`: {}. ε_t, number of switches, and ε_t less that of the paper's law, \
                 with a = {damping}, b = {b}.",
                law.named.law.equations()
            ),
            svg: maps(study, law)?,
        });
        pictures.push(Picture {
            name: name("forces"),
            caption: format!("`{names}`: forces and velocity of the standard impact."),
            svg: collision::draw(collision, history),
        });
    }
    Ok(pictures)
}

fn maps(study: &ContactLaws, law: &LawOnPlane) -> Result<Svg, FigureError> {
    let axis = |name, range: Range| MapAxis { name, range: (range.low, range.high) };
    let panel = |heading, values| MapPanel {
        heading,
        horizontal: axis("scaled stiffness κ", study.settings.kappa),
        vertical: axis("ψ = (α/μ) g_t/g_n", study.settings.psi),
        columns: study.settings.cells,
        rows: study.settings.cells,
        values,
        lines: Vec::new(),
        points: Vec::new(),
    };
    map::draw(
        &format!("`{}`", law.named.names[0]),
        &[
            panel("tangential restitution ε_t", MapValues::Restitution(&law.eps_t)),
            panel("number of switches", MapValues::Switches(&law.switches)),
            panel("ε_t less that of the paper's law", MapValues::Restitution(&law.difference)),
        ],
    )
}
