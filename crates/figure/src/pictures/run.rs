//! The course of a run: components of its state against time, over its modes, with its events.

use crate::canvas::Legend;
use crate::canvas::panel::{Edge, LINEAR, Panel};
use crate::canvas::shape::Rectangle;
use crate::canvas::style::{FRAME, MODES, RULE, TANGENTIAL, TITLE};
use crate::canvas::svg::{Anchor, Svg, Words};

/// A run as it is drawn.
#[derive(Clone, Debug)]
pub struct RunPicture<'a> {
    /// The title of the picture.
    pub title: &'a str,
    /// The name of the independent variable.
    pub time: &'a str,
    /// The names of the components that are drawn, one panel for each.
    pub names: Vec<&'a str>,
    /// Times, and the components at them.
    pub curve: Vec<(f64, Vec<f64>)>,
    /// Names of modes.
    pub modes: Vec<&'a str>,
    /// Modes by their places among the names, each from a time to a time.
    pub stays: Vec<(usize, f64, f64)>,
    /// Times of events.
    pub events: Vec<f64>,
}

const WIDTH: f64 = 760.0;
const LEFT: f64 = 84.0;
const TOP: f64 = 70.0;
const GAP: f64 = 14.0;
const MARK: f64 = 8.0;
const KEY: f64 = 24.0;
/// So many events at most are marked by lines of their own.
const MOST_EVENTS: usize = 2000;

/// Draws `run`.
pub fn draw(run: &RunPicture<'_>) -> Svg {
    let height = match run.names.len() {
        0 | 1 => 320.0,
        2 => 210.0,
        _ => 150.0,
    };
    let panels = run.names.len().max(1);
    let total = TOP + panels as f64 * (height + GAP) - GAP + 52.0;
    let mut svg = Svg::new(WIDTH, total, run.title);
    svg.words((LEFT, 22.0), Words::new(run.title, TITLE, Anchor::Start));
    legend(&mut svg, run);
    for (index, name) in run.names.iter().enumerate() {
        let top = TOP + index as f64 * (height + GAP);
        let frame = Rectangle { left: LEFT, top, width: WIDTH - LEFT - 16.0, height };
        let panel = panel(&mut svg, run, index, frame);
        let is_last = index + 1 == run.names.len();
        panel.ticks(&mut svg, Edge::Left, true);
        panel.ticks(&mut svg, Edge::Bottom, is_last);
        panel.name(&mut svg, Edge::Left, 62.0, name);
        if is_last {
            panel.name(&mut svg, Edge::Bottom, 36.0, run.time);
        }
    }
    svg
}

fn panel(svg: &mut Svg, run: &RunPicture<'_>, component: usize, frame: Rectangle) -> Panel {
    let points = || run.curve.iter().map(|(s, state)| (*s, state[component]));
    let finite = points().filter(|(_, y)| y.is_finite());
    let (low, high) = finite
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (_, y)| (low.min(y), high.max(y)));
    let ends = (run.curve.first(), run.curve.last());
    let (first, last) = ends.0.zip(ends.1).map_or((0.0, 1.0), |(first, last)| (first.0, last.0));
    let panel = Panel {
        frame,
        x: widened((first, last), 0.012),
        y: widened((low, high), 0.06),
        scales: LINEAR,
    };
    svg.begin_group("modes");
    for &(mode, from, to) in &run.stays {
        let shade = MODES[mode % MODES.len()];
        if shade != MODES[0] {
            panel.span(svg, (from, to), shade);
        }
    }
    svg.end_group();
    if panel.y.0 < 0.0 && panel.y.1 > 0.0 {
        panel.horizontal(svg, 0.0, RULE);
    }
    svg.begin_group("events");
    for &event in run.events.iter().take(MOST_EVENTS) {
        let (x, _) = panel.place((event, panel.y.0));
        svg.line((x, frame.top), (x, frame.top + MARK), FRAME);
    }
    svg.end_group();
    panel.curve(svg, points(), TANGENTIAL);
    panel.border(svg);
    panel
}

/// A range with room at its ends, also if it has no length.
fn widened((low, high): (f64, f64), part: f64) -> (f64, f64) {
    if !(low.is_finite() && high.is_finite()) {
        return (0.0, 1.0);
    }
    let size = low.abs().max(high.abs());
    // What is constant but for rounding is drawn as a line in the middle.
    let least = if size == 0.0 { 1.0 } else { 1e-9 * size };
    let room = (part * (high - low)).max(least);
    (low - room, high + room)
}

fn legend(svg: &mut Svg, run: &RunPicture<'_>) {
    let mut legend = Legend::new((LEFT, 50.0));
    let mut seen: Vec<usize> = run.stays.iter().map(|(mode, ..)| *mode).collect();
    seen.sort_unstable();
    seen.dedup();
    // A single mode needs no name.
    if seen.len() > 1 {
        for &mode in seen.iter().take(MODES.len()) {
            legend.entry(svg, KEY, run.modes[mode], |svg, at| {
                svg.fill(at, MODES[mode % MODES.len()]);
                svg.outline(at, FRAME);
            });
        }
    }
    if !run.events.is_empty() {
        legend.entry(svg, 2.0, "event", |svg, at| {
            let x = at.left + 0.5 * at.width;
            svg.line((x, at.top + 2.0), (x, at.top + 2.0 + MARK), FRAME);
        });
    }
}
