//! The picture of a stack: small atlases at several dampings, and a line of births and deaths.

use stickslip_model::text::number;
use stickslip_plane::atlas::BoundaryKind;
use stickslip_plane::stack::{DampingLayer, DampingStack};
use stickslip_solver::margin::Margin;
use stickslip_tracer::{
    Names, Point, RunNames,
    hybrid::Itinerary,
    stack::{Change, Effect, Layer, Stack},
};

use super::atlas::boundaries;
use crate::canvas::Legend;
use crate::canvas::panel::{Edge, LINEAR, Panel, Scale};
use crate::canvas::shape::{Rectangle, Stroke};
use crate::canvas::style::{
    self, FRAME, GREEN, INK, KINDS, ORANGE, PLACES, PURPLE, RULE, SKY, SMALL, TEXT, TITLE,
    VERMILION,
};
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
const RING: (f64, Stroke) = (4.0, Stroke::full(PURPLE, 1.6));

/// What becomes of regions: the name in data, the words in the picture, and the colour. The rows
/// tell them apart as well, and the colours are those of Okabe and Ito.
const EFFECTS: [(&str, &str, &str); 5] = [
    ("born", "a region is born", GREEN),
    ("splits", "a region splits", SKY),
    ("merge", "regions merge", ORANGE),
    ("dies", "a region dies", VERMILION),
    ("", "neighbours change", INK),
];

