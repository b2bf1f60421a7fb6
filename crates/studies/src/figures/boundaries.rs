//! All boundaries of the switching in a large window.

use serde_json::json;
use std::sync::Arc;

use stickslip_figure::{number, pictures};
use stickslip_model::exact;
use stickslip_plane::Range;
use stickslip_plane::atlas::{Atlas, Frame, scaled, trace};
use stickslip_plane::progress::SILENT;

use super::reproduction::{Reproduction, summary};
use super::section::{DataFile, Section};
use crate::error::StudyError;
use crate::study::{Picture, Study};

/// What it is about.
pub const TITLE: &str = "All boundaries of the switching";

const KAPPA: Range = Range { low: 0.05, high: 100.0 };
const PSI: Range = Range { low: 0.01, high: 3.0 };

/// Computes it.
///
/// # Errors
/// The boundaries cannot be traced.
pub fn run(_: &Reproduction) -> Result<Section, StudyError> {
    let frame = Frame { kappa: KAPPA, psi: PSI, ratio: None, damping: 0.0 };
    let tolerance = frame.tolerances().usual;
    let made = Arc::new(trace(frame, tolerance, SILENT)?);

    let distance = distance_from_closed_form(&made.atlas);
    let report = &made.report;
    let map = &made.atlas.regions;
    let study = Study {
        name: "boundaries",
        title: TITLE,
        findings: vec![
            summary(&made),
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
            svg: pictures::atlas::draw(&made.atlas),
        }],
    };
    let (file, objection) = DataFile::atlas("atlas.json", "the atlas, for stickslip locate", &made);
    Ok(Section { files: vec![file], objections: objection.into_iter().collect(), ..study.into() })
}

/// The largest distance in ψ between the points of the traced uppermost boundary and its closed
/// form.
fn distance_from_closed_form(atlas: &Atlas) -> f64 {
    let curves = atlas.regions.curves().iter();
    // Its upper side has one phase.
    let uppermost = curves.filter(|curve| curve.sides.iter().any(|side| side.len() == 1));
    let points = uppermost.flat_map(|curve| &curve.nodes).map(|node| scaled(&node.point));
    points.fold(0.0, |most, [kappa, psi]| f64::max(most, (psi - exact::top_boundary(kappa)).abs()))
}
