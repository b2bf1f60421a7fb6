//! All boundaries of the switching in a large window.

use serde_json::json;
use stickslip_model::exact;

use super::bench::Bench;
use super::section::{DataFile, Section};
use crate::atlas::{self, Frame, make};
use crate::error::Failure;
use crate::figure::number;
use crate::range::Range;
use crate::study::{Picture, Study};

/// What it is about.
pub const TITLE: &str = "All boundaries of the switching";

const KAPPA: Range = Range { low: 0.05, high: 100.0 };
const PSI: Range = Range { low: 0.01, high: 3.0 };

/// Computes it.
///
/// # Errors
/// The boundaries cannot be traced.
pub fn run(bench: &Bench) -> Result<Section, Failure> {
    let frame = Frame { kappa: KAPPA, psi: PSI, ratio: None, damping: 0.0 };
    let [_, tolerance, _] = frame.tolerances();
    let made = make(&bench.pool, frame, tolerance)?;
    let path = bench.out.join("atlas.json");
    let bytes = made.file().map_err(|error| Failure::output(&path, error))?;

    let distance = distance_from_closed_form(&made.atlas);
    let report = &made.report;
    let map = &made.atlas.map;
    let study = Study {
        name: "boundaries",
        title: TITLE,
        findings: vec![
            made.summary(),
            format!(
                "The uppermost boundary, above which the contact only slides, lies within {} in ψ of its closed form: \
                 ψ = {} for larger κ, {} at κ = {}.",
                number(distance, 2),
                number(exact::top_boundary(KAPPA.high), 4),
                number(exact::top_boundary(KAPPA.low), 4),
                number(KAPPA.low, 4)
            ),
        ],
        json: json!({
            "boundaries": map.curves().len(),
            "vertices": map.vertices().len(),
            "regions": map.regions().len(),
            "tolerance": tolerance,
            "agrees": report.agrees,
            "tried": report.tried,
            "share_wrong_bound": report.share_wrong_bound,
            "distance_from_closed_form": distance,
        }),
        tables: Vec::new(),
        pictures: vec![Picture {
            name: "boundaries",
            caption: format!(
                "Every boundary on which the switches of an undamped collision change, for κ from {} to {} and ψ from {} to {}, \
                 which is enough for every μ and α. Beneath the uppermost boundary its closed form; below, the stiffness at which \
                 boundaries end as ψ vanishes.",
                number(KAPPA.low, 4),
                number(KAPPA.high, 4),
                number(PSI.low, 4),
                number(PSI.high, 4)
            ),
            svg: atlas::draw(&made.atlas),
        }],
    };
    let title = "the atlas, for stickslip locate".to_owned();
    Ok(Section {
        files: vec![DataFile { name: "atlas.json".to_owned(), title, bytes }],
        objections: made.objection(&path).into_iter().collect(),
        ..study.into()
    })
}

/// The largest distance in ψ between the points of the traced uppermost boundary and its closed
/// form.
fn distance_from_closed_form(atlas: &atlas::Atlas) -> f64 {
    let curves = atlas.map.curves().iter();
    // Its upper side has one phase.
    let uppermost = curves.filter(|curve| curve.sides.iter().any(|side| side.len() == 1));
    let points = uppermost.flat_map(|curve| &curve.nodes).map(|node| atlas::scaled(&node.point));
    points.fold(0.0, |most, [kappa, psi]| f64::max(most, (psi - exact::top_boundary(kappa)).abs()))
}