/// What is drawn, whoever has traced it.
struct Drawing {
    title: String,
    /// The names of the coordinates, and of what differs between the atlases.
    axes: [String; 3],
    /// The last of these in a word.
    over: String,
    window: [(f64, f64); 2],
    scales: (Scale, Scale),
    /// The kinds of curves with their strokes.
    kinds: Vec<(&'static str, Stroke)>,
    sheets: Vec<Sheet>,
    turns: Vec<Turn>,
}

/// One atlas.
struct Sheet {
    value: f64,
    regions: usize,
    curves: Vec<(Stroke, Vec<(f64, f64)>)>,
}

/// A change between atlases.
struct Turn {
    between: [f64; 2],
    /// Where it is solved for: the value, and the place in the plane.
    meeting: Option<(f64, (f64, f64))>,
    effects: Vec<&'static str>,
}

/// Draws `stack`: an atlas for each damping, with rings around the places of the changes up to the
/// next damping, and all changes over the damping. A change that is only enclosed is drawn as wide
/// as its bracket.
pub fn draw(stack: &DampingStack) -> Svg {
    let has = |kind: BoundaryKind| {
        let mut atlases = stack.layers.iter().map(|layer| &layer.atlas);
        atlases.any(|atlas| atlas.regions.curves().iter().any(|curve| curve.margin == kind))
    };
    let kinds = KINDS.into_iter().filter(|(kind, ..)| has(*kind));
    let sheet = |layer: &DampingLayer| {
        let atlas = &layer.atlas;
        let curves = boundaries(atlas)
            .into_iter()
            .map(|(kind, points)| (thin(style::boundary(kind)), points));
        let regions = atlas.regions.regions().len();
        Sheet { value: layer.damping, regions, curves: curves.collect() }
    };
    let sheet_of_all = stack.plane.sheet();
    let turn = |change| Turn::of(change, |point| sheet_of_all.snapped(point));
    let window = sheet_of_all.sides.map(|side| (side.low, side.high));
    let x_scale = if window[0].1 > 10.0 * window[0].0 { Scale::Logarithmic } else { Scale::Linear };
    let drawing = Drawing {
        title: format!("Atlases at {} scaled dampings a", stack.layers.len()),
        axes: ["scaled stiffness κ", "ψ = (α/μ) g_t/g_n", "scaled damping a"].map(str::to_owned),
        over: "a".to_owned(),
        window,
        scales: (x_scale, Scale::Linear),
        kinds: kinds.map(|(kind, _, text)| (text, thin(style::boundary(kind)))).collect(),
        sheets: stack.layers.iter().map(sheet).collect(),
        turns: stack.changes.iter().map(turn).collect(),
    };
    drawing.draw()
}

/// The same picture of the atlases of a hybrid system over its parameter `over`.
pub fn draw_runs(stack: &Stack<Itinerary, Margin>, names: &RunNames, over: &str) -> Svg {
    let (family, axes) = (&names.family, names.axes());
    let sheet = |layer: &Layer<Itinerary, Margin>| {
        let plane = &layer.atlas.plane;
        let curves = plane.curves().iter().map(|curve| {
            let points = curve.polyline(&plane.window().extent());
            let points = points.iter().map(|point| (point.x, point.y)).collect();
            (thin(PLACES[style::place(&curve.margin)].2), points)
        });
        Sheet { value: layer.value, regions: plane.regions().len(), curves: curves.collect() }
    };
    let turn = |change| Turn::of(change, |point| (*point).into());
    let curves = || stack.layers.iter().flat_map(|layer| layer.atlas.plane.curves());
    let has = |index: usize| curves().any(|curve| style::place(&curve.margin) == index);
    let kinds = PLACES.into_iter().enumerate().filter(|(index, _)| has(*index));
    let window = stack.layers.first().map(|layer| *layer.atlas.plane.window());
    let window =
        window.map_or([(0.0, 1.0); 2], |it| [(it.low.x, it.high.x), (it.low.y, it.high.y)]);
    let drawing = Drawing {
        title: format!("{family}: atlases at {} values of {over}", stack.layers.len()),
        axes: [axes[0], axes[1], over].map(str::to_owned),
        over: over.to_owned(),
        window,
        scales: LINEAR,
        kinds: kinds.map(|(_, (_, text, stroke))| (text, thin(stroke))).collect(),
        sheets: stack.layers.iter().map(sheet).collect(),
        turns: stack.changes.iter().map(turn).collect(),
    };
    drawing.draw()
}

/// The stroke of a kind of curve in a small atlas.
fn thin(stroke: Stroke) -> Stroke {
    Stroke { width: 1.1, ..stroke }
}

impl Drawing {
    fn draw(&self) -> Svg {
        let title = self.title();
        let rows = self.sheets.len().div_ceil(COLUMNS).max(1) as f64;
        let line_top = FIRST.top + STEP.1 * rows + ABOVE - (STEP.1 - FIRST.height);
        let line_height = ROW * EFFECTS.len() as f64;
        let mut svg = Svg::new(WIDTH, line_top + line_height + 50.0, &title);
        svg.words(TITLE_AT, Words::new(&title, TITLE, Anchor::Start));
        self.legend(&mut svg);
        for (index, sheet) in self.sheets.iter().enumerate() {
            let (column, row) = (index % COLUMNS, index / COLUMNS);
            let left = FIRST.left + STEP.0 * column as f64;
            let frame = Rectangle { left, top: FIRST.top + STEP.1 * row as f64, ..FIRST };
            let [x, y] = self.window;
            let panel = Panel { frame, x, y, scales: self.scales };
            let next = self.sheets.get(index + 1).map_or(f64::INFINITY, |next| next.value);
            self.atlas(&mut svg, &panel, sheet);
            self.places(&mut svg, &panel, sheet.value..next);
            panel.border(&mut svg);
            panel.ticks(&mut svg, Edge::Left, column == 0);
            panel.ticks(&mut svg, Edge::Bottom, index + COLUMNS >= self.sheets.len());
        }
        let height = STEP.1 * rows - (STEP.1 - FIRST.height);
        let middle = (FIRST.left - 48.0, FIRST.top + 0.5 * height);
        let name = Words::new(&self.axes[1], TEXT, Anchor::Middle);
        svg.words(middle, Words { upwards: true, ..name });
        let below = (0.5 * (FIRST.left + WIDTH), FIRST.top + height + 34.0);
        svg.words(below, Words::new(&self.axes[0], TEXT, Anchor::Middle));
        let width = WIDTH - LINE_LEFT - 24.0;
        let frame = Rectangle { left: LINE_LEFT, top: line_top, width, height: line_height };
        self.line(&mut svg, frame);
        svg
    }

    /// The title with the number of changes.
    fn title(&self) -> String {
        let solved = self.turns.iter().filter(|turn| turn.meeting.is_some()).count();
        let enclosed = self.turns.len() - solved;
        let changes = if enclosed == 0 {
            format!("{solved} changes of the regions between them")
        } else {
            let all = self.turns.len();
            format!("{all} changes of the regions between them, {enclosed} of them only enclosed")
        };
        format!("{}, {changes}", self.title)
    }

