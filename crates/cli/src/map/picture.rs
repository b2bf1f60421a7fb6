//! The picture of a map.

use std::io;

use crate::figure::map::{self, Map, Values};
use crate::figure::{Svg, number};
use crate::map::plane::{Axis, Coordinates, Plane, Quantity};
use crate::map::thumbnail::Thumbnail;

/// Draws `thumbnail`, which shows the window of `plane`.
///
/// # Errors
/// It is empty.
pub fn draw(plane: &Plane, thumbnail: &Thumbnail) -> io::Result<Svg> {
    let cells = format!("{} × {} collisions", plane.columns.cells, plane.rows.cells);
    let title = std::iter::once(cells)
        .chain(parameters(plane).into_iter().map(|(name, value)| {
            let (symbol, unit) = name.split_once(' ').unwrap_or((name, ""));
            format!("{symbol} = {} {unit}", number(value, 6)).trim_end().to_owned()
        }))
        .collect::<Vec<_>>()
        .join(", ");
    let panel = |heading, values| panel(plane, heading, thumbnail.size(), values);
    map::draw(
        &title,
        &[
            panel("tangential restitution ε_t", Values::Restitution(&thumbnail.eps_t)),
            panel("number of switches", Values::Switches(&thumbnail.switch_count)),
        ],
    )
}

/// `values`, given in so many columns and rows of the plane, as a panel of a picture.
pub fn panel<'a>(
    plane: &Plane,
    heading: &'a str,
    (columns, rows): (usize, usize),
    values: Values<'a>,
) -> Map<'a> {
    let [horizontal, vertical] = plane.axes().map(name);
    let axis = |name, axis: Axis| map::Axis { name, range: (axis.range.low, axis.range.high) };
    Map {
        heading,
        horizontal: axis(horizontal, plane.columns),
        vertical: axis(vertical, plane.rows),
        columns,
        rows,
        values,
        lines: Vec::new(),
        points: Vec::new(),
    }
}

/// What all collisions have in common, with symbols and units.
fn parameters(plane: &Plane) -> Vec<(&'static str, f64)> {
    match plane.coordinates {
        Coordinates::Psi { damping } => vec![("a", damping)],
        Coordinates::Ratio { mu, alpha, damping } => {
            vec![("μ", mu), ("α", alpha), ("a", damping)]
        }
        Coordinates::Velocities { pair } => vec![
            ("μ", pair.surface.friction),
            ("α", pair.alpha),
            ("k_t kg/s^2", pair.surface.tangential_stiffness_kg_per_s2),
            ("A s", pair.surface.damping_time_s),
        ],
    }
}

/// The name of an axis.
fn name(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Kappa => "scaled stiffness κ",
        Quantity::Psi => "ψ = (α/μ) g_t/g_n",
        Quantity::Ratio => "g_t/g_n",
        Quantity::Normal => "normal velocity g_n in m/s",
        Quantity::Tangential => "tangential velocity g_t in m/s",
        Quantity::Damping => "scaled damping a",
    }
}
