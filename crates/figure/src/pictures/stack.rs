//! The picture of a stack: small atlases at several dampings, and a line of births and deaths.

use stickslip_plane::atlas::BoundaryKind;
use stickslip_plane::stack::{DampingChange, DampingLayer, DampingStack};

use super::atlas::{KINDS, boundaries, stroke};
use crate::canvas::Legend;
use crate::canvas::number::number;
use crate::canvas::panel::{Edge, LINEAR, Panel, Scale};
use crate::canvas::shape::{Rectangle, Stroke};
use crate::canvas::style::{FRAME, RULE, SMALL, TEXT, TITLE};
use crate::canvas::svg::{Anchor, Svg, Words};

const COLUMNS: usize = 4;
const WIDTH: f64 = 1024.0;
/// The first atlas.
const FIRST: Rectangle = Rectangle { left: 72.0, top: 96.0, width: 210.0, height: 170.0 };
/// From one atlas to the next one in its row, and in its column.
const STEP: (f64, f64) = (239.0, 202.0);
const TITLE_AT: (f64, f64) = (72.0, 22.0);
const LEGEND_AT: (f64, f64) = (72.0, 50.0);
/// Width of the key of a line in the legend.
const KEY: f64 = 28.0;
/// The left end of the line of births and deaths; its rows, and the room above them.
const LINE_LEFT: f64 = 190.0;
const ROW: f64 = 24.0;
const ABOVE: f64 = 86.0;
/// The ring around a place where regions change.
const RING: (f64, Stroke) = (4.0, Stroke::full("#CC79A7", 1.6));

/// What becomes of regions: the name in data, the words in the picture, and the colour. The rows
/// tell them apart as well, and the colours are those of Okabe and Ito.
const EFFECTS: [(&str, &str, &str); 5] = [
    ("born", "a region is born", "#009E73"),
    ("splits", "a region splits", "#56B4E9"),
    ("merge", "regions merge", "#E69F00"),
    ("dies", "a region dies", "#D55E00"),
    ("", "neighbours change", "#222222"),
];

/// Draws `stack`: an atlas for each damping, with rings around the places of the changes up to the
/// next damping, and all changes over the damping. A change that is only enclosed is drawn as wide
/// as its bracket.
#[must_use]
pub fn draw(stack: &DampingStack) -> Svg {
    let title = title(stack);
    let rows = stack.layers.len().div_ceil(COLUMNS).max(1) as f64;
    let line_top = FIRST.top + STEP.1 * rows + ABOVE - (STEP.1 - FIRST.height);
    let line_height = ROW * EFFECTS.len() as f64;
    let mut svg = Svg::new(WIDTH, line_top + line_height + 50.0, &title);
    svg.words(TITLE_AT, Words::new(&title, TITLE, Anchor::Start));
    legend(&mut svg, stack);
    for (index, layer) in stack.layers.iter().enumerate() {
        let (column, row) = (index % COLUMNS, index / COLUMNS);
        let left = FIRST.left + STEP.0 * column as f64;
        let frame = Rectangle { left, top: FIRST.top + STEP.1 * row as f64, ..FIRST };
        let panel = panel(stack, frame);
        let next = stack.layers.get(index + 1).map_or(f64::INFINITY, |next| next.damping);
        atlas(&mut svg, &panel, layer);
        places(&mut svg, &panel, stack, layer.damping..next);
        panel.border(&mut svg);
        panel.ticks(&mut svg, Edge::Left, column == 0);
        panel.ticks(&mut svg, Edge::Bottom, index + COLUMNS >= stack.layers.len());
    }
    let height = STEP.1 * rows - (STEP.1 - FIRST.height);
    let middle = (FIRST.left - 48.0, FIRST.top + 0.5 * height);
    let name = Words::new("ψ = (α/μ) g_t/g_n", TEXT, Anchor::Middle);
    svg.words(middle, Words { upwards: true, ..name });
    let below = (0.5 * (FIRST.left + WIDTH), FIRST.top + height + 34.0);
    svg.words(below, Words::new("scaled stiffness κ", TEXT, Anchor::Middle));
    let width = WIDTH - LINE_LEFT - 24.0;
    line(&mut svg, stack, Rectangle { left: LINE_LEFT, top: line_top, width, height: line_height });
    svg
}

/// The numbers of dampings and of changes.
fn title(stack: &DampingStack) -> String {
    let solved = stack.changes.iter().filter(|change| change.meeting.is_some()).count();
    let enclosed = stack.changes.len() - solved;
    let changes = if enclosed == 0 {
        format!("{solved} changes of the regions between them")
    } else {
        format!(
            "{} changes of the regions between them, {enclosed} of them only enclosed",
            stack.changes.len()
        )
    };
    format!("Atlases at {} scaled dampings a, {changes}", stack.layers.len())
}

