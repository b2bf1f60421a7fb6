//! Figure 1: pure Coulomb sliding.

use serde_json::json;
use stickslip_figure::number;
use stickslip_figure::pictures::map::{self, MapAxis, MapPanel, MapValues};
use stickslip_figure::pictures::studies::Picture;
use stickslip_figure::style::FRAME;
use stickslip_model::limits::coulomb;
use stickslip_plane::{GridAxis, Range};
use stickslip_studies::paper::{ALPHA, MU, psi, ratio};
use stickslip_studies::{Cell, Study, StudyColumn, StudyTable};

use super::reproduction::Reproduction;
use super::section::ReportSection;
use crate::error::ReproductionError;

/// The title of the part.
pub const TITLE: &str = "Figure 1: pure Coulomb sliding";

/// The range of both velocities, in m/s.
const VELOCITY: Range = Range { low: 0.0, high: 2.0 };
/// The largest number of velocities along an axis.
const MOST_CELLS: usize = 200;

const COLUMNS: [StudyColumn; 3] = [
    StudyColumn::new("normal_m_per_s", "g_n in m/s"),
    StudyColumn::new("tangential_m_per_s", "g_t in m/s"),
    StudyColumn::new("eps_t", "ε_t"),
];

/// Computes the part.
///
/// # Errors
/// The picture cannot be drawn.
pub fn run(reproduction: &Reproduction) -> Result<ReportSection, ReproductionError> {
    let axis = GridAxis { range: VELOCITY, cells: reproduction.cells.min(MOST_CELLS) };
    let velocities: Vec<f64> = (0..axis.cells).map(|index| axis.centre(index)).collect();
    let points = velocities.iter().flat_map(|tangential| {
        velocities.iter().map(move |normal| {
            [*normal, *tangential, coulomb::restitution(psi(tangential / normal), 1.0)]
        })
    });
    let points: Vec<[f64; 3]> = points.collect();
    let eps_t: Vec<f64> = points.iter().map(|point| point[2]).collect();
    let resting = eps_t.iter().filter(|eps_t| **eps_t == 0.0).count();
    let share = resting as f64 / eps_t.len() as f64;
    let limit = ratio(2.0);

    let title = format!("pure Coulomb sliding, μ = {}, α = {}", number(MU, 4), number(ALPHA, 4));
    let axis_named = |name| MapAxis { name, range: (0.0, VELOCITY.high) };
    let panel = MapPanel {
        heading: "tangential restitution ε_t",
        horizontal: axis_named("normal velocity g_n in m/s"),
        vertical: axis_named("tangential velocity g_t in m/s"),
        columns: axis.cells,
        rows: axis.cells,
        values: MapValues::Restitution(&eps_t),
        lines: vec![(FRAME, limit_line(VELOCITY.high))],
        points: Vec::new(),
    };
    let svg = map::draw(&title, &[panel])?;
    let pictures = vec![Picture {
        name: "figure1".to_owned(),
        caption: format!(
            "ε_t^C = max(0, 1 − (1 + ε_n)(μ/α) g_n/g_t) of (15) and (16) with ε_n = 1, over the \
             normal and the tangential impact velocity. Below the line, g_t/g_n = {}, ε_t^C is 0.",
            number(limit, 6)
        ),
        svg,
    }];
    let study = Study {
        name: "figure1",
        title: TITLE,
        headlines: Vec::new(),
        findings: vec![format!(
            "Sliding comes to rest, ε_t = 0, in all collisions with g_t/g_n up to 2μ/α = {}. These are \
             {} % of this plane. ε_t of pure sliding is never negative.",
            number(limit, 6),
            number(100.0 * share, 3)
        )],
        json: json!({ "mu": MU, "alpha": ALPHA, "limit_ratio": limit, "share_at_rest": share }),
        tables: vec![StudyTable {
            name: "figure1",
            title: "ε_t of pure Coulomb sliding at the centres of the cells".to_owned(),
            columns: COLUMNS.to_vec(),
            rows: points.iter().map(|point| point.map(Cell::Number).to_vec()).collect(),
        }],
    };
    Ok(ReportSection::new(study, pictures))
}

/// The line up to which sliding comes to rest, g_t/g_n = 2μ/α, in a plane of velocities up to
/// `most`.
pub fn limit_line(most: f64) -> Vec<(f64, f64)> {
    vec![(0.0, 0.0), (most, ratio(2.0) * most)]
}
