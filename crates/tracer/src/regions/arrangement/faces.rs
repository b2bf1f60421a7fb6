//! Faces: the sides of edges that belong together.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::lengths::angle;
use crate::regions::arrangement::piece::{Edge, Piece};
use crate::regions::arrangement::slabs::Slabs;
use crate::regions::arrangement::union::DisjointSets;
use crate::window::Point;

/// The faces of a subdivision.
#[derive(Clone, Debug)]
pub(crate) struct Faces {
    /// The faces on the left and on the right of every edge; `None` is the outside of the window.
    pub(crate) of_edges: Vec<[Option<usize>; 2]>,
    /// The number of faces, without the outside.
    pub(crate) count: usize,
    /// The face above every piece in every slab, in the order of the slabs; `None` is the outside
    /// or an unknown face.
    of_gaps: Vec<Option<usize>>,
}

impl Faces {
    /// The faces of the sides of `edges`.
    ///
    /// Each gap between two pieces of a slab is united with the sides of edges that face it, and
    /// with the gaps beyond the walls of the slab. Edges that leave a vertex with one tangent are
    /// closer together than `reach` beside it, and interpolation leaves open which one is above. A
    /// gap therefore counts only if it is wider than `reach`. It is united with the side of a piece
    /// only if the gap on the other side of the piece is wide too. An edge may be too short for
    /// such a gap. Its side then has the face of its neighbour at a vertex on the frame that edges
    /// leave in different directions. `frame` are the edges of the window, which have the outside
    /// on their right.
    pub(crate) fn new(slabs: &Slabs, edges: &[Edge], frame: Range<usize>, reach: f64) -> Self {
        let outside = 2 * edges.len();
        let gap_above = |slab: usize, place: usize| outside + 1 + slabs.start(slab) + place;
        let mut sets = DisjointSets::new(gap_above(slabs.count(), 0));
        let mut seen = vec![false; outside];
        for edge in frame.clone() {
            sets.unite(2 * edge + 1, outside);
            seen[2 * edge + 1] = true;
        }
        let piece = |index: usize| &slabs.pieces[index];
        for slab in 0..slabs.count() {
            let pieces = slabs.of(slab);
            let wide: Vec<bool> =
                (0..pieces.len()).map(|gap| slabs.is_wide(slab, gap, reach)).collect();
            for (gap, pair) in pieces.windows(2).enumerate().filter(|&(gap, _)| wide[gap]) {
                let (lower, upper) = (piece(pair[0]), piece(pair[1]));
                let lower = (gap == 0 || wide[gap - 1]).then(|| side(lower, !lower.forward));
                let upper = wide[gap + 1].then(|| side(upper, upper.forward));
                for side in lower.into_iter().chain(upper) {
                    sets.unite(gap_above(slab, gap), side);
                    seen[side] = true;
                }
            }
        }
        for slab in 1..slabs.count() {
            let x = slabs.walls[slab];
            let heights = |slab| -> Vec<f64> {
                slabs.of(slab).iter().map(|&index| piece(index).y_at(x)).collect()
            };
            let (left, right) = (heights(slab - 1), heights(slab));
            let (mut i, mut j) = (0, 0);
            while i + 1 < left.len() && j + 1 < right.len() {
                let (low, high) = (left[i].max(right[j]), left[i + 1].min(right[j + 1]));
                let (a, b) = (gap_above(slab - 1, i), gap_above(slab, j));
                let place = Point::new(x, 0.5 * (low + high));
                let blocks = |piece: &Piece| !piece.is_vertical() || piece.first().x == x;
                if high > low
                    && !sets.are_united(a, b)
                    && slabs.nearest(&place, reach, blocks).is_none()
                {
                    sets.unite(a, b);
                }
                if left[i + 1] < right[j + 1] {
                    i += 1;
                } else {
                    j += 1;
                }
            }
        }
        for [one, other] in turns(&slabs.pieces, edges, &frame) {
            if !(seen[one] && seen[other]) {
                sets.unite(one, other);
                let either = seen[one] || seen[other];
                (seen[one], seen[other]) = (either, either);
            }
        }
        // The remaining sides belong to edges that are vertical or nearly so. A point beside the
        // edge shows the gap that such a side faces.
        for side in (0..outside).filter(|&side| !seen[side]) {
            let edge = &edges[side / 2];
            let gap = slabs.pieces[edge.pieces.clone()].iter().find_map(|piece| {
                let middle = piece.cubic.at(0.5);
                let along = piece.cubic.derivative(0.5).normalize();
                let left = Point::new(-along.y, along.x);
                let away = if piece.forward == (side % 2 == 0) { left } else { -left };
                let place = middle + 2.0 * reach * away;
                let others = |other: &Piece| other.edge != side / 2;
                if slabs.nearest(&middle, 2.0 * reach, others).is_some()
                    || slabs.nearest(&place, reach, |_| true).is_some()
                {
                    return None;
                }
                let slab = slabs.at(place.x);
                let gap = slabs.below(slab, &place).checked_sub(1)?;
                (gap + 1 < slabs.of(slab).len()).then(|| gap_above(slab, gap))
            });
            if let Some(gap) = gap {
                sets.unite(side, gap);
            }
        }
        Self::numbered(&mut sets, edges.len(), slabs.start(slabs.count()))
    }

