//! The region in which a point lies, and the distance of the nearest curve.

use crate::regions::arrangement::piece::Piece;
use crate::regions::subdivision::Subdivision;
use crate::window::Point;

/// Where a point lies in a subdivision.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Location {
    /// In the region with this index.
    Region(usize),
    /// So close to a curve that the accuracy of the curve leaves the side open.
    OnBoundary {
        /// The index of the nearest curve.
        curve: usize,
        /// The distance from this curve.
        distance: f64,
    },
    /// Outside the window; also if a coordinate is not a number.
    Outside,
}

impl<Label, Margin> Subdivision<Label, Margin> {
    /// Where `point` lies. Two binary searches, for the slab and in the slab, find the region
    /// exactly for the interpolated curves.
    #[must_use]
    pub fn locate(&self, point: &Point) -> Location {
        if !self.window.contains(point) {
            return Location::Outside;
        }
        let near = self.slabs.nearest(point, self.tolerance, |piece| self.is_curve(piece));
        if let Some((piece, distance)) = near {
            return Location::OnBoundary { curve: self.slabs.pieces[piece].edge, distance };
        }
        self.region_at(point).map_or(Location::Outside, Location::Region)
    }

    /// The distance of `point` from the nearest curve along the second coordinate, up or down;
    /// `None` if there is no curve above or below, or if the point is outside the window.
    #[must_use]
    pub fn vertical_distance(&self, point: &Point) -> Option<f64> {
        self.vertical_distances(point).into_iter().flatten().reduce(f64::min)
    }

    /// The distances of `point` from the nearest curves below and above it, along the second
    /// coordinate. Both are 0 on a curve. A distance is `None` if there is no such curve, or if the
    /// point is outside the window.
    #[must_use]
    pub fn vertical_distances(&self, point: &Point) -> [Option<f64>; 2] {
        if !self.window.contains(point) {
            return [None; 2];
        }
        let home = self.slabs.at(point.x);
        // On a wall, a curve may be on one side only.
        let left = (home > 0 && self.slabs.walls[home] == point.x).then(|| home - 1);
        let beside = std::iter::once(home)
            .chain(left)
            .flat_map(|slab| self.slabs.neighbours(slab, point, |piece| self.is_curve(piece)))
            .flatten()
            .map(|index| &self.slabs.pieces[index])
            .map(|piece| piece.y_at(point.x) - point.y);
        let upright = self
            .slabs
            .verticals_between(point.x, point.x)
            .iter()
            .map(|&index| &self.slabs.pieces[index])
            .filter(|piece| self.is_curve(piece))
            .map(|piece| point.y.clamp(piece.first().y, piece.last().y) - point.y);
        let mut distances = [None; 2];
        for rise in beside.chain(upright) {
            // Not −rise, which would be −0 on a curve.
            for (distance, away) in distances.iter_mut().zip([0.0 - rise, rise]) {
                if away >= 0.0 {
                    *distance = Some(distance.map_or(away, |nearest: f64| nearest.min(away)));
                }
            }
        }
        distances
    }

    /// The place on a curve after the fraction `share` in [0, 1) of its pieces, and the unit normal
    /// to the left there.
    pub(crate) fn place_on(&self, curve: usize, share: f64) -> (Point, Point) {
        let range = &self.edges[curve].pieces;
        let way = share * range.len() as f64;
        // Truncation is intended, and `share` may have been rounded up to 1.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let index = (way as usize).min(range.len() - 1);
        let piece = &self.slabs.pieces[range.start + index];
        let t = way - index as f64;
        let along = piece.cubic.derivative(t);
        let along = if piece.forward { along } else { -along };
        (piece.cubic.at(t), Point::new(-along.y, along.x).normalize())
    }

    fn region_at(&self, point: &Point) -> Option<usize> {
        let slab = self.slabs.at(point.x);
        // The lower side of the window is the first piece and belongs to the window.
        let above = self.slabs.below(slab, point).max(1);
        self.faces.of_gap(&self.slabs, slab, above - 1)
    }

    fn is_curve(&self, piece: &Piece) -> bool {
        piece.edge < self.curves.len()
    }
}
