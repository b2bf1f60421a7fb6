//! The picture of an atlas of any family.

use stickslip_solver::margin::Margin;
use stickslip_tracer::{
    Atlas, Names, Point, RunNames, hybrid::Itinerary, regions::Location, tracing::Unresolved,
};

use super::regions;
use crate::canvas::Legend;
use crate::canvas::panel::{Edge, LINEAR, Panel};
use crate::canvas::shape::Rectangle;
use crate::canvas::style::{self, PLACES, TEXT, TITLE};
use crate::canvas::svg::{Anchor, Svg, Words};

const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 540.0;
const FRAME_AT: Rectangle = Rectangle { left: 72.0, top: 86.0, width: 630.0, height: 400.0 };
const TITLE_AT: (f64, f64) = (72.0, 22.0);
/// The legend of curves, and that of marks below.
const LEGENDS_AT: [(f64, f64); 2] = [(72.0, 48.0), (72.0, 68.0)];
/// Width of the key of a line in the legend.
const KEY: f64 = 28.0;
/// What the picture of an atlas says in words.
#[derive(Clone, Copy)]
pub struct Captions<'a, Label, Margin> {
    /// The title.
    pub title: &'a str,
    /// The names of the two coordinates, with their units.
    pub axes: [&'a str; 2],
    /// The kinds of curves in the legend. They have the strokes of [`style::PLACES`] in this order;
    /// further kinds have the last one.
    pub kinds: &'a [&'a str],
    /// The kind of a curve on which a margin vanishes, as an index of `kinds`.
    pub kind: &'a dyn Fn(&Margin) -> usize,
    /// A short text for the regions with a label.
    pub text: &'a dyn Fn(&Label) -> String,
    /// The text that browsers show where the pointer is over such a region.
    pub hint: &'a dyn Fn(&Label) -> String,
}

/// Draws the atlas of a hybrid system, with the number of events in each region.
pub fn draw_runs(atlas: &Atlas<Itinerary, Margin>, names: &RunNames) -> Svg {
    let (curves, regions) = (atlas.plane.curves().len(), atlas.plane.regions().len());
    let (family, axes) = (&names.family, names.axes());
    let title =
        format!("{family}: {curves} boundaries, {regions} regions with their number of events");
    let text = |label: &Itinerary| names.short(label);
    let kinds = &PLACES.map(|(_, words, _)| words);
    let hint = |label: &Itinerary| match label {
        Itinerary::Fires(guards) if guards.is_empty() => "no events".to_owned(),
        label => names.text(label),
    };
    let (kind, text, hint) = (&style::place, &text, &hint);
    draw(atlas, &Captions { title: &title, axes, kinds, kind, text, hint })
}

/// Draws an atlas with the names of its boundaries and the texts of its labels.
pub fn draw_named<Label, Margin>(
    atlas: &Atlas<Label, Margin>,
    names: &impl Names<Label, Margin>,
    title: &str,
) -> Svg {
    let mut kinds: Vec<&str> = Vec::new();
    for curve in atlas.plane.curves() {
        let kind = names.kind(&curve.margin);
        if !kinds.contains(&kind) {
            kinds.push(kind);
        }
    }
    let kind = |margin: &Margin| {
        let own = names.kind(margin);
        kinds.iter().position(|it| *it == own).unwrap_or(0)
    };
    let text = |label: &Label| names.text(label);
    let (axes, kinds, text) = (names.axes(), &kinds[..], &text);
    draw(atlas, &Captions { title, axes, kinds, kind: &kind, text, hint: text })
}

