//! How many boundaries and regions a window has, roughly, before any is traced.
//!
//! A trace takes some milliseconds for each curve, and a window may have more curves than anybody
//! can wait for: the number of curves of a collision grows as its stiffness. Labels alone are
//! counted, at places that are divided where regions are narrow. On an even grid each place of a
//! crowded corner would have another label, which shows neither regions nor curves.

mod grid;

use std::collections::HashMap;

use crate::executor::Executor;
use crate::family::Family;
use crate::options::TraceError;
use crate::tracing::runs::Traced;
use crate::tracing::tracer::Tracer;
use crate::tracing::tracer::count::grid::{Grid, Place};
use crate::watch::Watch;
use crate::window::Point;

/// What a [count](Tracer::count) of a window finds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// The number of regions.
    pub regions: usize,
    /// The number of boundaries between them.
    pub curves: usize,
}

impl<F: Family> Tracer<'_, F> {
    /// Refuses a window that has more curves than the options allow, as far as [`Self::count`]
    /// shows.
    ///
    /// # Errors
    /// [`TraceError::TooManyCurves`] has the numbers that were counted.
    pub fn require_few<E: Executor<F>>(&self, executor: &E, watch: &Watch<'_>) -> Traced<(), F> {
        let most = self.runs.options.max_curves;
        let Count { regions, curves } = self.count(executor, watch, most.saturating_add(1));
        if curves > most {
            return Err(TraceError::TooManyCurves { regions, curves, most });
        }
        Ok(())
    }

    /// An estimate of the numbers of regions and curves, without tracing. It ends where there are
    /// `enough` curves.
    ///
    /// Labels are computed at 32 by 32 places. A place that is in no square of four places with one
    /// label is divided into four, and so on, so that narrow regions are resolved, at no cost
    /// elsewhere. This ends when no such place is left. It ends after 4096 places if the number of
    /// such places does not even double, and each of the rest would have to hide four curves to
    /// make enough. It ends at the latest after ten divisions, or before there are 2¹⁹ places.
    ///
    /// A region counts if it has a square of four places, and so does a label that has no such
    /// region. Two regions that share more than one side of a place have a curve between them. The
    /// number of curves may be wrong by a tenth: two that cross at a small angle can count as
    /// three. Where places are too coarse both numbers are too small. Different labels alone are
    /// certain: a window has at least as many curves as labels but one. A place where the run fails
    /// is in no region. If the watch cancels, nothing is counted.
    #[must_use]
    pub fn count<E: Executor<F>>(&self, executor: &E, watch: &Watch<'_>, enough: usize) -> Count {
        /// The number of places that any window may take.
        const FEW: usize = 4096;
        /// The greatest number of places.
        const MOST: usize = 1 << 19;
        /// The greatest number of divisions.
        const DEEPEST: u32 = 10;
        let silent = watch.silently();
        let mut names = HashMap::new();
        let mut grid = Grid::new();
        let mut places = grid.coarsest();
        let mut narrow_before = usize::MAX / 2;
        loop {
            for portion in places.chunks(FEW) {
                let points: Vec<Point> = portion.iter().map(|place| self.middle(place)).collect();
                let mut name = |label| {
                    let next = names.len();
                    *names.entry(label).or_insert(next)
                };
                let labels = silent.in_portions(&points, |points| {
                    let labels = executor.labels(self.runs.family(), points).into_iter();
                    labels.map(|label| label.ok().map(&mut name)).collect()
                });
                let Some(labels) = labels else { return Count::default() };
                grid.label(portion, &labels);
                if names.len() > enough {
                    return Count { regions: names.len(), curves: names.len() - 1 };
                }
            }
            let narrow = grid.narrow(&places);
            let count = grid.count(names.len());
            let grows = narrow.len() >= 2 * narrow_before;
            let could_be_enough = count.curves + 4 * narrow.len() >= enough;
            let goes_on = grid.places() < FEW || grows || could_be_enough;
            let last = narrow.is_empty()
                || grid.places() + 4 * narrow.len() > MOST
                || narrow[0].level == DEEPEST;
            if count.curves >= enough || last || !goes_on {
                return count;
            }
            narrow_before = narrow.len();
            places = grid.divide(&narrow);
            // Places far apart have more different labels, which may be enough.
            fastrand::Rng::with_seed(1).shuffle(&mut places);
        }
    }

    /// The middle of a place.
    fn middle(&self, place: &Place) -> Point {
        let part = Point::new(place.column as f64 + 0.5, place.row as f64 + 0.5);
        let cell = self.runs.window.extent() / place.side() as f64;
        self.runs.window.low + cell.component_mul(&part)
    }
}
