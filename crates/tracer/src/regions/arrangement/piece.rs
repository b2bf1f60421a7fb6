//! Pieces of edges that are monotone in both coordinates and in direction.

use std::ops::Range;

use crate::cubic::Cubic;
use crate::window::Point;

/// An edge of the subdivision: its vertices, and its pieces in its direction.
#[derive(Clone, Debug)]
pub(crate) struct Edge {
    /// `None` if it is closed without a vertex.
    pub(crate) ends: Option<[usize; 2]>,
    pub(crate) pieces: Range<usize>,
}

/// A part of an edge, turned so that x increases, or y if it is vertical.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    pub(crate) edge: usize,
    /// Whether the edge runs as the piece does.
    pub(crate) forward: bool,
    pub(crate) cubic: Cubic,
    /// Coefficients of x and y in powers of t.
    powers: [Point; 4],
}

impl Piece {
    /// The pieces of `cubic`, a part of edge `edge`, in the edge's direction.
    pub(crate) fn of(edge: usize, cubic: Cubic, pieces: &mut Vec<Self>) {
        let mut rest = cubic;
        let mut done = 0.0;
        for cut in cubic.monotone_cuts() {
            let [part, after] = rest.split((cut - done) / (1.0 - done));
            pieces.extend(Self::new(edge, part));
            (rest, done) = (after, cut);
        }
        pieces.extend(Self::new(edge, rest));
    }

    /// `None` if it is a single point.
    fn new(edge: usize, cubic: Cubic) -> Option<Self> {
        let [first, .., last] = cubic.points;
        if first == last {
            return None;
        }
        let forward = (first.x, first.y) < (last.x, last.y);
        let cubic = if forward { cubic } else { cubic.reversed() };
        let [a, b, c, d] = cubic.points;
        let powers = [a, 3.0 * (b - a), 3.0 * (c - 2.0 * b + a), d - a - 3.0 * (c - b)];
        Some(Self { edge, forward, cubic, powers })
    }

    pub(crate) fn first(&self) -> Point {
        self.cubic.points[0]
    }

    pub(crate) fn last(&self) -> Point {
        self.cubic.points[3]
    }

    pub(crate) fn is_vertical(&self) -> bool {
        self.first().x == self.last().x
    }

    /// The parameter at which the piece has the coordinate `x`, or the nearer end.
    #[inline]
    pub(crate) fn parameter_at(&self, x: f64) -> f64 {
        let (first, last) = (self.first().x, self.last().x);
        if x <= first {
            return 0.0;
        }
        if x >= last {
            return 1.0;
        }
        let [_, a, b, c] = self.powers.map(|power| power.x);
        let rise = x - first;
        let (mut low, mut high) = (0.0, 1.0);
        let mut t = rise / (last - first);
        // Newton's method, halving where it leaves the bracket.
        for _ in 0..100 {
            let excess = t * (a + t * (b + t * c)) - rise;
            if excess > 0.0 {
                high = t;
            } else {
                low = t;
            }
            let newton = t - excess / (a + t * (2.0 * b + t * 3.0 * c));
            let next = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
            if (next - t).abs() <= 2.0 * f64::EPSILON {
                return next;
            }
            t = next;
        }
        t
    }

    /// y at the parameter `t`.
    #[inline]
    pub(crate) fn y(&self, t: f64) -> f64 {
        if t == 1.0 {
            return self.last().y;
        }
        let [start, a, b, c] = self.powers.map(|power| power.y);
        start + t * (a + t * (b + t * c))
    }

    /// y where the piece has the coordinate `x`.
    #[inline]
    pub(crate) fn y_at(&self, x: f64) -> f64 {
        self.y(self.parameter_at(x))
    }

    /// y and dy/dx where the piece has the coordinate `x`.
    pub(crate) fn y_and_slope_at(&self, x: f64) -> (f64, f64) {
        let t = self.parameter_at(x);
        let tangent = self.cubic.derivative(t);
        (self.y(t), tangent.y / tangent.x)
    }

    /// How far `point` is from the smallest box around the piece, along the farther coordinate.
    #[inline]
    pub(crate) fn box_distance(&self, point: &Point) -> f64 {
        let (first, last) = (self.first(), self.last());
        let x = (first.x - point.x).max(point.x - last.x);
        let y = (first.y.min(last.y) - point.y).max(point.y - first.y.max(last.y));
        x.max(y).max(0.0)
    }
}
