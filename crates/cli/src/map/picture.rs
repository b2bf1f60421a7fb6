//! The picture of a map.

use std::io;

use crate::figure::map::{self, Map};
use crate::figure::{Svg, number};
use crate::map::plane::{Axis, Coordinates, Plane};
use crate::map::thumbnail::Thumbnail;

/// Draws `thumbnail`, which shows the window of `plane`.
///
/// # Errors
/// It is empty.
pub fn draw(plane: &Plane, thumbnail: &Thumbnail) -> io::Result<Svg> {
    let (rows, surfaces, damping) = match plane.coordinates {
        Coordinates::Psi { damping } => ("ψ = (α/μ) g_t/g_n", String::new(), damping),
        Coordinates::Ratio { mu, alpha, damping } => {
            let [mu, alpha] = [mu, alpha].map(|parameter| number(parameter, 6));
            ("g_t/g_n", format!(" μ = {mu}, α = {alpha},"), damping)
        }
    };
    let (damping, cells) = (number(damping, 6), (plane.columns.cells, plane.rows.cells));
    let title = format!("{} × {} collisions,{surfaces} a = {damping}", cells.0, cells.1);
    let axis = |name, axis: Axis| map::Axis { name, range: (axis.range.low, axis.range.high) };
    map::draw(&Map {
        title: &title,
        horizontal: axis("scaled stiffness κ", plane.columns),
        vertical: axis(rows, plane.rows),
        columns: thumbnail.columns,
        rows: thumbnail.rows,
        eps_t: &thumbnail.eps_t,
        switch_count: &thumbnail.switch_count,
    })
}
