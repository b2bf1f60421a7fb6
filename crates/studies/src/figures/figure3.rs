//! Figure 3: restitution over stiffness and impact ratio.

use std::sync::Arc;

use serde_json::{Value, json};

use super::reproduction::{MOST_STIFFNESS, Reproduction};
use super::section::{DataFile, Objection, Section};
use super::sweep::Sweep;
use crate::error::StudyError;
use crate::paper::{ALPHA, MU, REDUCTION, Reading};
use crate::study::{Picture, Study};
use stickslip_figure::number;
use stickslip_figure::pictures::map::{self, MapAxis, MapPanel};
use stickslip_plane::{Coordinates, Grid, GridAxis, Quantity, Range};

/// What it is about.
pub const TITLE: &str = "Figure 3: restitution over stiffness and impact ratio";

/// The largest g_t/g_n.
const MOST_RATIO: f64 = 3.5;

/// Computes it.
///
/// # Errors
/// It cannot be drawn.
pub fn run(reproduction: &Reproduction) -> Result<Section, StudyError> {
    let sweeps = Reading::ALL.map(|reading| sweep(reproduction, reading, MOST_RATIO));
    let (mut files, mut objections) = (Vec::new(), Vec::new());
    let (mut findings, mut numbers) = (Vec::new(), Vec::<Value>::new());
    for (reading, sweep) in Reading::ALL.into_iter().zip(&sweeps) {
        let (file, objection) = data(sweep, reading, "figure3");
        files.push(file);
        objections.extend(objection);
        let (least, below) = sweep.largest(|point| -sweep.results.eps_t[point]);
        let (most, above) = sweep.largest(|point| sweep.excess(point));
        let [least_at, most_at] = [least, most].map(|point| place(sweep, reading, point));
        findings.push(format!(
            "With the {}, ε_t falls to {} on this map, at {} = {}, g_t/g_n = {}, and exceeds that of pure sliding by up to {}, \
             at {} = {}, g_t/g_n = {}.",
            reading.words(),
            number(-below, 5),
            reading.axis(),
            number(least_at[0], 3),
            number(least_at[1], 3),
            number(above, 5),
            reading.axis(),
            number(most_at[0], 3),
            number(most_at[1], 3),
        ));
        numbers.push(json!({
            "reading": reading.name(),
            "least": { "eps_t": -below, "axis": least_at[0], "ratio": least_at[1] },
            "most_above_sliding": { "eps_t": above, "axis": most_at[0], "ratio": most_at[1] },
        }));
    }
    let headings = Reading::ALL.map(|reading| format!("ε_t, {}", reading.words()));
    let panels = Reading::ALL.into_iter().zip(sweeps.iter().zip(&headings));
    let panels: Vec<MapPanel<'_>> = panels
        .map(|(reading, (sweep, heading))| MapPanel {
            horizontal: axis(reading),
            ..sweep.restitution(heading)
        })
        .collect();
    let svg = map::draw(&title("tangential restitution"), &panels);
    let study = Study {
        name: "figure3",
        title: TITLE,
        findings,
        json: json!({ "mu": MU, "alpha": ALPHA, "readings": numbers }),
        tables: Vec::new(),
        pictures: vec![Picture {
            name: "figure3",
            caption: format!(
                "ε_t without damping, μ = {}, α = {}. To the left the axis is κ of (24), to the right it is ακ, so that {} at its \
                 end is κ = {}. Colours are the same on both sides of zero.",
                number(MU, 4),
                number(ALPHA, 4),
                number(MOST_STIFFNESS, 4),
                number(Reading::Axis.kappa(MOST_STIFFNESS), 4)
            ),
            svg: svg?,
        }],
    };
    Ok(Section { files, objections, ..study.into() })
}

/// The collisions of a reading up to an impact ratio.
pub fn sweep(reproduction: &Reproduction, reading: Reading, most_ratio: f64) -> Arc<Sweep> {
    let axis = |high| GridAxis { range: Range { low: 0.0, high }, cells: reproduction.cells };
    Arc::new(Sweep::new(Grid {
        columns: axis(reading.kappa(MOST_STIFFNESS)),
        rows: axis(most_ratio),
        coordinates: Coordinates::Ratio { reduction: REDUCTION, damping: 0.0 },
    }))
}

/// The file of a reading of a figure, and what speaks against it.
pub fn data(sweep: &Arc<Sweep>, reading: Reading, figure: &str) -> (DataFile, Option<Objection>) {
    let name = format!("{figure}_{}", reading.name());
    let title = format!("κ, ψ, g_t/g_n, ε_t and switches as arrays, {}", reading.words());
    sweep.data(&name, title)
}

/// The axis of stiffness as the figures have it.
pub fn axis(reading: Reading) -> MapAxis<'static> {
    MapAxis { name: reading.axis(), range: (0.0, MOST_STIFFNESS) }
}

/// A title with what all collisions have in common.
pub fn title(what: &str) -> String {
    format!("{what}, μ = {}, α = {}, a = 0", number(MU, 4), number(ALPHA, 4))
}

/// Where a point is: the value on the axis of stiffness, and g_t/g_n.
fn place(sweep: &Sweep, reading: Reading, point: usize) -> [f64; 2] {
    let kappa = sweep.value(Quantity::Kappa, point);
    [kappa / reading.kappa(1.0), sweep.value(Quantity::Ratio, point)]
}
