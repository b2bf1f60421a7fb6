//! A branch of periodic orbits over a parameter, with its special orbits.

use crate::canvas::panel::Scale;
use crate::canvas::shape::Stroke;
use crate::canvas::style::{BLUE, GREEN, INK, ORANGE, PURPLE, SKY, VERMILION};
use crate::canvas::svg::Svg;
use crate::pictures::chart::{self, Chart, ChartAxis, Mark, Series, Shape};

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
    pub specials: Vec<SpecialPoint<'a>>,
}

/// An orbit as a point.
#[derive(Clone, Copy, Debug)]
pub struct BranchPoint {
    /// The parameter, and what is drawn over it.
    pub at: [f64; 2],
    /// What it is.
    pub stretch: Stretch,
}

/// A special orbit as a point.
#[derive(Clone, Copy, Debug)]
pub struct SpecialPoint<'a> {
    /// What it is called.
    pub name: &'a str,
    /// The parameter, and what is drawn over it.
    pub at: [f64; 2],
    /// The number of orbits before it.
    pub behind: usize,
}

/// Parts of a branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stretch {
    /// The system follows the orbits, and returns to them.
    Stable,
    /// The system follows the orbits, and leaves them after a disturbance.
    Unstable,
    /// The system does not follow the orbits.
    Virtual,
    /// The orbits are special ones, over two parameters.
    Special,
}

const STRETCHES: [(Stretch, &str, Stroke); 4] = [
    (Stretch::Special, "", Stroke::full(BLUE, 2.0)),
    (Stretch::Virtual, "virtual", Stroke { colour: "#888888", width: 1.4, dashes: "2 3" }),
    (Stretch::Unstable, "unstable", Stroke { colour: VERMILION, width: 2.0, dashes: "7 3" }),
    (Stretch::Stable, "stable", Stroke::full(BLUE, 2.4)),
];
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
    let mut kinds: Vec<&str> = Vec::new();
    for special in &branch.specials {
        if !kinds.contains(&special.name) {
            kinds.push(special.name);
        }
    }
    for (index, kind) in kinds.into_iter().enumerate() {
        let own = branch.specials.iter().filter(|it| it.name == kind);
        let colour = COLOURS[index % COLOURS.len()];
        series.push(Series {
            name: kind.to_owned(),
            points: own.map(|it| (it.at[0], it.at[1])).collect(),
            line: None,
            mark: Some(Mark { shape: SHAPES[index % SHAPES.len()], colour }),
        });
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
    chart::draw(&Chart { title: branch.title, x: axis(0), y: axis(1), series })
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
fn runs(points: &[BranchPoint], stretch: Stretch) -> Vec<Vec<(f64, f64)>> {
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