/// The kinds of boundaries in the atlases, and the ring.
fn legend(svg: &mut Svg, stack: &DampingStack) {
    let has = |kind: BoundaryKind| {
        let mut atlases = stack.layers.iter().map(|layer| &layer.atlas.atlas);
        atlases.any(|atlas| atlas.regions.curves().iter().any(|curve| curve.margin == kind))
    };
    let mut legend = Legend::new(LEGEND_AT);
    for (kind, _, text) in KINDS.into_iter().filter(|(kind, ..)| has(*kind)) {
        legend.entry(svg, KEY, text, |svg, key| {
            let y = key.top + 0.5 * key.height;
            svg.line((key.left, y), (key.right(), y), thin(kind));
        });
    }
    if stack.changes.iter().any(|change| change.meeting.is_some()) {
        let text = "place of a change up to the next a";
        legend.entry(svg, 2.0 * RING.0, text, |svg, key| {
            svg.ring((key.left + RING.0, key.top + 0.5 * key.height), RING.0, RING.1);
        });
    }
}

/// The stroke of a kind of boundary in a small atlas.
fn thin(kind: BoundaryKind) -> Stroke {
    Stroke { width: 1.1, ..stroke(kind) }
}

fn panel(stack: &DampingStack, frame: Rectangle) -> Panel {
    let [x, y] = [stack.frame.kappa, stack.frame.psi].map(|side| (side.low, side.high));
    let x_scale = if x.1 > 10.0 * x.0 { Scale::Logarithmic } else { Scale::Linear };
    Panel { frame, x, y, scales: (x_scale, Scale::Linear) }
}

/// An atlas with its damping and its number of regions.
fn atlas(svg: &mut Svg, panel: &Panel, layer: &DampingLayer) {
    let frame = panel.frame;
    let regions = layer.atlas.atlas.regions.regions().len();
    let text = format!("a = {}", number(layer.damping, 4));
    svg.words((frame.left, frame.top - 11.0), Words::new(&text, TEXT, Anchor::Start));
    let text = if regions == 1 { "1 region".to_owned() } else { format!("{regions} regions") };
    svg.words((frame.right(), frame.top - 11.0), Words::new(&text, SMALL, Anchor::End));
    svg.begin_group("atlas");
    for (kind, points) in boundaries(&layer.atlas.atlas) {
        panel.curve(svg, points, thin(kind));
    }
    svg.end_group();
}

/// Rings around the places of changes in a range of dampings.
fn places(svg: &mut Svg, panel: &Panel, stack: &DampingStack, dampings: std::ops::Range<f64>) {
    svg.begin_group("places");
    let meetings = stack.changes.iter().filter_map(|change| change.meeting.as_ref());
    for meeting in meetings.filter(|meeting| dampings.contains(&meeting.damping)) {
        svg.ring(panel.place((meeting.kappa, meeting.psi)), RING.0, RING.1);
    }
    svg.end_group();
}

/// All changes over the damping, a row for each kind of them.
fn line(svg: &mut Svg, stack: &DampingStack, frame: Rectangle) {
    let last = stack.layers.last().map_or(1.0, |layer| layer.damping);
    let panel = Panel { frame, x: (0.0, last), y: (0.0, 1.0), scales: LINEAR };
    for (row, (effect, text, colour)) in EFFECTS.into_iter().enumerate() {
        let top = frame.top + ROW * row as f64;
        let count = stack.changes.iter().filter(|change| has_effect(change, effect)).count();
        let at = (frame.left - 8.0, top + 0.5 * ROW);
        svg.words(at, Words::new(&format!("{text}: {count}"), SMALL, Anchor::End));
        if row > 0 {
            svg.line((frame.left, top), (frame.right(), top), RULE);
        }
        svg.begin_group("changes");
        for change in stack.changes.iter().filter(|change| has_effect(change, effect)) {
            let (from, to) = (top + 3.0, top + ROW - 3.0);
            if let Some(meeting) = &change.meeting {
                let (x, _) = panel.place((meeting.damping, 0.0));
                svg.line((x, from), (x, to), Stroke::full(colour, 1.6));
            } else {
                let [left, right] = change.between.map(|damping| panel.place((damping, 0.0)).0);
                let width = (right - left).max(4.0);
                let at = Rectangle { left, top: from, width, height: to - from };
                svg.outline(at, Stroke::full(colour, 1.0));
            }
        }
        svg.end_group();
    }
    svg.outline(frame, FRAME);
    panel.ticks(svg, Edge::Bottom, true);
    panel.name(svg, Edge::Bottom, 34.0, "scaled damping a");
}

/// Whether a change does this to a region; the empty name stands for changes without effects.
fn has_effect(change: &DampingChange, effect: &str) -> bool {
    change.effects.iter().any(|own| own.effect == effect)
        || (effect.is_empty() && change.effects.is_empty())
}
