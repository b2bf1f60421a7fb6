//! Figure 2: two steel spheres.

use std::sync::Arc;

use serde_json::json;
use stickslip_figure::number;
use stickslip_figure::pictures::map::{self, MapPanel};
use stickslip_figure::pictures::studies::Picture;
use stickslip_figure::style::FRAME;
use stickslip_model::spheres::{BodyPair, Surface};
use stickslip_plane::{Coordinates, Grid, GridAxis, Quantity, Range};
use stickslip_studies::Study;
use stickslip_studies::paper::{
    LEAST_EPS_T_2, MOST_VELOCITY_M_PER_S, MU, STEEL, STEEL_RADIUS_M, STEEL_STIFFNESS_KG_PER_S2,
    ratio,
};

use super::figure1::limit_line;
use super::reproduction::Reproduction;
use super::section::ReportSection;
use super::sweep::Sweep;
use crate::error::ReproductionError;

/// The title of the part.
pub const TITLE: &str = "Figure 2: two steel spheres";

/// The range of both velocities, in m/s.
pub const VELOCITY: Range = Range { low: 0.0, high: MOST_VELOCITY_M_PER_S };
const SURFACE: Surface = Surface {
    friction: MU,
    tangential_stiffness_kg_per_s2: STEEL_STIFFNESS_KG_PER_S2,
    damping_time_s: 0.0,
};

/// Computes the part.
///
/// # Errors
/// The picture cannot be drawn.
pub fn run(reproduction: &Reproduction) -> Result<ReportSection, ReproductionError> {
    let pair = BodyPair::equal_spheres(STEEL_RADIUS_M, &STEEL, &SURFACE)?;
    let axis = GridAxis { range: VELOCITY, cells: reproduction.cells };
    let coordinates = Coordinates::Velocities { pair };
    let sweep = Arc::new(Sweep::new(Grid::new(axis, axis, coordinates)));

    // κ falls with g_n, the only velocity on which it depends.
    let ends = [0, axis.cells - 1];
    let kappa = ends.map(|point| sweep.value(Quantity::Kappa, point));
    let (farthest, difference) = sweep.largest(|point| sweep.above_sliding(point).abs());
    let [normal, tangential] =
        [Quantity::Normal, Quantity::Tangential].map(|quantity| sweep.value(quantity, farthest));
    let least = -sweep.largest(|point| -sweep.results.eps_t[point]).1;
    let most = sweep.most_switches();
    let short = |value: f64| number(value, 4);

    let title = format!(
        "steel spheres, R = {} m, k_t = {} kg/s^2, μ = {}",
        short(STEEL_RADIUS_M),
        short(STEEL_STIFFNESS_KG_PER_S2),
        short(MU)
    );
    let panels =
        [sweep.restitution("tangential restitution ε_t"), sweep.switches("number of switches")];
    let lines = vec![(FRAME, limit_line(VELOCITY.high))];
    let panels = panels.map(|panel| MapPanel { lines: lines.clone(), ..panel });
    let svg = map::draw(&title, &panels)?;
    let pictures = vec![Picture {
        name: "figure2".to_owned(),
        caption: format!(
            "ε_t and the number of switches over the impact velocities of two spheres with R = {} \
             m, Y = {} Pa, ν = {}, {} kg/m^3, k_t = {} kg/s^2 and μ = {}, without damping. The line \
             is g_t/g_n = 2μ/α = {}; above it there is no switch.",
            short(STEEL_RADIUS_M),
            short(STEEL.young_modulus_pa),
            short(STEEL.poisson_ratio),
            short(STEEL.density_kg_per_m3),
            short(STEEL_STIFFNESS_KG_PER_S2),
            short(MU),
            number(ratio(2.0), 6)
        ),
        svg,
    }];
    let study = Study {
        name: "figure2",
        title: TITLE,
        headlines: Vec::new(),
        findings: vec![
            format!(
                "The spring is very stiff: κ is {} at {} m/s and {} at {} m/s. Contacts have up to \
                 {most} switches, but differ little from pure sliding: ε_t by {} at most on this map, \
                 at g_n = {} m/s and g_t = {} m/s.",
                short(kappa[0]),
                short(axis.centre(ends[0])),
                short(kappa[1]),
                short(axis.centre(ends[1])),
                number(difference, 3),
                short(normal),
                short(tangential),
            ),
            format!(
                "ε_t is {} at the least on this map, in its lowest rows. The axis of the paper's \
                 figure ends at {LEAST_EPS_T_2}, which needs smaller g_t than the map shows: see \
                 statement 25.",
                number(least, 3)
            ),
            format!(
                "A contact without slip has at most Mindlin's tangential stiffness. Its κ is {} at \
                 every velocity.",
                short(pair.mindlin_kappa())
            ),
        ],
        json: json!({
            "radius_m": STEEL_RADIUS_M,
            "young_modulus_pa": STEEL.young_modulus_pa,
            "poisson_ratio": STEEL.poisson_ratio,
            "density_kg_per_m3": STEEL.density_kg_per_m3,
            "tangential_stiffness_kg_per_s2": STEEL_STIFFNESS_KG_PER_S2,
            "mu": MU,
            "kappa": kappa,
            "most_switches": most,
            "least_eps_t": least,
            "largest_excess": {
                "abs_eps_t": difference,
                "normal_m_per_s": normal,
                "tangential_m_per_s": tangential,
            },
            "mindlin_kappa": pair.mindlin_kappa(),
        }),
        tables: Vec::new(),
    };
    Ok(ReportSection::new(study, pictures).with_map(
        "figure2",
        "Figure 2 as arrays".to_owned(),
        &sweep,
    ))
}
