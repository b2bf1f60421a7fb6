//! The picture of a map on a grid: ε_t and the number of switches.

use stickslip_model::Reduction;
use stickslip_model::text::number;
use stickslip_plane::{Coordinates, Grid, GridAxis, Quantity, Tile};

use super::map::{self, MapAxis, MapPanel, MapValues};
use crate::canvas::svg::Svg;
use crate::error::FigureError;

/// Draws the map of `grid`.
///
/// `results` has `size.0` columns and `size.1` rows, row by row from the lower edge: all cells of
/// the grid, or fewer of a large one.
///
/// # Errors
/// [`FigureError`]: an axis of the grid shows nothing, or `results` has no values, too many, or not
/// as many as `size` says.
pub fn draw(grid: &Grid, size: (usize, usize), results: &Tile) -> Result<Svg, FigureError> {
    let cells = format!("{} × {} collisions", grid.columns.cells, grid.rows.cells);
    let title = std::iter::once(cells)
        .chain(parameters(grid).into_iter().map(|(name, value)| {
            let (symbol, unit) = name.split_once(' ').unwrap_or((name, ""));
            format!("{symbol} = {} {unit}", number(value, 6)).trim_end().to_owned()
        }))
        .collect::<Vec<_>>()
        .join(", ");
    let restitution = if grid.law.normal.is_adhesive() {
        "tangential restitution ε_t (grey: stay together)"
    } else {
        "tangential restitution ε_t"
    };
    let panel = |heading, values| panel(grid, heading, size, values);
    map::draw(
        &title,
        &[
            panel(restitution, MapValues::Restitution(&results.eps_t)),
            panel("number of switches", MapValues::Switches(&results.switch_count)),
        ],
    )
}

/// A panel with `values` in so many columns and rows over the window of `grid`.
pub fn panel<'a>(
    grid: &Grid,
    heading: &'a str,
    (columns, rows): (usize, usize),
    values: MapValues<'a>,
) -> MapPanel<'a> {
    let [horizontal, vertical] = grid.axes().map(name);
    let axis = |name, axis: GridAxis| MapAxis { name, range: (axis.range.low, axis.range.high) };
    MapPanel {
        heading,
        horizontal: axis(horizontal, grid.columns),
        vertical: axis(vertical, grid.rows),
        columns,
        rows,
        values,
        lines: Vec::new(),
        points: Vec::new(),
    }
}

/// The symbols, with units, and values of the parameters that all collisions have in common.
fn parameters(grid: &Grid) -> Vec<(&'static str, f64)> {
    match grid.coordinates {
        Coordinates::Psi { damping } => vec![("a", damping)],
        Coordinates::Ratio { reduction: Reduction { mu, alpha }, damping } => {
            vec![("μ", mu), ("α", alpha), ("a", damping)]
        }
        Coordinates::Velocities { pair } => vec![
            ("μ", pair.surface.friction),
            ("α", pair.alpha),
            ("k_t kg/s^2", pair.surface.tangential_stiffness_kg_per_s2),
            match pair.damping_constant() {
                ("damping_time_s", time) => ("A s", time),
                ("unloading_stiffness_ratio", ratio) => ("k₂/k₁", ratio),
                ("yield_velocity_m_per_s", velocity) => ("v_y m/s", velocity),
                (_, hardening) => ("hardening 1/m", hardening),
            },
        ],
    }
}

/// The name of the axis of a quantity.
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
