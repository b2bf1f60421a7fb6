//! A bent chessboard: the field of a point has the integer parts of two functions as its numbers.
//!
//! With n fields along a side, u = n (x + sin(3y + 1)/10) and v = n (y + cos(4x)/10) on the unit
//! square. Boundaries are the lines on which u or v is an integer. Two lines of one kind never
//! meet, and two of different kinds cross once at most.

use std::convert::Infallible;
use std::error::Error;
use std::f64::consts::{FRAC_PI_2, PI};

use stickslip::tracer::{
    Atlas, AtlasOptions, Family, FreeRun, Point, TraceOptions, Window, regions::Location,
};

use crate::{Row, timed};

/// The numbers of fields along a side that are traced.
pub const SIDES: [u32; 7] = [5, 8, 12, 17, 24, 34, 49];

const WINDOW: Window = Window { low: Point::new(0.0, 0.0), high: Point::new(1.0, 1.0) };

/// u and v without the factor n.
fn bent(point: &Point) -> [f64; 2] {
    [point.x + 0.1 * (3.0 * point.y + 1.0).sin(), point.y + 0.1 * (4.0 * point.x).cos()]
}

struct Chessboard {
    side: f64,
}

/// Which of the two functions, and the integer that it has on the line.
type Line = (usize, i64);

impl Chessboard {
    fn value(&self, point: &Point, (axis, level): Line) -> f64 {
        self.side * bent(point)[axis] - level as f64
    }
}

impl Family for Chessboard {
    type Label = [i64; 2];
    type Margin = Line;
    type Error = Infallible;

    #[expect(clippy::cast_possible_truncation, reason = "fields have small numbers")]
    fn label(&self, point: &Point) -> Result<[i64; 2], Infallible> {
        Ok(bent(point).map(|value| (self.side * value).floor() as i64))
    }

    fn margin(&self, point: &Point, line: &Line) -> Result<Option<f64>, Infallible> {
        Ok(Some(self.value(point, *line)))
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<[i64; 2], Line>, Infallible> {
        let label = self.label(point)?;
        let lines =
            [0, 1].into_iter().flat_map(|axis| [0, 1].map(|beyond| (axis, label[axis] + beyond)));
        let margins = lines.map(|line| (line, self.value(point, line))).collect();
        Ok(FreeRun { label, margins })
    }
}

/// What an atlas must have.
#[derive(Debug, PartialEq)]
pub struct Counts {
    pub curves: usize,
    pub regions: usize,
}

/// The numbers of curves and regions of a chessboard. Every line is cut into as many curves as it
/// crosses others, and one more; by Euler's formula there is a region for each line and for each
/// crossing, and one more.
pub fn counts(side: u32) -> Counts {
    let side = f64::from(side);
    // Places between which u and v are monotone along the edges.
    let heights = [0.0, (FRAC_PI_2 - 1.0) / 3.0, 1.0];
    let widths = [0.0, PI / 4.0, 1.0];
    let mut ends = 0.0;
    for edge in [0.0, 1.0] {
        let along_y = |y: &f64| bent(&Point::new(edge, *y));
        let along_x = |x: &f64| bent(&Point::new(*x, edge));
        let monotone = [
            (0, [along_y(&heights[0]), along_y(&heights[1])]),
            (0, [along_y(&heights[1]), along_y(&heights[2])]),
            (0, [along_x(&0.0), along_x(&1.0)]),
            (1, [along_x(&widths[0]), along_x(&widths[1])]),
            (1, [along_x(&widths[1]), along_x(&widths[2])]),
            (1, [along_y(&0.0), along_y(&1.0)]),
        ];
        for (axis, [from, to]) in monotone {
            ends += ((side * from[axis]).floor() - (side * to[axis]).floor()).abs();
        }
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an even number")]
    let lines = (0.5 * ends) as usize;
    let crossings = crossings(side);
    Counts { curves: lines + 2 * crossings, regions: 1 + lines + crossings }
}

/// The number of places in the window at which both functions are integers.
fn crossings(side: f64) -> usize {
    #[expect(clippy::cast_possible_truncation, reason = "small numbers")]
    let levels = -(side as i64)..=2 * side as i64;
    let pairs = levels.clone().flat_map(|i| levels.clone().map(move |j| [i, j]));
    pairs.filter(|pair| inside(&pair.map(|level| level as f64 / side))).count()
}

/// Whether the point at which the two functions have these values lies in the window. A fixed point
/// is found by iteration, which contracts by more than 0.4 a step.
fn inside(values: &[f64; 2]) -> bool {
    let mut point = Point::new(values[0], values[1]);
    for _ in 0..200 {
        let excess = bent(&point);
        point += Point::new(values[0] - excess[0], values[1] - excess[1]);
    }
    WINDOW.contains(&point)
}

/// The atlas of a chessboard, compared with its closed form.
pub fn row(side: u32, points: usize) -> Result<Row, Box<dyn Error>> {
    let board = Chessboard { side: f64::from(side) };
    let options = AtlasOptions {
        trace: TraceOptions { max_curves: 10_000, ..TraceOptions::default() },
        ..AtlasOptions::default()
    };
    let (atlas, seconds) = timed(|| Atlas::of(&board, &WINDOW, &options));
    let atlas = atlas?;
    let plane = &atlas.plane;
    let mut random = fastrand::Rng::with_seed(1);
    let mut is_wrong = || {
        let point = Point::new(random.f64(), random.f64());
        let Location::Region(region) = plane.locate(&point) else { return true };
        plane.regions()[region].label != board.label(&point).ok()
    };
    let wrong = (0..points).filter(|_| is_wrong()).count();
    let found = Counts { curves: plane.curves().len(), regions: plane.regions().len() };
    let expected = counts(side);
    let objection = atlas
        .objection()
        .or_else(|| (found != expected).then(|| format!("{found:?}, and not {expected:?}")));
    Ok(Row {
        what: format!("chessboard, n = {side}"),
        curves: found.curves,
        regions: found.regions,
        unresolved: atlas.unresolved.len(),
        findings: plane.findings().len(),
        wrong,
        objection,
        seconds,
    })
}
