//! Edges that cross where there is no vertex.
//!
//! Beside a common vertex, two edges may be closer together than the tolerance, and interpolation
//! leaves open which one is above. A crossing there is reported only if the area between it and the
//! vertex is wider than the tolerance.

use crate::cubic::Cubic;
use crate::regions::arrangement::piece::{Edge, Piece};
use crate::regions::arrangement::slabs::Slabs;
use crate::window::Point;

/// Within this part of the tolerance, no dip between two pieces is searched for.
const NARROW: f64 = 1e-3;

/// Finds the places where two edges cross: their pieces are neighbours in a slab and change places.
pub(crate) struct Crossings<'a> {
    pub(crate) slabs: &'a Slabs,
    pub(crate) edges: &'a [Edge],
    /// The accuracy of edges. Closer together than this, two edges from one vertex may cross.
    pub(crate) tolerance: f64,
    /// The rounding error of heights.
    pub(crate) rounding: f64,
    /// The greatest slope that is used for bounds.
    pub(crate) steepest: f64,
}

impl Crossings<'_> {
    /// The pairs of edges that cross, with the places where they do, from left to right.
    ///
    /// Crossings are decided, not sampled. Pieces of a slab cross if they change order between its
    /// middle and its walls, if their order differs on the two sides of a wall, or if one dips
    /// below the other and comes back. Bounds from the slopes, which are monotone along a piece,
    /// prove that no dip deeper than the tolerance is missed.
    pub(crate) fn find(&self) -> Vec<([usize; 2], Point)> {
        let mut found = Vec::new();
        let mut place = vec![usize::MAX; self.slabs.pieces.len()];
        for slab in 0..self.slabs.count() {
            let pieces = self.slabs.of(slab);
            let wall = self.slabs.walls[slab];
            let mut last: Option<(usize, usize)> = None;
            for &piece in pieces {
                let Some(before) = self.before(piece, wall).map(|left| place[left]) else {
                    continue;
                };
                if let Some((lower, _)) = last.filter(|&(_, earlier)| before < earlier)
                    && self.gap(lower, piece, wall).abs() <= self.rounding
                {
                    self.record([lower, piece], wall, &mut found);
                }
                last = Some((piece, before));
            }
            for pair in pieces.windows(2) {
                let (from, middle, to) =
                    (wall, self.slabs.middle(slab), self.slabs.walls[slab + 1]);
                let meeting = self
                    .dip(pair[0], pair[1], middle, from)
                    .or_else(|| self.dip(pair[0], pair[1], middle, to));
                if let Some(x) = meeting {
                    self.record([pair[0], pair[1]], x, &mut found);
                }
            }
            for &upright in self.slabs.verticals_between(wall, wall) {
                let [low, high] =
                    [self.slabs.pieces[upright].first(), self.slabs.pieces[upright].last()];
                for &piece in pieces.iter().filter(|&&piece| self.before(piece, wall).is_some()) {
                    let y = self.slabs.pieces[piece].y_at(wall);
                    if y > low.y + self.rounding && y < high.y - self.rounding {
                        self.record([piece, upright], wall, &mut found);
                    }
                }
            }
            if let Some(left) = slab.checked_sub(1) {
                for &piece in self.slabs.of(left) {
                    place[piece] = usize::MAX;
                }
            }
            for (position, &piece) in pieces.iter().enumerate() {
                place[piece] = position;
            }
        }
        found
    }

    /// The piece that continues `piece` beyond the wall on its left.
    fn before(&self, piece: usize, wall: f64) -> Option<usize> {
        let own = &self.slabs.pieces[piece];
        if own.first().x < wall {
            return Some(piece);
        }
        let edge = &self.edges[own.edge];
        let neighbour = if own.forward {
            if piece > edge.pieces.start { Some(piece - 1) } else { None }
        } else if piece + 1 < edge.pieces.end {
            Some(piece + 1)
        } else {
            None
        };
        let wrapped = if own.forward { edge.pieces.end - 1 } else { edge.pieces.start };
        let left = neighbour.or(edge.ends.is_none().then_some(wrapped))?;
        let other = &self.slabs.pieces[left];
        (!other.is_vertical() && other.last() == own.first()).then_some(left)
    }

    /// The height of `upper` above `lower` at `x`.
    fn gap(&self, lower: usize, upper: usize, x: f64) -> f64 {
        self.slabs.pieces[upper].y_at(x) - self.slabs.pieces[lower].y_at(x)
    }

    /// The place between `from` and `to` where `upper` falls below `lower`. At `from` it is above;
    /// `to` may be on either side of `from`.
    fn dip(&self, lower: usize, upper: usize, from: f64, to: f64) -> Option<f64> {
        let [p, q] = [lower, upper].map(|piece| &self.slabs.pieces[piece]);
        let ((p0, ps0), (p1, ps1)) = (p.y_and_slope_at(from), p.y_and_slope_at(to));
        let ((q0, qs0), (q1, qs1)) = (q.y_and_slope_at(from), q.y_and_slope_at(to));
        if q0.min(q1) >= p0.max(p1) {
            return None;
        }
        let (gap0, gap1) = (q0 - p0, q1 - p1);
        if gap1 < -self.rounding {
            return Some(self.change(lower, upper, from, to));
        }
        let slopes = [ps0, ps1, qs0, qs1];
        if slopes.iter().all(|slope| slope.abs() <= self.steepest) {
            // The slope of the gap in the direction from `from` to `to` lies in [falls, rises].
            let way = (to - from).signum();
            let (a, b) = (qs0.min(qs1) - ps0.max(ps1), qs0.max(qs1) - ps0.min(ps1));
            let (falls, rises) = if way > 0.0 { (a, b) } else { (-b, -a) };
            let least = if falls >= 0.0 {
                gap0
            } else if rises <= 0.0 {
                gap1
            } else {
                (gap0 * rises - gap1 * falls + falls * rises * (to - from).abs()) / (rises - falls)
            };
            if least >= -self.tolerance {
                return None;
            }
        }
        let middle = 0.5 * (from + to);
        // Steep pieces that coincide would be halved down to neighbouring doubles.
        if (to - from).abs() <= NARROW * self.tolerance || middle == from || middle == to {
            return None;
        }
        if self.gap(lower, upper, middle) < -self.rounding {
            return Some(self.change(lower, upper, from, middle));
        }
        self.dip(lower, upper, from, middle).or_else(|| self.dip(lower, upper, middle, to))
    }

    /// The place where the gap changes its sign. It is positive at `from` and negative at `to`.
    fn change(&self, lower: usize, upper: usize, mut from: f64, mut to: f64) -> f64 {
        loop {
            let middle = 0.5 * (from + to);
            if middle == from || middle == to {
                return middle;
            }
            if self.gap(lower, upper, middle) < 0.0 {
                to = middle;
            } else {
                from = middle;
            }
        }
    }

    /// Records a crossing at `x`, if it is certain.
    fn record(&self, pieces: [usize; 2], x: f64, found: &mut Vec<([usize; 2], Point)>) {
        let [a, b] = pieces.map(|piece| &self.slabs.pieces[piece]);
        let point = Point::new(x, a.y_at(x));
        if !self.within_interpolation(pieces, &point) {
            found.push(([a.edge, b.edge], point));
        }
    }

    /// Whether a crossing may be an error of interpolation.
    ///
    /// This is so if the edges share a vertex and the area between them, from the vertex to the
    /// crossing, has a mean width below the tolerance. It is also so if an edge crosses itself and
    /// encloses less than the tolerance squared, for instance where both sides of a fold are
    /// rounded.
    fn within_interpolation(&self, pieces: [usize; 2], point: &Point) -> bool {
        let [a, b] = pieces.map(|piece| &self.edges[self.slabs.pieces[piece].edge]);
        if std::ptr::eq(a, b) {
            let [to_first, to_last] = [pieces[0].min(pieces[1]), pieces[0].max(pieces[1])]
                .map(|piece| self.area(a, 0, piece, point, point));
            let enclosed = to_last - to_first;
            let whole: f64 = self.slabs.pieces[a.pieces.clone()]
                .iter()
                .map(|piece| if piece.forward { 1.0 } else { -1.0 } * piece.cubic.area(point))
                .sum();
            let rest = whole - enclosed;
            let least =
                if a.ends.is_none() { enclosed.abs().min(rest.abs()) } else { enclosed.abs() };
            if least <= self.tolerance * self.tolerance {
                return true;
            }
        }
        let (Some(a_ends), Some(b_ends)) = (a.ends, b.ends) else {
            return false;
        };
        [[0, 0], [0, 1], [1, 0], [1, 1]].into_iter().any(|[i, j]| {
            if a_ends[i] != b_ends[j] || (std::ptr::eq(a, b) && i == j) {
                return false;
            }
            let vertex = self.end(a, i);
            let area = self.area(a, i, pieces[0], point, &vertex)
                - self.area(b, j, pieces[1], point, &vertex);
            area.abs() <= self.tolerance * (point - vertex).norm().max(self.tolerance)
        })
    }

    /// The first point of an edge if `which` is 0, else the last one.
    fn end(&self, edge: &Edge, which: usize) -> Point {
        let index = if which == 0 { edge.pieces.start } else { edge.pieces.end - 1 };
        let piece = &self.slabs.pieces[index];
        if (which == 0) == piece.forward { piece.first() } else { piece.last() }
    }

    /// The area between an edge, from its end `which` to `place` on `piece`, and the rays from
    /// `origin` to these two points.
    fn area(&self, edge: &Edge, which: usize, piece: usize, place: &Point, origin: &Point) -> f64 {
        // Whether the direction of the edge leads away from that end.
        let away = which == 0;
        let before = if away { edge.pieces.start..piece } else { piece + 1..edge.pieces.end };
        let directed = |piece: &Piece| if piece.forward == away { 1.0 } else { -1.0 };
        let whole: f64 = self.slabs.pieces[before]
            .iter()
            .map(|piece| directed(piece) * piece.cubic.area(origin))
            .sum();
        let last = &self.slabs.pieces[piece];
        let [low, high] = if last.is_vertical() {
            [Cubic::line(last.first(), *place), Cubic::line(*place, last.last())]
        } else {
            last.cubic.split(last.parameter_at(place.x))
        };
        let part = if last.forward == away { low } else { high };
        whole + directed(last) * part.area(origin)
    }
}
