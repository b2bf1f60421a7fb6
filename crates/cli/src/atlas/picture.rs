//! The picture of an atlas.

use stickslip_model::exact;
use stickslip_tracer::{Location, Point, VertexKind};

use super::boundary::Kind;
use super::frame::{Frame, scaled, traced};
use super::polyline::polyline;
use super::{Atlas, switch_count};
use crate::figure::atlas::{self, ClosedForms, Line};
use crate::figure::{Svg, number};

/// Draws `atlas`.
pub fn draw(atlas: &Atlas) -> Svg {
    let Atlas { frame, map, .. } = atlas;
    let pair = |point: &Point| <(f64, f64)>::from(scaled(point));
    let vertices = |kinds: &[VertexKind]| {
        let of_kinds = map.vertices().iter().filter(|vertex| kinds.contains(&vertex.kind));
        of_kinds.map(|vertex| pair(&vertex.point)).collect()
    };
    let turns = [VertexKind::Degenerate, VertexKind::GrazeAtEnd, VertexKind::VanishingPhase];
    let counts = (0..map.regions().len()).map(|region| switch_count(atlas.itinerary(region)));
    let (mu, alpha) = (frame.ratio.map(|ratio| ratio.mu), frame.ratio.map(|ratio| ratio.alpha));
    let parameters = [("a", Some(frame.damping)), ("μ", mu), ("α", alpha)];
    let parameters = parameters
        .iter()
        .filter_map(|(name, value)| value.map(|value| format!(", {name} = {}", number(value, 6))));
    let title: String =
        std::iter::once(format!("{} boundaries, {} regions", map.curves().len(), counts.len()))
            .chain(parameters)
            .collect();
    let picture = atlas::Atlas {
        title: &title,
        kappa: (frame.kappa.low, frame.kappa.high),
        psi: (frame.psi.low, frame.psi.high),
        boundaries: boundaries(atlas),
        crossings: vertices(&[VertexKind::Crossing]),
        stops: vertices(&turns),
        counts: counts.collect(),
        closed_forms: (frame.damping == 0.0).then(|| closed_forms(frame)),
    };
    atlas::draw(&picture, |(kappa, psi)| match map.locate(&traced([kappa, psi])) {
        Location::Region(region) => Some(region),
        _ => None,
    })
}

/// The boundaries with points (κ, ψ), dense enough for straight lines between them.
pub fn boundaries(atlas: &Atlas) -> Vec<(Line, Vec<(f64, f64)>)> {
    let extent = atlas.map.window().extent();
    let lines = atlas.map.curves().iter().map(|curve| {
        let line = match curve.margin {
            Kind::EndOfContact => Line::EndOfContact,
            Kind::StickGraze => Line::StickGraze,
            Kind::SlipGraze => Line::SlipGraze,
        };
        let points = polyline(curve, &extent).into_iter().map(Into::into).collect();
        (line, points)
    });
    lines.collect()
}

fn closed_forms(frame: &Frame) -> ClosedForms {
    /// From farther up, boundaries need not lead to their limits.
    const SMALL: f64 = 0.05;
    let limits = (1..)
        .map(|n| {
            let line = if n % 2 == 0 { Line::StickGraze } else { Line::EndOfContact };
            (line, exact::small_impact_boundary(n))
        })
        .skip_while(|(_, kappa)| *kappa < frame.kappa.low)
        .take_while(|(_, kappa)| *kappa <= frame.kappa.high)
        .filter(|_| frame.psi.low <= SMALL);
    ClosedForms { top: exact::top_boundary, limits: limits.collect() }
}
