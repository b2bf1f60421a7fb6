//! What a caller sees of a long computation, and how it cancels one.

use std::time::Duration;

use crate::stopwatch::Stopwatch;
use crate::window::Point;

/// What a computation reports while it runs, from any thread and in any order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// A stage of the computation begins.
    Begin {
        /// The number of steps that it takes.
        steps: usize,
    },
    /// Steps of the stage are done.
    Advance {
        /// The number of steps since the last report.
        steps: usize,
    },
    /// What is done from now on.
    Now {
        /// It, in words such as "comparing regions with runs".
        what: &'static str,
    },
}

/// Receives the reports of a computation.
pub type Report<'a> = &'a (dyn Fn(Progress) + Sync);

/// Receives curves, as points.
type Show<'a> = &'a (dyn Fn(&[Point]) + Sync);

/// A caller that watches a computation, and may cancel it.
///
/// A report, or a reference to a closure that takes [`Progress`], is a watch that never cancels.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    report: Report<'a>,
    cancelled: &'a (dyn Fn() -> bool + Sync),
    curve: Option<Show<'a>>,
}

impl Watch<'static> {
    /// A watch that ignores all reports and never cancels.
    pub const SILENT: Self = Self { report: &|_| {}, cancelled: &|| false, curve: None };
}

impl<'a> Watch<'a> {
    /// The number of points of the first portion, and the most of any.
    const PORTIONS: [usize; 2] = [32, 4096];
    /// How long a portion should take: between two portions, `cancelled` is called.
    const PORTION: Duration = Duration::from_millis(20);

    /// The same watch, which cancels when `cancelled` returns `true`; from then on it should always
    /// do so. It is called after each run by which boundaries are followed, and every 20 ms where
    /// many runs are computed at once, so that a computation ends as soon as a run does.
    #[must_use]
    pub fn cancelled_by(self, cancelled: &'a (dyn Fn() -> bool + Sync)) -> Self {
        Self { cancelled, ..self }
    }

    /// The same watch, which is shown each curve when it has been followed, as points between which
    /// straight lines look smooth. A later stage may cut the curve, or drop it.
    #[must_use]
    pub fn showing(self, curve: Show<'a>) -> Self {
        Self { curve: Some(curve), ..self }
    }

    /// Shows a curve.
    pub(crate) fn show(&self, points: impl FnOnce() -> Vec<Point>) {
        if let Some(curve) = self.curve {
            curve(&points());
        }
    }

    /// The same watch without reports.
    pub(crate) fn silently(&self) -> Self {
        Self { report: &|_| {}, ..*self }
    }

    /// Whether the computation should end.
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        (self.cancelled)()
    }

    /// Reports progress.
    pub fn report(&self, progress: Progress) {
        (self.report)(progress);
    }

    /// Calls `compute` for one portion of `points` after the other, and reports each point as a
    /// step. `None` if the watch cancels before the end.
    pub fn in_portions<T>(
        &self,
        points: &[Point],
        mut compute: impl FnMut(&[Point]) -> Vec<T>,
    ) -> Option<Vec<T>> {
        self.report(Progress::Begin { steps: points.len() });
        let [mut size, most] = Self::PORTIONS;
        let mut results = Vec::with_capacity(points.len());
        while results.len() < points.len() {
            if self.is_cancelled() {
                return None;
            }
            let (begun, left) = (Stopwatch::start(), &points[results.len()..]);
            let portion = &left[..size.min(left.len())];
            results.extend(compute(portion));
            self.report(Progress::Advance { steps: portion.len() });
            // Only when others hear of it depends on the time.
            size = if begun.elapsed() > Self::PORTION { size / 2 } else { 2 * size };
            size = size.clamp(1, most);
        }
        Some(results)
    }
}

impl<'a> From<Report<'a>> for Watch<'a> {
    fn from(report: Report<'a>) -> Self {
        Self { report, ..Watch::SILENT }
    }
}

impl<'a, R: Fn(Progress) + Sync> From<&'a R> for Watch<'a> {
    fn from(report: &'a R) -> Self {
        Self { report, ..Watch::SILENT }
    }
}

impl std::fmt::Debug for Watch<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Watch").finish_non_exhaustive()
    }
}
