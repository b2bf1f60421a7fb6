//! Where lines cross.

use std::collections::{BTreeSet, HashMap};

use crate::cubic::Cubic;
use crate::lengths::{Lengths, angle};
use crate::tracing::margins::line::{Line, Place};
use crate::window::{Point, Window};

/// A crossing of the cubics of two lines.
pub(super) struct Crossing {
    pub lines: [usize; 2],
    pub places: [Place; 2],
    pub point: Point,
}

/// A place where two lines are nearest to each other, and nearly touch.
pub(super) struct Nearness {
    pub lines: [usize; 2],
    pub places: [Place; 2],
    /// The place on the first line.
    pub point: Point,
}

/// The places where pairs of lines are parallel and no farther apart than `reach`.
pub(super) fn nearnesses<M: Clone>(
    lines: &[Line<M>],
    window: &Window,
    reach: f64,
) -> Vec<Nearness> {
    let mut found = Vec::new();
    for [one, other] in pairs(lines, window) {
        if one.0 == other.0 {
            continue;
        }
        let cubics = [one, other].map(|(line, piece)| lines[line].cubic(piece));
        let ([low, high], [least, most]) = (cubics[0].bounds(), cubics[1].bounds());
        if (0..2).any(|axis| low[axis] > most[axis] + reach || least[axis] > high[axis] + reach) {
            continue;
        }
        let beside = |theta: f64| lines[other.0].near(&cubics[0].at(theta), cubics[0].chord());
        // The sine of the angle between the two, on the first one.
        let sine = |theta: f64| {
            let (along, Some((there, _))) = (cubics[0].tangent(theta), beside(theta)) else {
                return 0.0;
            };
            let beside = lines[other.0].tangent(there);
            along.perp(&beside) * along.dot(&beside).signum()
        };
        let (mut low, mut high) = (0.0, 1.0);
        let ends = [sine(low), sine(high)];
        let changes = ends[0] * ends[1] <= 0.0;
        // Lines that run along each other differ by their errors.
        if !changes || ends.iter().all(|sine| sine.abs() < angle::STRAIGHT) {
            continue;
        }
        for _ in 0..ROUNDS {
            let middle = f64::midpoint(low, high);
            if sine(middle) * ends[0] > 0.0 { low = middle } else { high = middle }
        }
        let theta = f64::midpoint(low, high);
        if let Some((there, distance)) = beside(theta)
            && distance <= reach
        {
            let (places, point) = ([Place { piece: one.1, theta }, there], cubics[0].at(theta));
            found.push(Nearness { lines: [one.0, other.0], places, point });
        }
    }
    found
}

/// How often a piece is halved around the place where it is parallel to another one.
const ROUNDS: usize = 20;

/// The crossings of all lines.
pub(super) fn crossings<M: Clone>(
    lines: &[Line<M>],
    window: &Window,
    lengths: &Lengths,
) -> Vec<Crossing> {
    let mut found: Vec<Crossing> = Vec::new();
    for [one, other] in pairs(lines, window) {
        let cubics = [one, other].map(|(line, piece)| lines[line].cubic(piece));
        let mut meeting = Meeting { lengths, found: Vec::new(), left: EFFORT };
        meeting.meet(Part::whole(&cubics[0]), Part::whole(&cubics[1]), 0);
        for [s, t] in meeting.found {
            let point = cubics[0].at(s);
            let lines = [one.0, other.0];
            // At a node, two pieces show one crossing.
            let known = found.iter().rev().take(50).any(|crossing| {
                crossing.lines == lines && (crossing.point - point).norm() < lengths.solved
            });
            if !known {
                let places = [Place { piece: one.1, theta: s }, Place { piece: other.1, theta: t }];
                found.push(Crossing { lines, places, point });
            }
        }
    }
    found
}

/// A cubic of a line: the numbers of both.
type Index = (usize, usize);

/// Cubics that may cross: those that share a cell of a grid, except neighbours on one line.
fn pairs<M: Clone>(lines: &[Line<M>], window: &Window) -> BTreeSet<[Index; 2]> {
    const CELLS: f64 = 128.0;
    let size = window.extent() / CELLS;
    #[expect(clippy::cast_possible_truncation, reason = "lines lie in the window")]
    let cell = |point: &Point| (point - window.low).component_div(&size).map(|x| x.floor() as i32);
    let mut cells: HashMap<[i32; 2], Vec<Index>> = HashMap::new();
    for (index, line) in lines.iter().enumerate() {
        for piece in 0..line.pieces() {
            let [low, high] = line.cubic(piece).bounds().map(|corner| cell(&corner));
            for x in low.x..=high.x {
                for y in low.y..=high.y {
                    cells.entry([x, y]).or_default().push((index, piece));
                }
            }
        }
    }
    let mut pairs = BTreeSet::new();
    for list in cells.values() {
        for (position, one) in list.iter().enumerate() {
            for other in &list[position + 1..] {
                let last = lines[one.0].pieces() - 1;
                let apart = one.1.abs_diff(other.1);
                let closes = lines[one.0].ends.is_none() && apart == last;
                if one.0 != other.0 || (apart > 1 && !closes) {
                    pairs.insert(if one < other { [*one, *other] } else { [*other, *one] });
                }
            }
        }
    }
    pairs
}