/// Draws an atlas in its coordinates, with linear axes. Regions in doubt have the text `?`.
pub fn draw<Label, Margin>(
    atlas: &Atlas<Label, Margin>,
    captions: &Captions<'_, Label, Margin>,
) -> Svg {
    let mut svg = Svg::new(WIDTH, HEIGHT, captions.title);
    svg.words(TITLE_AT, Words::new(captions.title, TITLE, Anchor::Start));
    let (window, extent) = (atlas.plane.window(), atlas.plane.window().extent());
    let (x, y) = ((window.low.x, window.high.x), (window.low.y, window.high.y));
    let panel = Panel { frame: FRAME_AT, x, y, scales: LINEAR };
    let [mut legend, mut marks] = LEGENDS_AT.map(Legend::new);
    for (index, text) in captions.kinds.iter().enumerate() {
        let stroke = PLACES[index.min(PLACES.len() - 1)].2;
        let curves = atlas.plane.curves().iter();
        let mut curves = curves.filter(|curve| (captions.kind)(&curve.margin) == index).peekable();
        if curves.peek().is_some() {
            legend.entry(&mut svg, KEY, text, |svg, key| {
                let y = key.top + 0.5 * key.height;
                svg.line((key.left, y), (key.right(), y), stroke);
            });
        }
        svg.begin_group("curves");
        for curve in curves {
            let points = curve.polyline(&extent);
            panel.curve(&mut svg, points.iter().map(|point| (point.x, point.y)), stroke);
        }
        svg.end_group();
    }
    let place = |point: &Point| panel.place((point.x, point.y));
    let vertices = atlas.plane.vertices().iter();
    let vertices: Vec<_> = vertices.map(|vertex| (vertex.kind, place(&vertex.point))).collect();
    regions::vertices(&mut svg, &vertices, &mut marks);
    unresolved(&mut svg, atlas, &panel, &mut marks);
    let region = |(x, y)| match atlas.plane.locate(&Point::new(x, y)) {
        Location::Region(region) => Some(region),
        _ => None,
    };
    let words = |region: usize, of: &dyn Fn(&Label) -> String, unknown: &str| {
        let label = atlas.plane.regions()[region].label.as_ref();
        label.filter(|_| !atlas.is_doubtful(region)).map_or_else(|| unknown.to_owned(), of)
    };
    let samples = atlas.plane.regions().iter().map(|region| (region.sample.x, region.sample.y));
    let samples: Vec<_> = samples.collect();
    regions::labels(&mut svg, &panel, region, &samples, |it| words(it, captions.text, "?"));
    let lines = atlas.plane.curves().iter().map(|curve| {
        curve.polyline(&extent).iter().map(|point| (point.x, point.y)).collect::<Vec<_>>()
    });
    let value = |point: &Point| (point.x, point.y);
    let lines: Vec<_> = lines.collect();
    regions::hints(&mut svg, &panel, &atlas.plane, &lines, value, |it| {
        words(it, captions.hint, "in doubt")
    });
    panel.border(&mut svg);
    for edge in [Edge::Bottom, Edge::Left] {
        panel.ticks(&mut svg, edge, true);
    }
    panel.name(&mut svg, Edge::Bottom, 38.0, captions.axes[0]);
    panel.name(&mut svg, Edge::Left, 52.0, captions.axes[1]);
    svg
}

/// Draws a cross where something is unresolved, and adds it to the legend.
fn unresolved<Label, Margin>(
    svg: &mut Svg,
    atlas: &Atlas<Label, Margin>,
    panel: &Panel,
    legend: &mut Legend,
) {
    let cross = |svg: &mut Svg, at: (f64, f64)| {
        svg.words(at, Words::new("×", TEXT, Anchor::Middle));
    };
    let at = |what: &Unresolved<Label>| match what {
        Unresolved::Change { between: [one, other], .. } => one.lerp(other, 0.5),
        Unresolved::Stalled { vertex } => atlas.plane.vertices()[*vertex].point,
        Unresolved::NoLength { point, .. }
        | Unresolved::TooManyNodes { point }
        | Unresolved::TooManyCurves { point } => *point,
    };
    if !atlas.unresolved.is_empty() {
        legend.entry(svg, TEXT, "unresolved", |svg, key| {
            cross(svg, (key.left + 0.5 * key.width, key.top + 0.5 * key.height));
        });
    }
    for what in &atlas.unresolved {
        let point = at(what);
        cross(svg, panel.place((point.x, point.y)));
    }
}
