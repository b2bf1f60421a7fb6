//! How many regions a window has, roughly, before any boundary is traced.

use crate::executor::Executor;
use crate::family::Family;
use crate::options::TraceError;
use crate::regions::arrangement::union::DisjointSets;
use crate::tracing::runs::Traced;
use crate::tracing::trace::Tracer;
use crate::watch::Watch;
use crate::window::Point;

impl<F: Family> Tracer<'_, F> {
    /// Refuses a window that has more curves than the options allow, as far as a grid of labels
    /// shows.
    ///
    /// Regions are counted by [`Self::count_regions`]. There are at least as many curves between
    /// regions as regions but one, and about twice as many where curves cross.
    ///
    /// # Errors
    /// [`TraceError::TooManyCurves`] has the number of regions.
    pub fn require_few<E: Executor<F>>(&self, executor: &E, watch: &Watch<'_>) -> Traced<(), F> {
        let most = self.runs.options.max_curves;
        let regions = self.count_regions(executor, watch, most.saturating_add(2));
        if regions > most.saturating_add(1) {
            return Err(TraceError::TooManyCurves { regions, most });
        }
        Ok(())
    }

    /// An estimate of the number of regions, without tracing. The count ends where it reaches
    /// `enough`.
    ///
    /// Labels are computed on a grid of 32 by 32 places. A region counts if it has a square of four
    /// neighbouring places, so that narrow ones are left out; two regions with one label count as
    /// one if places of both are neighbours. Regions that are connected only by a neck between two
    /// places count more than once. If more than an eighth of all places are in no such square, the
    /// grid is made twice as fine, up to 512 by 512. A place where the run fails is in none. If the
    /// watch cancels, the result is 0.
    #[must_use]
    pub fn count_regions<E: Executor<F>>(
        &self,
        executor: &E,
        watch: &Watch<'_>,
        enough: usize,
    ) -> usize {
        const COARSEST: usize = 32;
        const FINEST: usize = 512;
        let silent = watch.silently();
        let (mut side, mut most) = (COARSEST, 0);
        loop {
            let points = self.centres(side);
            let labels = |portion: &[Point]| executor.labels(self.runs.family(), portion);
            let Some(labels) = silent.in_portions(&points, labels) else { return 0 };
            let labels: Vec<_> = labels.into_iter().map(Result::ok).collect();
            let (regions, outside) = squares(&labels, side);
            most = most.max(regions);
            if most >= enough || 8 * outside <= side * side || side >= FINEST {
                return most;
            }
            side *= 2;
        }
    }

    /// The middles of the cells of a grid.
    fn centres(&self, side: usize) -> Vec<Point> {
        let cell = self.runs.window.extent() / side as f64;
        let place = |index: usize| {
            let part = Point::new((index / side) as f64 + 0.5, (index % side) as f64 + 0.5);
            self.runs.window.low + cell.component_mul(&part)
        };
        (0..side * side).map(place).collect()
    }
}

/// The number of connected parts of one label that contain a square of four places, and the number
/// of places in no such square.
fn squares<L: Eq>(labels: &[Option<L>], side: usize) -> (usize, usize) {
    let mut sets = DisjointSets::new(labels.len());
    let mut inside = vec![false; labels.len()];
    for index in 0..labels.len() {
        let (column, row) = (index / side, index % side);
        let (right, up) = (column + 1 < side, row + 1 < side);
        let alike = |other: usize| labels[index].is_some() && labels[index] == labels[other];
        let neighbours = [
            (right, index + side),
            (up, index + 1),
            (right && up, index + side + 1),
            (right && row > 0, (index + side).wrapping_sub(1)),
        ];
        for (exists, other) in neighbours {
            if exists && alike(other) {
                sets.unite(index, other);
            }
        }
        let square = [index, index + 1, index + side, index + side + 1];
        if right && up && square[1..].iter().all(|&other| alike(other)) {
            for place in square {
                inside[place] = true;
            }
        }
    }
    let mut counted = vec![false; labels.len()];
    for place in (0..labels.len()).filter(|&place| inside[place]) {
        counted[sets.least(place)] = true;
    }
    let regions = counted.iter().filter(|&&counted| counted).count();
    (regions, inside.iter().filter(|&&inside| !inside).count())
}
