//! Edges, and their pieces that are monotone in both coordinates and in direction.

use std::ops::Range;

use crate::cubic::Cubic;
use crate::window::Point;

/// An edge of the subdivision: a curve, or a part of the window's boundary.
#[derive(Clone, Debug)]
pub(crate) struct Edge {
    /// The indices of its first and its last vertex; `None` if it is closed without a vertex.
    pub(crate) ends: Option<[usize; 2]>,
    /// The indices of its pieces, in the direction of the edge.
    pub(crate) pieces: Range<usize>,
}

impl Edge {
    /// The direction in which the edge leaves the vertex at its `end`, 0 or 1; a unit vector.
    pub(crate) fn direction(&self, pieces: &[Piece], end: usize) -> Point {
        let piece = &pieces[if end == 0 { self.pieces.start } else { self.pieces.end - 1 }];
        if piece.forward == (end == 0) {
            piece.cubic.tangent(0.0)
        } else {
            -piece.cubic.tangent(1.0)
        }
    }
}

/// A part of an edge, in the direction in which x increases, or y if the part is vertical.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    /// The index of the edge.
    pub(crate) edge: usize,
    /// Whether the edge has the direction of the piece.
    pub(crate) forward: bool,
    pub(crate) cubic: Cubic,
    /// The coefficients of x and y in powers of t.
    powers: [Point; 4],
}

impl Piece {
    /// Adds the pieces of `cubic`, a part of the edge `edge`, in the direction of the edge.
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

    /// The piece of a monotone cubic; `None` if it is a single point.
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
        // Newton's method, with bisection where it leaves the bracket.
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

    /// The height y at the parameter `t`.
    #[inline]
    pub(crate) fn y(&self, t: f64) -> f64 {
        if t == 1.0 {
            return self.last().y;
        }
        let [start, a, b, c] = self.powers.map(|power| power.y);
        start + t * (a + t * (b + t * c))
    }

    /// The height y where the piece has the coordinate `x`.
    #[inline]
    pub(crate) fn y_at(&self, x: f64) -> f64 {
        self.y(self.parameter_at(x))
    }

    /// The height y and the slope dy/dx where the piece has the coordinate `x`.
    pub(crate) fn y_and_slope_at(&self, x: f64) -> (f64, f64) {
        let t = self.parameter_at(x);
        let tangent = self.cubic.derivative(t);
        (self.y(t), tangent.y / tangent.x)
    }

    /// The distance of `point` from the smallest box around the piece, along the coordinate in
    /// which it is greater.
    #[inline]
    pub(crate) fn box_distance(&self, point: &Point) -> f64 {
        let (first, last) = (self.first(), self.last());
        let x = (first.x - point.x).max(point.x - last.x);
        let y = (first.y.min(last.y) - point.y).max(point.y - first.y.max(last.y));
        x.max(y).max(0.0)
    }
}
