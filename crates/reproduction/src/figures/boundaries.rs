//! All boundaries of the switching in a large window.

use std::sync::Arc;

use serde_json::json;
use stickslip_figure::pictures::studies::Picture;
use stickslip_figure::{number, pictures as drawn};
use stickslip_model::exact;
use stickslip_plane::Range;
use stickslip_plane::atlas::{CollisionAtlas, Frame, trace};
use stickslip_plane::progress::SILENT;
use stickslip_studies::Study;

use super::reproduction::Reproduction;
use super::section::ReportSection;
use crate::error::ReproductionError;

/// The title of the part.
pub const TITLE: &str = "All boundaries of the switching";

/// The range of κ.
pub const KAPPA: Range = Range { low: 0.05, high: 100.0 };
/// The range of ψ.
pub const PSI: Range = Range { low: 0.01, high: 3.0 };

/// Computes the part.
///
/// # Errors
/// The boundaries cannot be traced.
pub fn run(_: &Reproduction) -> Result<ReportSection, ReproductionError> {
    let frame = Frame::new(KAPPA, PSI, 0.0);
    let tolerance = frame.tolerances().usual;
    let verified = Arc::new(trace(frame, tolerance, SILENT)?);

    let distance = distance_from_closed_form(&verified);
    let report = &verified.report;
    let map = &verified.regions;
    let pictures = vec![Picture {
        name: "boundaries".to_owned(),
        caption: format!(
            "Every boundary on which the switches of an undamped collision change, for κ from {} \
             to {} and ψ from {} to {}, which is enough for every μ and α. The closed form of the \
             uppermost boundary is drawn beneath it. The marks at the bottom are the stiffnesses at \
             which boundaries end as ψ vanishes.",
            number(KAPPA.low, 4),
            number(KAPPA.high, 4),
            number(PSI.low, 4),
            number(PSI.high, 4)
        ),
        svg: drawn::atlas::draw(&verified),
    }];
    let study = Study {
        name: "boundaries",
        title: TITLE,
        headlines: vec![headline(&verified)],
        findings: vec![
            summary(&verified),
            format!(
                "Above the uppermost boundary the contact only slides. It lies within {} in ψ of its \
                 closed form: ψ = {} for larger κ, and ψ = {} at κ = {}.",
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
    };
    let title = "the atlas, for stickslip locate";
    Ok(ReportSection::new(study, pictures).with_atlas("atlas.json", title, &verified))
}

fn headline(verified: &CollisionAtlas) -> String {
    let (map, report) = (&verified.regions, &verified.report);
    let wrong = match report.mismatches.len() {
        0 => format!("none of {} collisions has other switches than its region", report.tried),
        wrong => {
            format!("{wrong} of {} collisions have other switches than their region", report.tried)
        }
    };
    format!(
        "Without damping, the plane of stiffness up to κ = {} and impact ratio up to ψ = {} has {} \
         regions, each with its own switches; {wrong}.",
        number(KAPPA.high, 4),
        number(PSI.high, 4),
        map.regions().len(),
    )
}

/// What is in an atlas and how it was verified, in sentences.
pub fn summary(verified: &CollisionAtlas) -> String {
    let (map, report) = (&verified.regions, &verified.report);
    let agree = if report.agrees { "all agree with them" } else { "not all agree with them" };
    format!(
        "{} boundaries, {} vertices and {} regions were traced. Of {} collisions computed at random \
         points and beside boundaries {agree}; with 95 % confidence less than {} of the plane is \
         wrong.",
        map.curves().len(),
        map.vertices().len(),
        map.regions().len(),
        report.tried,
        number(report.share_wrong_bound, 2)
    )
}

/// The largest distance in ψ between the points of the traced uppermost boundary and its closed
/// form.
fn distance_from_closed_form(atlas: &CollisionAtlas) -> f64 {
    let curves = atlas.regions.curves().iter();
    // The label of its upper side has one phase.
    let uppermost = curves.filter(|curve| curve.sides.iter().any(|side| side.len() == 1));
    let points =
        uppermost.flat_map(|curve| &curve.nodes).map(|node| atlas.plane.parameters(&node.point));
    points.fold(0.0, |most, [kappa, psi]| f64::max(most, (psi - exact::top_boundary(kappa)).abs()))
}
