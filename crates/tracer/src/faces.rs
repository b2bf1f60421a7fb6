//! Which sides of edges belong to one face.

use std::ops::Range;

use crate::crossing::Edge;
use crate::family::Point;
use crate::piece::Piece;
use crate::slabs::Slabs;
use crate::union::DisjointSets;

/// The faces of both sides, left and right, of every edge; `None` is the outside.
#[derive(Clone, Debug)]
pub(crate) struct Faces {
    pub(crate) of_edges: Vec<[Option<usize>; 2]>,
    pub(crate) count: usize,
}

impl Faces {
    /// Joins sides that look at each other vertically, and places that a wall between slabs keeps apart.
    ///
    /// Edges that leave a vertex with one tangent are closer together than `reach` beside it, and interpolation leaves open which
    /// one is above. So a gap between pieces counts only where it is wider, and speaks for a piece only if the gap on the piece's
    /// other side is wider as well. `outline` are the edges of the window, which have the outside on their right.
    pub(crate) fn new(slabs: &Slabs, edges: &[Edge], outline: Range<usize>, reach: f64) -> Self {
        let outside = 2 * edges.len();
        let mut sides = DisjointSets::new(outside + 1);
        for edge in outline {
            sides.unite(2 * edge + 1, outside);
        }
        let piece = |index: usize| &slabs.pieces[index];
        for slab in 0..slabs.count() {
            for (lower, pair) in slabs.of(slab).windows(2).enumerate() {
                let (a, b) = (side_above(piece(pair[0])), side_below(piece(pair[1])));
                if !sides.are_united(a, b)
                    && (lower.saturating_sub(1)..=lower + 1)
                        .all(|gap| slabs.is_wide(slab, gap, reach))
                {
                    sides.unite(a, b);
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
                let place = Point::new(x, 0.5 * (low + high));
                let [a, b] =
                    [slabs.of(slab - 1)[i], slabs.of(slab)[j]].map(|k| side_above(piece(k)));
                if high > low
                    && !sides.are_united(a, b)
                    && slabs.nearest(&place, reach, |_| true).is_none()
                    && let (Some(a), Some(b)) =
                        (side_of_gap(slabs, slab - 1, i, reach), side_of_gap(slabs, slab, j, reach))
                {
                    sides.unite(a, b);
                }
                if left[i + 1] < right[j + 1] {
                    i += 1;
                } else {
                    j += 1;
                }
            }
        }
        for &index in &slabs.verticals {
            let vertical = piece(index);
            let middle = vertical.cubic.at(0.5);
            let other = |other: &Piece| !std::ptr::eq(other, vertical);
            if slabs.nearest(&middle, reach, other).is_some() {
                continue;
            }
            let right = slabs.walls.partition_point(|&wall| wall < middle.x);
            let [left_side, right_side] =
                [side(vertical, !vertical.forward), side(vertical, vertical.forward)];
            let beside = [(right.checked_sub(1), left_side), (Some(right), right_side)];
            for (slab, own) in beside {
                if let Some(slab) = slab.filter(|&slab| slab < slabs.count())
                    && let Some(gap) = slabs.below(slab, &middle).checked_sub(1)
                    && let Some(seen) = side_of_gap(slabs, slab, gap, reach)
                {
                    sides.unite(own, seen);
                }
            }
        }
        Self::numbered(&mut sides, edges.len())
    }

    fn numbered(sides: &mut DisjointSets, edges: usize) -> Self {
        let outside = sides.least(2 * edges);
        let mut numbers = vec![None; 2 * edges + 1];
        let mut count = 0;
        let mut number = |side: usize| {
            let least = sides.least(side);
            if least == outside {
                return None;
            }
            if numbers[least].is_none() {
                numbers[least] = Some(count);
                count += 1;
            }
            numbers[least]
        };
        let of_edges = (0..edges).map(|edge| [number(2 * edge), number(2 * edge + 1)]).collect();
        Self { of_edges, count }
    }

    /// Puts pieces of a slab that are closer together than `reach` into the order in which faces follow each other.
    pub(crate) fn put_in_order(&self, slabs: &mut Slabs, reach: f64) {
        for slab in 0..slabs.count() {
            for place in 1..slabs.of(slab).len() {
                let pieces = slabs.of(slab);
                let face = self.above(&slabs.pieces[pieces[place - 1]]);
                let follows = |&index: &usize| self.below(&slabs.pieces[index]) == face;
                if follows(&pieces[place]) {
                    continue;
                }
                let last = (place..pieces.len() - 1).find(|&gap| slabs.is_wide(slab, gap, reach));
                let close = place..=last.unwrap_or(pieces.len() - 1);
                if let Some(next) = pieces[close].iter().position(follows) {
                    slabs.of_mut(slab).swap(place, place + next);
                }
            }
        }
    }

    /// The face below a piece that is not vertical.
    fn below(&self, piece: &Piece) -> Option<usize> {
        self.of_edges[piece.edge][usize::from(piece.forward)]
    }

    /// The face above a piece that is not vertical.
    #[inline]
    pub(crate) fn above(&self, piece: &Piece) -> Option<usize> {
        self.of_edges[piece.edge][usize::from(!piece.forward)]
    }
}

/// A side that looks into the part of a slab above its piece at position `gap`, if one can be told.
fn side_of_gap(slabs: &Slabs, slab: usize, gap: usize, reach: f64) -> Option<usize> {
    let pieces = slabs.of(slab);
    if !slabs.is_wide(slab, gap, reach) {
        None
    } else if gap == 0 || slabs.is_wide(slab, gap - 1, reach) {
        Some(side_above(&slabs.pieces[pieces[gap]]))
    } else if slabs.is_wide(slab, gap + 1, reach) {
        Some(side_below(&slabs.pieces[pieces[gap + 1]]))
    } else {
        None
    }
}

/// A side of an edge as a member of the sets: left ones are even.
fn side(piece: &Piece, right: bool) -> usize {
    2 * piece.edge + usize::from(right)
}

fn side_above(piece: &Piece) -> usize {
    side(piece, !piece.forward)
}

fn side_below(piece: &Piece) -> usize {
    side(piece, piece.forward)
}