    /// The faces of united sides and gaps, numbered in the order of their first edges.
    fn numbered(sets: &mut DisjointSets, edges: usize, gaps: usize) -> Self {
        let outside = sets.least(2 * edges);
        let mut numbers = vec![None; 2 * edges + 1];
        let mut count = 0;
        let mut number = |side: usize| {
            let least = sets.least(side);
            if least != outside && numbers[least].is_none() {
                numbers[least] = Some(count);
                count += 1;
            }
            numbers[least]
        };
        let of_edges = (0..edges).map(|edge| [number(2 * edge), number(2 * edge + 1)]).collect();
        let of_gaps = (0..gaps)
            .map(|gap| numbers.get(sets.least(2 * edges + 1 + gap)).copied().flatten())
            .collect();
        Self { of_edges, count, of_gaps }
    }

    /// The face between the pieces at `gap` and `gap` + 1 of a slab. If this is unknown because the
    /// pieces are too close, the face above the lower piece.
    #[inline]
    pub(crate) fn of_gap(&self, slabs: &Slabs, slab: usize, gap: usize) -> Option<usize> {
        self.of_gaps[slabs.start(slab) + gap].or_else(|| {
            let piece = &slabs.pieces[slabs.of(slab)[gap]];
            self.of_edges[piece.edge][usize::from(!piece.forward)]
        })
    }
}

/// The sides that lead into each other at the vertices on the frame of the window where the order
/// of edges is sure: one edge leaves the frame there, or several in different directions.
fn turns(pieces: &[Piece], edges: &[Edge], frame: &Range<usize>) -> Vec<[usize; 2]> {
    // The left sides of edges, seen from a vertex at which they begin or end, and their directions.
    let mut around: BTreeMap<usize, Vec<(usize, Point)>> = BTreeMap::new();
    for (edge, ends) in edges.iter().enumerate().filter_map(|(edge, own)| Some((edge, own.ends?))) {
        for (end, vertex) in ends.into_iter().enumerate() {
            let away = edges[edge].direction(pieces, end);
            around.entry(vertex).or_default().push((2 * edge + end, away));
        }
    }
    let mut turns = Vec::new();
    for sides in around.into_values() {
        let (of_frame, mut inner): (Vec<_>, Vec<_>) =
            sides.into_iter().partition(|&(side, _)| frame.contains(&(side / 2)));
        let &[one, other] = &of_frame[..] else { continue };
        let (begins, ends) = if one.0 % 2 == 0 { (one, other) } else { (other, one) };
        // Counterclockwise from the edge of the frame that begins at the vertex.
        let angle = |away: &Point| begins.1.perp(away).atan2(begins.1.dot(away));
        inner.sort_by(|(_, one), (_, other)| angle(one).total_cmp(&angle(other)));
        let order: Vec<_> = [begins].into_iter().chain(inner).chain([ends]).collect();
        let apart =
            |pair: &[(usize, Point)]| angle(&pair[1].1) - angle(&pair[0].1) > angle::ORDERED;
        if order.len() == 3 || order.windows(2).all(apart) {
            let next = order.iter().cycle().skip(1);
            turns.extend(order.iter().zip(next).map(|(one, other)| [one.0, other.0 ^ 1]));
        }
    }
    turns
}

/// The number of a side of an edge in the sets. Left sides are even, and right sides are odd.
fn side(piece: &Piece, right: bool) -> usize {
    2 * piece.edge + usize::from(right)
}
