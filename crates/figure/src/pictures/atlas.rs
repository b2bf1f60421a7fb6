//! The picture of an atlas: boundaries by kind, and the number of switches in each region.
//!
//! Start reading in [`draw`]; then `closed_forms` (boundaries and limits that need no tracing).

mod closed_forms;

use stickslip_model::text::number;
use stickslip_plane::atlas::{BoundaryKind, CollisionAtlas, switch_count};
use stickslip_tracer::{Point, regions::Location};

use closed_forms::ClosedForms;

use crate::canvas::Legend;
use crate::canvas::panel::{Edge, Panel, Scale};
use crate::canvas::shape::Rectangle;
use crate::canvas::style::{self, TITLE};
use crate::canvas::svg::{Anchor, Svg, Words};
use crate::pictures::regions;

const WIDTH: f64 = 900.0;
const HEIGHT: f64 = 660.0;
const FRAME_AT: Rectangle = Rectangle { left: 72.0, top: 70.0, width: 810.0, height: 536.0 };
const TITLE_AT: (f64, f64) = (72.0, 22.0);
const LEGEND_AT: (f64, f64) = (72.0, 50.0);
/// From the first line of the legend to the second one.
const LINE: f64 = 18.0;
/// Width of the key of a line in the legend.
const KEY: f64 = 28.0;

/// Draws `atlas`.
///
/// The legend names the kinds of boundaries, vertices and limits that are in the picture.
pub fn draw(atlas: &CollisionAtlas) -> Svg {
    let title = title(atlas);
    let mut svg = Svg::new(WIDTH, HEIGHT, &title);
    svg.words(TITLE_AT, Words::new(&title, TITLE, Anchor::Start));
    let window = &atlas.frame();
    let (kappa, psi) = ((window.kappa.low, window.kappa.high), (window.psi.low, window.psi.high));
    let wide = kappa.1 > 10.0 * kappa.0;
    let scales = (if wide { Scale::Logarithmic } else { Scale::Linear }, Scale::Linear);
    let mut panel = Panel { frame: FRAME_AT, x: kappa, y: psi, scales };
    let closed_forms = ClosedForms::of(window, &panel);
    if !closed_forms.is_empty() {
        panel.frame.top += LINE;
        panel.frame.height -= LINE;
    }
    closed_forms.draw(&mut svg, &panel);
    closed_forms.legend(&mut svg, (LEGEND_AT.0, LEGEND_AT.1 + LINE));

    let boundaries = boundaries(atlas);
    let mut legend = Legend::new(LEGEND_AT);
    for (kind, class, text) in style::KINDS {
        let mut lines = boundaries.iter().filter(|boundary| boundary.0 == kind).peekable();
        if lines.peek().is_some() {
            legend.entry(&mut svg, KEY, text, |svg, key| {
                let y = key.top + 0.5 * key.height;
                svg.line((key.left, y), (key.right(), y), style::boundary(kind));
            });
        }
        svg.begin_group(class);
        for (_, points) in lines {
            panel.curve(&mut svg, points.iter().copied(), style::boundary(kind));
        }
        svg.end_group();
    }
    vertices(&mut svg, atlas, &panel, &mut legend);
    labels(&mut svg, atlas, &panel);
    let lines: Vec<_> = boundaries.into_iter().map(|(_, points)| points).collect();
    let parameters = |point: &Point| atlas.plane.chart().parameters(point).into();
    regions::hints(&mut svg, &panel, &atlas.regions, &lines, parameters, |region| {
        let itinerary = atlas.itinerary(region);
        let count = switch_count(itinerary);
        format!("{itinerary}: {count} {}", if count == 1 { "switch" } else { "switches" })
    });
    panel.border(&mut svg);
    for edge in [Edge::Bottom, Edge::Left] {
        panel.ticks(&mut svg, edge, true);
    }
    panel.name(&mut svg, Edge::Bottom, 38.0, "scaled stiffness κ");
    panel.name(&mut svg, Edge::Left, 52.0, "ψ = (α/μ) g_t/g_n");
    svg
}

/// The boundaries with points (κ, ψ), which are so close that straight lines between them look
/// smooth.
pub fn boundaries(atlas: &CollisionAtlas) -> Vec<(BoundaryKind, Vec<(f64, f64)>)> {
    let curves = atlas.regions.curves().iter();
    let points = |line: Vec<[f64; 2]>| line.into_iter().map(Into::into).collect();
    curves.zip(atlas.polylines()).map(|(curve, line)| (curve.margin, points(line))).collect()
}

/// The size of an atlas, and the parameters that all its collisions have in common.
fn title(atlas: &CollisionAtlas) -> String {
    let boundaries = match atlas.regions.curves().len() {
        1 => "1 boundary".to_owned(),
        count => format!("{count} boundaries"),
    };
    let regions = match atlas.regions.regions().len() {
        1 => "1 region with its number of switches".to_owned(),
        count => format!("{count} regions with their numbers of switches"),
    };
    let reduction = atlas.ratio.map(|ratio| ratio.reduction);
    let frame = atlas.frame();
    let (mu, alpha) = (reduction.map(|r| r.mu), reduction.map(|r| r.alpha));
    let parameters = [
        ("a", Some(frame.damping)),
        ("b", Some(frame.tangential_damping).filter(|damping| *damping != 0.0)),
        ("μ", mu),
        ("α", alpha),
    ];
    let parameters = parameters
        .iter()
        .filter_map(|(name, value)| value.map(|value| format!("{name} = {}", number(value, 6))));
    [boundaries, regions].into_iter().chain(parameters).collect::<Vec<_>>().join(", ")
}

/// Draws the vertices inside the window, and adds their marks to the legend.
fn vertices(svg: &mut Svg, atlas: &CollisionAtlas, panel: &Panel, legend: &mut Legend) {
    let places = atlas.regions.vertices().iter();
    let places = places
        .map(|vertex| (vertex.kind, panel.place(atlas.plane.parameters(&vertex.point).into())));
    regions::vertices(svg, &places.collect::<Vec<_>>(), legend);
}

/// Writes the number of switches into each region, or beside it.
fn labels(svg: &mut Svg, atlas: &CollisionAtlas, panel: &Panel) {
    let region = |(kappa, psi)| match atlas.regions.locate(&atlas.plane.point(kappa, psi)) {
        Location::Region(region) => Some(region),
        _ => None,
    };
    let text = |region: usize| switch_count(atlas.itinerary(region)).to_string();
    let samples = atlas.regions.regions().iter();
    let samples: Vec<_> =
        samples.map(|region| atlas.plane.chart().parameters(&region.sample).into()).collect();
    regions::labels(svg, panel, region, &samples, text);
}
