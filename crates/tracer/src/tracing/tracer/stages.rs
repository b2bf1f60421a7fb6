//! The stages of a search, in steps between which it can stop and go on.
//!
//! The number of the next step, with the network and the errors of its vertices, is all that is
//! needed to go on, from memory or from a file. The runs of the grid are computed again. So is a
//! verification that was cancelled, and a second look starts again from the network before it.

use crate::executor::Executor;
use crate::family::Family;
use crate::options::TraceError;
use crate::stopwatch::Stopwatch;
use crate::tracing::runs::{Sampled, Traced, checked};
use crate::tracing::tracer::Tracer;
use crate::tracing::tracer::island;
use crate::tracing::tracer::sliver;
use crate::tracing::tracer::stage::Stage;
use crate::watch::Progress;
use crate::window::Point;

impl<F: Family> Tracer<'_, F> {
    /// Goes on with the search to its end, or until the watch cancels. Returns whether the end is
    /// reached; if not, a later call goes on, to the same result.
    ///
    /// A task that is cancelled leaves nothing: the tracer goes back to a state between two tasks
    /// that it has kept, and does again what it has done since.
    ///
    /// # Errors
    /// A run fails, or a margin is not a number.
    pub fn proceed<E: Executor<F>>(&mut self, executor: &E) -> Traced<bool, F> {
        /// How many times as long as to keep a state is the time up to the next one.
        const KEEP: u32 = 20;
        let watch = self.runs.watch;
        let keep = |tracer: &Self| {
            let begun = Stopwatch::start();
            (tracer.now(), KEEP * begun.elapsed(), Stopwatch::start())
        };
        let (mut kept, mut left) = (keep(self), self.steps_left());
        watch.report(Progress::Now { what: self.doing() });
        watch.report(Progress::Begin { steps: left });
        while self.stage != Stage::Done {
            if kept.2.elapsed() > kept.1 {
                kept = keep(self);
            }
            let stage = std::mem::discriminant(&self.stage);
            match self.task(executor) {
                Ok(()) => {}
                Err(TraceError::Cancelled) => {
                    self.restore(kept.0);
                    return Ok(false);
                }
                Err(error) => return Err(error),
            }
            let ahead = self.steps_left();
            if std::mem::discriminant(&self.stage) != stage {
                watch.report(Progress::Advance { steps: left });
                watch.report(Progress::Now { what: self.doing() });
                watch.report(Progress::Begin { steps: ahead });
                // Islands are searched around places of the grid.
                if !matches!(self.stage, Stage::Islands { .. }) {
                    self.sampled.clear();
                }
            } else if ahead < left {
                watch.report(Progress::Advance { steps: left - ahead });
            } else {
                watch.report(Progress::Begin { steps: ahead - left });
            }
            left = ahead;
        }
        self.before_look = None;
        Ok(true)
    }

    /// Does one task: it computes the runs with which a stage begins, and examines a new vertex or
    /// does a step of the stage.
    fn task<E: Executor<F>>(&mut self, executor: &E) -> Traced<(), F> {
        if self.runs.watch.is_cancelled() {
            return Err(TraceError::Cancelled);
        }
        self.sample(executor)?;
        let along_edges = matches!(self.stage, Stage::Edges { .. });
        if along_edges || !self.examine_vertex()? {
            self.step()?;
        }
        Ok(())
    }

    /// What the stage does, in words.
    fn doing(&self) -> &'static str {
        match self.stage {
            Stage::Edges { .. } => "searching along the edges of the window",
            Stage::Grid { .. } => "searching along the grid",
            Stage::Islands { .. } => "searching for islands",
            Stage::Pairs { .. } => "looking again where runs have other labels",
            Stage::CloseVertices { .. } => "searching between close vertices",
            Stage::Settle => "looking again where something is open",
            Stage::Polish => "solving for better places of vertices",
            Stage::Done => "putting curves together",
        }
    }

    /// The number of steps of the stage that are not done yet.
    fn steps_left(&self) -> usize {
        let cells = self.runs.options.cells;
        match &self.stage {
            Stage::Edges { next } => 8 * cells - next,
            Stage::Grid { next } => 2 * cells * cells - next,
            Stage::Islands { next, pending } => cells * cells - next + pending.len(),
            Stage::Pairs { next, pairs } => pairs.len() - next,
            Stage::CloseVertices { next } => self.builder.stops.len() - next,
            Stage::Settle | Stage::Polish => 1,
            Stage::Done => 0,
        }
    }

    /// Computes the runs with which the stage begins, unless they are known.
    fn sample<E: Executor<F>>(&mut self, executor: &E) -> Traced<(), F> {
        let samples =
            matches!(self.stage, Stage::Edges { .. } | Stage::Grid { .. } | Stage::Islands { .. });
        if !samples || !self.sampled.is_empty() {
            return Ok(());
        }
        let points = self.places();
        let free = |portion: &[Point]| executor.free_runs(self.runs.family(), portion);
        let runs = self.runs.watch.in_portions(&points, free).ok_or(TraceError::Cancelled)?;
        let runs = points.into_iter().zip(runs);
        let checked = runs.map(|(point, run)| Ok((point, checked::<F>(&point, run)?)));
        self.sampled = checked.collect::<Traced<_, F>>()?;
        Ok(())
    }

    /// The places of the stage's runs: along the window's edges, or in the middle of every cell.
    fn places(&self) -> Vec<Point> {
        let cells = self.runs.options.cells;
        if matches!(self.stage, Stage::Edges { .. }) {
            return self.edge_places();
        }
        let cell = self.cell();
        let place = |index: usize| {
            let (column, row) = (index / cells, index % cells);
            let part = Point::new(column as f64 + 0.5, row as f64 + 0.5);
            self.window.low + cell.component_mul(&part)
        };
        (0..cells * cells).map(place).collect()
    }

    /// The extent of a cell of the grid.
    fn cell(&self) -> Point {
        self.window.extent() / self.runs.options.cells as f64
    }

    /// The places at the ends of all segments, a ten-millionth of the window's shorter extent
    /// inside the edges up to which boundaries are followed.
    fn edge_places(&self) -> Vec<Point> {
        let inset = Point::repeat(self.runs.lengths.half);
        let (low, high) = (self.runs.window.low + inset, self.runs.window.high - inset);
        let corners = [low, Point::new(high.x, low.y), high, Point::new(low.x, high.y), low];
        let parts = 2 * self.runs.options.cells;
        let sides = corners.windows(2).flat_map(|side| {
            (1..=parts).map(move |i| side[0].lerp(&side[1], i as f64 / parts as f64))
        });
        std::iter::once(low).chain(sides).collect()
    }

    /// Does one step of the stage, or goes on to the next stage.
    fn step(&mut self) -> Traced<(), F> {
        let cells = self.runs.options.cells;
        self.stage = match std::mem::replace(&mut self.stage, Stage::Done) {
            Stage::Edges { next } => {
                if next == 0 {
                    self.runs.count_free(self.sampled.len());
                }
                let [last, here] = [next, next + 1].map(|index| self.sampled[index].clone());
                self.divide(&last, &here)?;
                let side = 2 * cells;
                let before = (next % side > 0).then(|| next - 1);
                let after = ((next + 1) % side > 0).then_some(next + 2);
                self.search_slivers(before, [next, next + 1], after)?;
                if next + 1 < 8 * cells {
                    Stage::Edges { next: next + 1 }
                } else {
                    Stage::Grid { next: 0 }
                }
            }
            Stage::Grid { next } => {
                if next == 0 {
                    self.runs.count_free(self.sampled.len());
                }
                let index = next / 2;
                let (column, row) = (index / cells, index % cells);
                let (inside, neighbour) =
                    [(row + 1 < cells, index + 1), (column + 1 < cells, index + cells)][next % 2];
                if inside {
                    let [(here, run), (there, other)]: [&Sampled<F>; 2] =
                        [&self.sampled[index], &self.sampled[neighbour]];
                    let (segment, labels) =
                        ([*here, *there], [run.label.clone(), other.label.clone()]);
                    self.scan(segment, labels)?;
                    let (place, stride) = [(row, 1), (column, cells)][next % 2];
                    let before = (place > 0).then(|| index - stride);
                    let after = (place + 2 < cells).then_some(index + 2 * stride);
                    self.search_slivers(before, [index, neighbour], after)?;
                }
                if next + 1 < 2 * cells * cells {
                    Stage::Grid { next: next + 1 }
                } else {
                    Stage::Islands { next: 0, pending: Vec::new() }
                }
            }
            Stage::Islands { next, mut pending } if !pending.is_empty() => {
                self.search(pending.remove(0))?;
                Stage::Islands { next, pending }
            }
            Stage::Islands { next, .. } if next < self.sampled.len() => {
                let is_known = |[a, b]: &[Point; 2]| !self.builder.passages(a, b).is_empty();
                let (grid, cell) = (&self.sampled, self.cell());
                let pending = island::beside(&self.runs, grid, cells, next, &cell, is_known)?;
                Stage::Islands { next: next + 1, pending }
            }
            Stage::Pairs { next, pairs } if next < pairs.len() => {
                self.search(pairs[next])?;
                Stage::Pairs { next: next + 1, pairs }
            }
            Stage::Islands { .. } | Stage::Pairs { .. } => Stage::CloseVertices { next: 0 },
            Stage::CloseVertices { next } if next < self.builder.stops.len() => {
                self.search_beside(next)?;
                Stage::CloseVertices { next: next + 1 }
            }
            Stage::CloseVertices { .. } => Stage::Settle,
            Stage::Settle => {
                self.settle()?;
                Stage::Polish
            }
            Stage::Polish => {
                self.polish()?;
                self.move_to_tangencies()?;
                self.fit_ends()?;
                self.builder.drop_explained();
                Stage::Done
            }
            Stage::Done => Stage::Done,
        };
        Ok(())
    }

    /// Searches between two neighbouring places of the stage for regions in which no place lies.
    /// The line leads from the place before the two to the place after them.
    fn search_slivers(
        &mut self,
        before: Option<usize>,
        [one, other]: [usize; 2],
        after: Option<usize>,
    ) -> Traced<(), F> {
        for (behind, here, there) in [(before, one, other), (after, other, one)] {
            let [here, there] = [here, there].map(|index| &self.sampled[index]);
            let behind = behind.map(|index| &self.sampled[index]);
            let ends = [here.0, there.0];
            let passages = self.builder.passages(&here.0, &there.0);
            let known: Vec<f64> = passages.iter().map(|passage| passage.place).collect();
            for place in sliver::between(&self.runs, &known, behind, here, there)? {
                self.search([ends[0], place])?;
                self.search([place, ends[1]])?;
            }
        }
        Ok(())
    }

    /// Searches along a segment.
    fn search(&mut self, segment: [Point; 2]) -> Traced<(), F> {
        let labels = [self.runs.label(&segment[0])?, self.runs.label(&segment[1])?];
        self.scan(segment, labels)
    }
}
