//! Vertical slabs of the plane. No piece begins or ends inside a slab, so the pieces of a slab have
//! an order.

use crate::regions::arrangement::piece::Piece;
use crate::window::Point;

/// The pieces, and the slabs between neighbouring `walls`. The pieces of each slab are ordered
/// upwards.
#[derive(Clone, Debug)]
pub(crate) struct Slabs {
    pub(crate) pieces: Vec<Piece>,
    /// The coordinates x at which pieces begin or end.
    pub(crate) walls: Vec<f64>,
    /// `order[starts[i]..starts[i + 1]]` are the pieces of slab i.
    starts: Vec<usize>,
    order: Vec<usize>,
    /// The vertical pieces, by x.
    pub(crate) verticals: Vec<usize>,
}

impl Slabs {
    /// The slabs of `pieces`.
    pub(crate) fn new(pieces: Vec<Piece>) -> Self {
        let mut walls: Vec<f64> =
            pieces.iter().flat_map(|piece| [piece.first().x, piece.last().x]).collect();
        walls.sort_by(f64::total_cmp);
        walls.dedup();
        let wall = |x: f64| walls.partition_point(|&wall| wall < x);
        let spans: Vec<_> =
            pieces.iter().map(|piece| wall(piece.first().x)..wall(piece.last().x)).collect();
        let mut starts = vec![0; walls.len()];
        for slab in spans.iter().cloned().flatten() {
            starts[slab + 1] += 1;
        }
        for slab in 1..starts.len() {
            starts[slab] += starts[slab - 1];
        }
        let mut next = starts.clone();
        let mut order = vec![0; starts.last().copied().unwrap_or(0)];
        for (piece, span) in spans.iter().enumerate() {
            for slab in span.clone() {
                order[next[slab]] = piece;
                next[slab] += 1;
            }
        }
        for slab in 0..starts.len().saturating_sub(1) {
            let middle = 0.5 * (walls[slab] + walls[slab + 1]);
            order[starts[slab]..starts[slab + 1]]
                .sort_by_cached_key(|&piece| OrderedHeight(pieces[piece].y_at(middle)));
        }
        let mut verticals: Vec<usize> =
            (0..pieces.len()).filter(|&piece| pieces[piece].is_vertical()).collect();
        verticals.sort_by(|&i, &j| pieces[i].first().x.total_cmp(&pieces[j].first().x));
        Self { pieces, walls, starts, order, verticals }
    }

    /// The number of slabs.
    pub(crate) fn count(&self) -> usize {
        self.walls.len().saturating_sub(1)
    }

    /// The pieces of a slab, upwards.
    #[inline]
    pub(crate) fn of(&self, slab: usize) -> &[usize] {
        &self.order[self.starts[slab]..self.starts[slab + 1]]
    }

    /// The index of the first piece of a slab in the order of all slabs.
    #[inline]
    pub(crate) fn start(&self, slab: usize) -> usize {
        self.starts[slab]
    }

    /// Whether the middle between the pieces at `gap` and `gap` + 1 of a slab is farther than
    /// `reach` from every piece. Also true if one of the two pieces does not exist.
    pub(crate) fn is_wide(&self, slab: usize, gap: usize, reach: f64) -> bool {
        let pieces = self.of(slab);
        gap + 1 >= pieces.len() || {
            let x = self.middle(slab);
            let [low, high] = [gap, gap + 1].map(|k| self.pieces[pieces[k]].y_at(x));
            self.nearest(&Point::new(x, 0.5 * (low + high)), reach, |_| true).is_none()
        }
    }

    /// The coordinate x of the middle of a slab.
    pub(crate) fn middle(&self, slab: usize) -> f64 {
        0.5 * (self.walls[slab] + self.walls[slab + 1])
    }

    /// The slab in which `x` lies: the right one if `x` is a wall, and the nearest one if `x` is
    /// outside all slabs.
    #[inline]
    pub(crate) fn at(&self, x: f64) -> usize {
        let right = self.walls.partition_point(|&wall| wall <= x);
        right.saturating_sub(1).min(self.count().saturating_sub(1))
    }

    /// The number of pieces of the slab below `point`. The point may also be on a wall of the slab.
    #[inline]
    pub(crate) fn below(&self, slab: usize, point: &Point) -> usize {
        self.of(slab).partition_point(|&piece| self.pieces[piece].y_at(point.x) < point.y)
    }

    /// The nearest pieces below and above `point` in the slab that `accept` accepts.
    #[inline]
    pub(crate) fn neighbours(
        &self,
        slab: usize,
        point: &Point,
        accept: impl Fn(&Piece) -> bool,
    ) -> [Option<usize>; 2] {
        let (below, above) = self.of(slab).split_at(self.below(slab, point));
        let accepted = |&&index: &&usize| accept(&self.pieces[index]);
        [below.iter().rev().find(accepted).copied(), above.iter().find(accepted).copied()]
    }

    /// The vertical pieces with x from `from` to `to`.
    pub(crate) fn verticals_between(&self, from: f64, to: f64) -> &[usize] {
        let x = |&piece: &usize| self.pieces[piece].first().x;
        let start = self.verticals.partition_point(|piece| x(piece) < from);
        let end = self.verticals.partition_point(|piece| x(piece) <= to);
        &self.verticals[start..end.max(start)]
    }

    /// The nearest piece within `reach` of `point` that `accept` accepts, with its distance.
    ///
    /// In each slab within reach it suffices to look at the pieces directly above and below the
    /// place nearest to `point`, because the straight way to another piece leads through one of
    /// them.
    #[inline]
    pub(crate) fn nearest(
        &self,
        point: &Point,
        reach: f64,
        accept: impl Fn(&Piece) -> bool,
    ) -> Option<(usize, f64)> {
        let mut best: Option<(usize, f64)> = None;
        let mut consider = |index: usize| {
            let piece = &self.pieces[index];
            let bound = best.map_or(reach, |(_, distance)| distance);
            if piece.box_distance(point) <= bound {
                let distance = piece.cubic.distance(point);
                if distance <= bound && best.is_none_or(|(_, least)| distance < least) {
                    best = Some((index, distance));
                }
            }
        };
        let home = self.at(point.x);
        self.neighbours(home, point, &accept).into_iter().flatten().for_each(&mut consider);
        let mut slab = home;
        while slab > 0 && self.walls[slab] >= point.x - reach {
            slab -= 1;
            let place = Point::new(self.walls[slab + 1].min(point.x), point.y);
            self.neighbours(slab, &place, &accept).into_iter().flatten().for_each(&mut consider);
        }
        let mut slab = home;
        while slab + 1 < self.count() && self.walls[slab + 1] <= point.x + reach {
            slab += 1;
            let place = Point::new(self.walls[slab].max(point.x), point.y);
            self.neighbours(slab, &place, &accept).into_iter().flatten().for_each(&mut consider);
        }
        self.verticals_between(point.x - reach, point.x + reach)
            .iter()
            .copied()
            .filter(|&index| accept(&self.pieces[index]))
            .for_each(&mut consider);
        best
    }
}

/// A height as a key for sorting.
#[derive(PartialEq)]
struct OrderedHeight(f64);

impl Eq for OrderedHeight {}

impl PartialOrd for OrderedHeight {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for OrderedHeight {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}
