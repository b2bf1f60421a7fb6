//! Figure 2: two steel spheres.

use std::sync::Arc;

use serde_json::json;
use stickslip_model::{Material, Pair, Surface};

use super::figure1::limit_line;
use super::reproduction::Reproduction;
use super::section::Section;
use super::sweep::Sweep;
use crate::error::StudyError;
use crate::paper::{MU, ratio};
use crate::study::{Picture, Study};
use stickslip_figure::canvas::style::FRAME;
use stickslip_figure::number;
use stickslip_figure::pictures::map::{self, MapPanel};
use stickslip_plane::{Coordinates, Grid, GridAxis, Quantity, Range};

/// What it is about.
pub const TITLE: &str = "Figure 2: two steel spheres";

/// Both velocities, in m/s.
const VELOCITY: Range = Range { low: 0.0, high: 200.0 };
const RADIUS_M: f64 = 0.02;
const STEEL: Material =
    Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3: 7850.0 };
const SURFACE: Surface =
    Surface { friction: MU, tangential_stiffness_kg_per_s2: 1e12, damping_time_s: 0.0 };

/// Computes it.
///
/// # Errors
/// It cannot be drawn.
pub fn run(reproduction: &Reproduction) -> Result<Section, StudyError> {
    let pair = Pair::equal_spheres(RADIUS_M, &STEEL, &SURFACE)?;
    let axis = GridAxis { range: VELOCITY, cells: reproduction.cells };
    let coordinates = Coordinates::Velocities { pair };
    let sweep = Arc::new(Sweep::new(Grid { columns: axis, rows: axis, coordinates }));
    let (file, objection) = sweep.data("figure2", "Figure 2 as arrays".to_owned());

    // κ falls with g_n, the only velocity it depends on.
    let stiffness = [0, axis.cells - 1].map(|point| sweep.value(Quantity::Kappa, point));
    let (farthest, excess) = sweep.largest(|point| sweep.excess(point).abs());
    let [normal, tangential] =
        [Quantity::Normal, Quantity::Tangential].map(|quantity| sweep.value(quantity, farthest));
    let most = sweep.most_switches();
    let reading = |value: f64| number(value, 4);

    let title = format!(
        "steel spheres, R = {} m, k_t = {} kg/s^2, μ = {}",
        reading(RADIUS_M),
        reading(SURFACE.tangential_stiffness_kg_per_s2),
        reading(MU)
    );
    let panels =
        [sweep.restitution("tangential restitution ε_t"), sweep.switches("number of switches")];
    let lines = vec![(FRAME, limit_line(VELOCITY.high))];
    let panels = panels.map(|panel| MapPanel { lines: lines.clone(), ..panel });
    let svg = map::draw(&title, &panels);
    let study = Study {
        name: "figure2",
        title: TITLE,
        findings: vec![
            format!(
                "The spring is so stiff, κ from {} at {} m/s down to {} at {} m/s, that contacts with up to {most} switches differ \
                 little from pure sliding: ε_t by {} at most on this map, at g_n = {} m/s and g_t = {} m/s.",
                reading(stiffness[0]),
                reading(axis.centre(0)),
                reading(stiffness[1]),
                reading(axis.centre(axis.cells - 1)),
                number(excess, 3),
                reading(normal),
                reading(tangential),
            ),
            format!(
                "A contact without slip has at most Mindlin's tangential stiffness, of which κ is {} at every velocity.",
                reading(pair.mindlin_kappa())
            ),
        ],
        json: json!({
            "radius_m": RADIUS_M,
            "young_modulus_pa": STEEL.young_modulus_pa,
            "poisson_ratio": STEEL.poisson_ratio,
            "density_kg_per_m3": STEEL.density_kg_per_m3,
            "tangential_stiffness_kg_per_s2": SURFACE.tangential_stiffness_kg_per_s2,
            "mu": MU,
            "kappa": stiffness,
            "most_switches": most,
            "largest_excess": {
                "abs_eps_t": excess, "normal_m_per_s": normal, "tangential_m_per_s": tangential,
            },
            "mindlin_kappa": pair.mindlin_kappa(),
        }),
        tables: Vec::new(),
        pictures: vec![Picture {
            name: "figure2",
            caption: format!(
                "ε_t and the number of switches over the impact velocities of two spheres with R = {} m, Y = {} Pa, ν = {}, \
                 {} kg/m^3, k_t = {} kg/s^2 and μ = {}, without damping. The line is g_t/g_n = 2μ/α = {}; above it there is no switch.",
                reading(RADIUS_M),
                reading(STEEL.young_modulus_pa),
                reading(STEEL.poisson_ratio),
                reading(STEEL.density_kg_per_m3),
                reading(SURFACE.tangential_stiffness_kg_per_s2),
                reading(MU),
                number(ratio(2.0), 6)
            ),
            svg: svg?,
        }],
    };
    Ok(Section { files: vec![file], objections: objection.into_iter().collect(), ..study.into() })
}
