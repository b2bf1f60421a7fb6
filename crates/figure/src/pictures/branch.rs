//! A branch of periodic orbits over a parameter, with its special orbits.

use crate::canvas::panel::Scale;
use crate::canvas::shape::Stroke;
use crate::canvas::style::{BLUE, GREEN, INK, ORANGE, PURPLE, SKY, VERMILION};
use crate::canvas::svg::Svg;
use crate::pictures::chart::{self, ChartAxis, LineChart, Mark, Series, Shape};

/// A branch as it is drawn.
#[derive(Clone, Debug)]
pub struct BranchCurve<'a> {
    /// The title of the picture.
    pub title: &'a str,
    /// The name of the parameter, and of what is drawn over it.
    pub axes: [&'a str; 2],
    /// The orbits, in the order of the branch.
    pub points: Vec<BranchPoint>,
    /// The special orbits, in the order of the branch.
    pub specials: Vec<SpecialMark<'a>>,
}

/// An orbit as a point.
#[derive(Clone, Copy, Debug)]
pub struct BranchPoint {
    /// The parameter, and what is drawn over it.
    pub at: [f64; 2],
    /// What it is.
    pub stretch: BranchStretch,
}

/// A special orbit as a point.
#[derive(Clone, Copy, Debug)]
pub struct SpecialMark<'a> {
    /// What it is called.
    pub name: &'a str,
    /// The parameter, and what is drawn over it.
    pub at: [f64; 2],
    /// The number of orbits before it.
    pub behind: usize,
}

/// Parts of a branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BranchStretch {
    /// The system follows the orbits, and returns to them.
    Stable,
    /// The system follows the orbits, and leaves them after a disturbance.
    Unstable,
    /// The system does not follow the orbits.
    Virtual,
    /// The orbits are special ones, over two parameters.
    Special,
}

const STRETCHES: [(BranchStretch, &str, Stroke); 4] = [
    (BranchStretch::Special, "", Stroke::full(BLUE, 2.0)),
    (BranchStretch::Virtual, "virtual", Stroke { colour: "#888888", width: 1.4, dashes: "2 3" }),
    (BranchStretch::Unstable, "unstable", Stroke { colour: VERMILION, width: 2.0, dashes: "7 3" }),
    (BranchStretch::Stable, "stable", Stroke::full(BLUE, 2.4)),
];
/// Places that are closer, in parts of the picture, are one.
const ONE: f64 = 1e-6;
const COLOURS: [&str; 5] = [INK, GREEN, PURPLE, ORANGE, SKY];
const SHAPES: [Shape; 4] = [Shape::Disc, Shape::Ring, Shape::Square, Shape::Cross];

/// Draws `branch`.
pub fn draw(branch: &BranchCurve<'_>) -> Svg {
    let whole = with_specials(branch);
    let mut series = Vec::new();
    for (stretch, name, stroke) in STRETCHES {
        let mut name = name.to_owned();
        for points in runs(&whole, stretch) {
            let line = Some(stroke);
            series.push(Series { name: std::mem::take(&mut name), points, line, mark: None });
        }
    }
    let axis = |place: usize| {
        let values = branch.points.iter().map(|point| point.at[place]);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        let room = if low < high { 0.03 * (high - low) } else { 1.0_f64.max(low.abs()) * 1e-3 };
        let range = if low.is_finite() { (low - room, high + room) } else { (0.0, 1.0) };
        ChartAxis { name: branch.axes[place], range, scale: Scale::Linear }
    };
    let (x, y) = (axis(0), axis(1));
    let size = [x.range.1 - x.range.0, y.range.1 - y.range.0];
    for (index, (name, points)) in marked(&branch.specials, size).into_iter().enumerate() {
        let colour = COLOURS[index % COLOURS.len()];
        let mark = Some(Mark { shape: SHAPES[index % SHAPES.len()], colour });
        series.push(Series { name, points, line: None, mark });
    }
    chart::draw(&LineChart { title: branch.title, x, y, series })
}

/// Names with the places that have them. Those of one place are one name.
fn marked(specials: &[SpecialMark<'_>], size: [f64; 2]) -> Vec<(String, Vec<(f64, f64)>)> {
    let mut places: Vec<([f64; 2], Vec<&str>)> = Vec::new();
    for SpecialMark { name, at, .. } in specials {
        let near = |place: &[f64; 2]| (0..2).all(|k| (place[k] - at[k]).abs() <= ONE * size[k]);
        match places.iter_mut().find(|(place, _)| near(place)) {
            Some((_, names)) if names.contains(name) => {}
            Some((_, names)) => names.push(name),
            None => places.push((*at, vec![name])),
        }
    }
    let mut marked: Vec<(String, Vec<(f64, f64)>)> = Vec::new();
    for ([x, y], mut names) in places {
        names.sort_unstable();
        let name = names.join(", ");
        match marked.iter_mut().find(|(known, _)| *known == name) {
            Some((_, points)) => points.push((x, y)),
            None => marked.push((name, vec![(x, y)])),
        }
    }
    marked
}

/// The orbits of a branch and the special ones among them, each as the stretch before it.
fn with_specials(branch: &BranchCurve<'_>) -> Vec<BranchPoint> {
    let mut whole: Vec<BranchPoint> = Vec::with_capacity(branch.points.len());
    let mut specials = branch.specials.iter().peekable();
    for (place, point) in branch.points.iter().enumerate() {
        while let Some(special) = specials.next_if(|it| it.behind <= place) {
            let stretch = whole.last().map_or(point.stretch, |last| last.stretch);
            whole.push(BranchPoint { at: special.at, stretch });
        }
        whole.push(*point);
    }
    whole
}

/// The pieces of a branch that are stretches of one sort. Each begins at the last point before it.
fn runs(points: &[BranchPoint], stretch: BranchStretch) -> Vec<Vec<(f64, f64)>> {
    let mut runs: Vec<Vec<(f64, f64)>> = Vec::new();
    let mut inside = false;
    for (index, point) in points.iter().enumerate() {
        let [x, y] = point.at;
        if point.stretch != stretch {
            inside = false;
            continue;
        }
        if !inside {
            let before = index.checked_sub(1).map(|before| points[before].at);
            runs.push(before.map(|[x, y]| (x, y)).into_iter().collect());
        }
        inside = true;
        if let Some(run) = runs.last_mut() {
            run.push((x, y));
        }
    }
    runs
}