    /// The kinds of boundaries in the atlases, and the ring.
    fn legend(&self, svg: &mut Svg) {
        let mut legend = Legend::new(LEGEND_AT);
        for (text, stroke) in &self.kinds {
            legend.entry(svg, KEY, text, |svg, key| {
                let y = key.top + 0.5 * key.height;
                svg.line((key.left, y), (key.right(), y), *stroke);
            });
        }
        if self.turns.iter().any(|turn| turn.meeting.is_some()) {
            let text = format!("place of a change up to the next {}", self.over);
            legend.entry(svg, 2.0 * RING.0, &text, |svg, key| {
                svg.ring((key.left + RING.0, key.top + 0.5 * key.height), RING.0, RING.1);
            });
        }
    }

    /// An atlas with its value and its number of regions.
    fn atlas(&self, svg: &mut Svg, panel: &Panel, sheet: &Sheet) {
        let frame = panel.frame;
        let text = format!("{} = {}", self.over, number(sheet.value, 4));
        svg.words((frame.left, frame.top - 11.0), Words::new(&text, TEXT, Anchor::Start));
        let text = match sheet.regions {
            1 => "1 region".to_owned(),
            regions => format!("{regions} regions"),
        };
        svg.words((frame.right(), frame.top - 11.0), Words::new(&text, SMALL, Anchor::End));
        svg.begin_group("atlas");
        for (stroke, points) in &sheet.curves {
            panel.curve(svg, points.iter().copied(), *stroke);
        }
        svg.end_group();
    }

    /// Rings around the places of changes in a range of values.
    fn places(&self, svg: &mut Svg, panel: &Panel, values: std::ops::Range<f64>) {
        svg.begin_group("places");
        let meetings = self.turns.iter().filter_map(|turn| turn.meeting);
        for (_, place) in meetings.filter(|(value, _)| values.contains(value)) {
            svg.ring(panel.place(place), RING.0, RING.1);
        }
        svg.end_group();
    }

    /// All changes over what differs between the atlases, a row for each kind of them.
    fn line(&self, svg: &mut Svg, frame: Rectangle) {
        let ends = [self.sheets.first(), self.sheets.last()];
        let [first, last] = ends.map(|sheet| sheet.map_or(1.0, |sheet| sheet.value));
        let panel = Panel { frame, x: (first.min(0.0), last), y: (0.0, 1.0), scales: LINEAR };
        for (row, (effect, text, colour)) in EFFECTS.into_iter().enumerate() {
            let top = frame.top + ROW * row as f64;
            let turns = || self.turns.iter().filter(|turn| turn.has(effect));
            let words = format!("{text}: {}", turns().count());
            let at = (frame.left - 8.0, top + 0.5 * ROW);
            svg.words(at, Words::new(&words, SMALL, Anchor::End));
            if row > 0 {
                svg.line((frame.left, top), (frame.right(), top), RULE);
            }
            svg.begin_group("changes");
            for turn in turns() {
                let (from, to) = (top + 3.0, top + ROW - 3.0);
                if let Some((value, _)) = turn.meeting {
                    let (x, _) = panel.place((value, 0.0));
                    svg.line((x, from), (x, to), Stroke::full(colour, 1.6));
                } else {
                    let [left, right] = turn.between.map(|value| panel.place((value, 0.0)).0);
                    let width = (right - left).max(4.0);
                    let at = Rectangle { left, top: from, width, height: to - from };
                    svg.outline(at, Stroke::full(colour, 1.0));
                }
            }
            svg.end_group();
        }
        svg.outline(frame, FRAME);
        panel.ticks(svg, Edge::Bottom, true);
        panel.name(svg, Edge::Bottom, 34.0, &self.axes[2]);
    }
}

impl Turn {
    /// A change of atlases with any labels; `place` converts from traced coordinates.
    fn of<Label>(change: &Change<Label>, place: impl Fn(&Point) -> [f64; 2]) -> Self {
        Self {
            between: change.between,
            meeting: change.meeting.map(|it| (it.value, place(&it.point).into())),
            effects: change.effects.iter().map(Effect::name).collect(),
        }
    }

    /// Whether the change does this to a region; the empty name stands for changes without effects.
    fn has(&self, effect: &str) -> bool {
        self.effects.contains(&effect) || (effect.is_empty() && self.effects.is_empty())
    }
}