/// How many pairs of parts of two cubics are looked at. Cubics that run along each other need more.
const EFFORT: usize = 2000;

/// A part of a cubic, between two of its parameters.
#[derive(Clone, Copy)]
struct Part {
    cubic: Cubic,
    from: f64,
    to: f64,
}

impl Part {
    fn whole(cubic: &Cubic) -> Self {
        Self { cubic: *cubic, from: 0.0, to: 1.0 }
    }

    fn halves(&self) -> [Self; 2] {
        let middle = f64::midpoint(self.from, self.to);
        let [first, last] = self.cubic.split(0.5);
        [Self { cubic: first, to: middle, ..*self }, Self { cubic: last, from: middle, ..*self }]
    }

    fn chord(&self) -> Point {
        self.cubic.points[3] - self.cubic.points[0]
    }

    fn is_straight(&self) -> bool {
        let (points, chord) = (&self.cubic.points, self.chord());
        let off = |handle: &Point| (handle - points[0]).perp(&chord).abs();
        points[1..3].iter().all(|handle| off(handle) < 1e-3 * chord.norm_squared())
    }
}

/// The search for the crossings of two cubics.
struct Meeting<'l> {
    lengths: &'l Lengths,
    /// The parameters on both.
    found: Vec<[f64; 2]>,
    left: usize,
}

impl Meeting<'_> {
    fn meet(&mut self, one: Part, other: Part, depth: u32) {
        /// Parts have no length left.
        const DEEPEST: u32 = 60;
        let error = 0.1 * self.lengths.solved;
        let ([low, high], [least, most]) = (one.cubic.bounds(), other.cubic.bounds());
        let apart =
            (0..2).any(|axis| low[axis] > most[axis] + error || least[axis] > high[axis] + error);
        if apart || self.left == 0 || depth > DEEPEST {
            return;
        }
        self.left -= 1;
        if beside(&one, &other, error) || beside(&other, &one, error) {
            return;
        }
        let (along, across) = (one.chord(), other.chord());
        if one.is_straight() && other.is_straight() {
            let sine = along.perp(&across).abs() / (along.norm() * across.norm());
            let short = along.norm().max(across.norm()) < self.lengths.half;
            if sine > angle::TANGENT || short {
                self.solve(&one, &other);
                return;
            }
        }
        if along.norm() >= across.norm() {
            for half in one.halves() {
                self.meet(half, other, depth + 1);
            }
        } else {
            for half in other.halves() {
                self.meet(one, half, depth + 1);
            }
        }
    }

    /// The crossing of two parts that are nearly straight, by Newton's method.
    fn solve(&mut self, one: &Part, other: &Part) {
        let (along, across) = (one.chord(), other.chord());
        let (length, width) = (along.norm(), across.norm());
        if along.perp(&across).abs() < angle::STRAIGHT * length * width {
            // They run along each other.
            return;
        }
        let between = other.cubic.points[0] - one.cubic.points[0];
        let mut s = between.perp(&across) / along.perp(&across);
        let mut t = between.perp(&along) / along.perp(&across);
        for _ in 0..6 {
            let apart = one.cubic.at(s) - other.cubic.at(t);
            let (u, v) = (one.cubic.derivative(s), other.cubic.derivative(t));
            let determinant = u.perp(&v);
            s -= apart.perp(&v) / determinant;
            t -= apart.perp(&u) / determinant;
        }
        // An end may miss another line by the error of both.
        let slack = self.lengths.same;
        let on = |x: f64, length: f64| x * length >= -slack && (x - 1.0) * length <= slack;
        if on(s, length) && on(t, width) {
            let place =
                |part: &Part, x: f64| (part.from + (part.to - part.from) * x).clamp(0.0, 1.0);
            self.found.push([place(one, s), place(other, t)]);
        }
    }
}

/// Whether one part lies on one side of the chord of another, and the other does not.
fn beside(one: &Part, other: &Part, error: f64) -> bool {
    let chord = one.chord();
    let length = chord.norm();
    let range = |part: &Part| {
        let heights = part.cubic.points.map(|point| chord.perp(&(point - one.cubic.points[0])));
        let low = heights.iter().copied().fold(f64::INFINITY, f64::min);
        let high = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        [low / length, high / length]
    };
    let ([low, high], [least, most]) = (range(one), range(other));
    length > error && (low > most + error || least > high + error)
}
