//! Which sides of edges belong to one face.

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
    /// What is seen counts only at places farther than `reach` from every edge, so that nothing is decided by the order of edges
    /// that interpolation cannot tell apart: tangent ones close to their vertex. `outline` are the edges of the window, which
    /// have the outside on their right.
    pub(crate) fn new(
        slabs: &Slabs,
        edges: &[Edge],
        outline: std::ops::Range<usize>,
        reach: f64,
    ) -> Self {
        let outside = 2 * edges.len();
        let mut sides = DisjointSets::new(outside + 1);
        for edge in outline {
            sides.unite(2 * edge + 1, outside);
        }
        let clear = |x: f64, y: f64| slabs.nearest(&Point::new(x, y), reach, |_| true).is_none();
        let piece = |index: usize| &slabs.pieces[index];
        for slab in 0..slabs.count() {
            let x = slabs.middle(slab);
            for pair in slabs.of(slab).windows(2) {
                let [lower, upper] = [piece(pair[0]), piece(pair[1])];
                let (a, b) = (side_above(lower), side_below(upper));
                if !sides.are_united(a, b) && clear(x, 0.5 * (lower.y_at(x) + upper.y_at(x))) {
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
                let [a, b] =
                    [slabs.of(slab - 1)[i], slabs.of(slab)[j]].map(|k| side_above(piece(k)));
                if high > low && !sides.are_united(a, b) && clear(x, 0.5 * (low + high)) {
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
            let right = slabs.walls.partition_point(|&wall| wall < middle.x);
            let [left_side, right_side] =
                [side(vertical, !vertical.forward), side(vertical, vertical.forward)];
            let neighbours = [(right.checked_sub(1), left_side), (Some(right), right_side)];
            for (slab, own) in neighbours {
                if let Some(slab) = slab.filter(|&slab| slab < slabs.count())
                    && let [Some(below), _] = slabs.neighbours(slab, &middle)
                {
                    sides.unite(own, side_above(piece(below)));
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

    /// The face above a piece that is not vertical.
    #[inline]
    pub(crate) fn above(&self, piece: &Piece) -> Option<usize> {
        self.of_edges[piece.edge][usize::from(!piece.forward)]
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
