//! Figure 3: restitution over stiffness and impact ratio.

use serde_json::{Value, json};
use stickslip_figure::number;
use stickslip_figure::pictures::map::{self, MapPanel};
use stickslip_figure::pictures::studies::Picture;
use stickslip_plane::Quantity;
use stickslip_studies::Study;
use stickslip_studies::paper::{ALPHA, MOST_RATIO_3, MOST_STIFFNESS, MU, Reading};

use super::reproduction::Reproduction;
use super::section::ReportSection;
use super::stiffness_map::{StiffnessMap, title};
use crate::error::ReproductionError;

/// The title of the part.
pub const TITLE: &str = "Figure 3: restitution over stiffness and impact ratio";

/// Computes the part.
///
/// # Errors
/// The picture cannot be drawn.
pub fn run(reproduction: &Reproduction) -> Result<ReportSection, ReproductionError> {
    let maps = StiffnessMap::both(reproduction, MOST_RATIO_3);
    let (findings, numbers): (Vec<_>, Vec<_>) = maps.iter().map(extremes).unzip();
    let headings = maps.each_ref().map(|map| map.heading("ε_t"));
    let panels = maps.iter().zip(&headings).map(|(map, heading)| MapPanel {
        horizontal: map.axis(),
        ..map.sweep.restitution(heading)
    });
    let svg = map::draw(&title("tangential restitution"), &panels.collect::<Vec<_>>())?;
    let pictures = vec![Picture {
        name: "figure3".to_owned(),
        caption: format!(
            "ε_t without damping, μ = {}, α = {}. The axis of the first map is κ of (24), that of \
             the second one ακ, so that {} at its end is κ = {}. Colours are the same on both sides of \
             zero.",
            number(MU, 4),
            number(ALPHA, 4),
            number(MOST_STIFFNESS, 4),
            number(Reading::Axis.kappa(MOST_STIFFNESS), 4)
        ),
        svg,
    }];
    let study = Study {
        name: "figure3",
        title: TITLE,
        headlines: Vec::new(),
        findings,
        json: json!({ "mu": MU, "alpha": ALPHA, "readings": numbers }),
        tables: Vec::new(),
    };
    Ok(maps
        .iter()
        .fold(ReportSection::new(study, pictures), |section, map| map.filed(section, "figure3")))
}

/// The extreme values of a map, in a sentence and as numbers.
fn extremes(map: &StiffnessMap) -> (String, Value) {
    let StiffnessMap { reading, sweep } = map;
    let (least, below) = sweep.largest(|point| -sweep.results.eps_t[point]);
    let (most, above) = sweep.largest(|point| sweep.above_sliding(point));
    // The value on the axis of stiffness, and g_t/g_n.
    let [least_at, most_at] = [least, most].map(|point| {
        let kappa = sweep.value(Quantity::Kappa, point);
        [kappa / reading.kappa(1.0), sweep.value(Quantity::Ratio, point)]
    });
    let sentence = format!(
        "With the {}, ε_t falls to {} on this map, at {axis} = {}, g_t/g_n = {}. It exceeds that of \
         pure sliding by up to {}, at {axis} = {}, g_t/g_n = {}.",
        reading.words(),
        number(-below, 5),
        number(least_at[0], 3),
        number(least_at[1], 3),
        number(above, 5),
        number(most_at[0], 3),
        number(most_at[1], 3),
        axis = reading.axis(),
    );
    let numbers = json!({
        "reading": reading.name(),
        "least": { "eps_t": -below, "axis": least_at[0], "ratio": least_at[1] },
        "most_above_sliding": { "eps_t": above, "axis": most_at[0], "ratio": most_at[1] },
    });
    (sentence, numbers)
}
