//! Tracing by margins: labels do not decide where curves lead.
//!
//! A `line` is the zero set of one margin, followed as far as the margin exists, whatever runs do
//! there. Most of its length is invisible: runs do not have the itinerary that leads to it. Lines
//! are found by `walk`s along the edges of a lattice, from one zero of a run's margins to the next.
//! They are divided where they meet (`meet`, `ends`, `arrange`), and labels are asked for once on
//! each side of every part (`parts`). Parts with the same label on both sides are dropped.
//!
//! So a vertex is where lines meet, and not where runs seem to change, and no strip is too narrow.
//! [`Surveyor`](crate::Surveyor) traces windows in this way in which something is in doubt.

mod arrange;
mod ends;
mod line;
mod meet;
mod parts;
mod special;
mod walk;

use std::cell::RefCell;
use std::collections::{BTreeSet, HashMap};

use crate::curve::{Curve, Vertex};
use crate::executor::{Executor, Serial};
use crate::family::Family;
use crate::options::{TraceError, TraceOptions};
use crate::tracing::cut::cut;
use crate::tracing::extrema::{Extremum, extrema};
use crate::tracing::margins::line::{Line, Reach};
use crate::tracing::network::{NetworkOf, TraceStatistics, Unresolved};
use crate::tracing::runs::{Runs, Sampled, Traced, checked};
use crate::tracing::seed::Seed;
use crate::tracing::tracer::island;
use crate::tracing::tracer::trace::{is_expected, polygon};
use crate::watch::{Progress, Watch};
use crate::window::{Point, Window};

/// How often the places where lines meet are looked around, at most.
const ROUNDS: usize = 8;

/// How often an edge of the lattice on an edge of the window is halved, at most.
const EDGE: u32 = 5;

/// A search for the zero sets of margins in a window.
pub(crate) struct Lines<'f, F: Family> {
    runs: Runs<'f, F>,
    /// The window of the caller. The window of the runs is larger.
    window: Window,
    all: Vec<Line<F::Margin>>,
    /// The number of lines that were found, or found to be longer.
    changes: usize,
    /// Labels that were asked for, by the digits of their places.
    labels: HashMap<[u64; 2], F::Label>,
    /// The places around which lines were searched for.
    visited: BTreeSet<[u64; 2]>,
    seeds: usize,
    /// Places that were solved for, with their errors, by what they were solved from.
    solved: RefCell<HashMap<[u64; 5], Option<Solved>>>,
    /// The curves of the last network.
    curves: Vec<Curve<F::Label, F::Margin>>,
}

/// What lines divide the window into, as far as runs see it.
pub(crate) struct Arranged<F: Family> {
    pub curves: Vec<Curve<F::Label, F::Margin>>,
    pub vertices: Vec<Vertex<F::Margin>>,
    /// Places around which lines are missing, or may be.
    pub doubts: Vec<Point>,
    /// Segments on which a line is missing: beside a line, labels at two distances differ.
    pub strips: Vec<[Point; 2]>,
}

/// A place that was solved for, and its largest error.
pub(crate) type Solved = (Point, f64);

/// A vertex, and the largest error of its place.
pub(crate) struct Located<M> {
    pub vertex: Vertex<M>,
    pub error: f64,
}

/// Traces every boundary of a family in a window by its margins alone: zero sets of margins are
/// followed without labels, divided where they meet, and kept where the labels on their sides
/// differ.
///
/// [`trace`](crate::trace()) follows boundaries by their labels. This way tells boundaries apart
/// that touch, between which a strip is narrower than labels can tell. Neither finds every boundary
/// of every family: verify the regions. A [`Surveyor`](crate::Surveyor) does, and takes this way
/// where the other one leaves a doubt.
///
/// # Errors
/// An option is out of its range, the window is not a rectangle, a run fails, or a margin is not a
/// number.
pub fn trace_by_margins<F: Family>(
    family: &F,
    window: &Window,
    options: &TraceOptions,
) -> Result<NetworkOf<F>, TraceError<F::Error>> {
    let mut lines = Lines::new(family, window, options, Watch::SILENT)?;
    lines.explore(&Serial)?;
    lines.network()
}

impl<'f, F: Family> Lines<'f, F> {
    /// A search that has found nothing yet. Lines are followed a little [beyond] the window.
    ///
    /// [beyond]: TraceOptions::beyond
    pub fn new(
        family: &'f F,
        window: &Window,
        options: &TraceOptions,
        watch: Watch<'f>,
    ) -> Traced<Self, F> {
        let runs = Runs::new(family, *window, *options)?.watched(watch);
        Ok(Self {
            runs: runs.within(window.with_room(options.beyond)),
            window: *window,
            all: Vec::new(),
            changes: 0,
            labels: HashMap::new(),
            visited: BTreeSet::new(),
            seeds: 0,
            solved: RefCell::default(),
            curves: Vec::new(),
        })
    }

    /// Whether boundaries may end in cusps that the family knows. These are solved for, but their
    /// accuracy has not been compared with that of boundaries followed by labels.
    pub fn have_cusps(&self) -> bool {
        self.curves.iter().any(|curve| !self.runs.cusps(&curve.margin).is_empty())
    }

    /// Searches along the edges of a lattice, and around all places where lines meet.
    pub fn explore<E: Executor<F>>(&mut self, executor: &E) -> Traced<(), F> {
        self.runs.watch.report(Progress::Now { what: "following the zeros of margins" });
        let size = self.runs.options.cells + 1;
        let samples = self.lattice(executor)?;
        let edges = (0..size * size).flat_map(|index| {
            let (column, row) = (index / size, index % size);
            let up = (row + 1 < size).then_some([index, index + 1]);
            let right = (column + 1 < size).then_some([index, index + size]);
            up.into_iter().chain(right)
        });
        let edges: Vec<[usize; 2]> = edges.collect();
        self.runs.watch.report(Progress::Begin { steps: edges.len() + samples.len() });
        for [one, other] in edges {
            let ends = [one, other].map(|index| [index / size, index % size]);
            let along = |axis: usize| ends[0][axis] == ends[1][axis];
            let outermost = |axis: usize| ends[0][axis] == 0 || ends[0][axis] + 1 == size;
            let divisions =
                if (0..2).any(|axis| along(axis) && outermost(axis)) { EDGE } else { 0 };
            self.divide(&samples[one], &samples[other], divisions)?;
            self.runs.watch.report(Progress::Advance { steps: 1 });
        }
        let cell = self.runs.window.extent() / self.runs.options.cells as f64;
        for index in 0..samples.len() {
            let is_known = |[a, b]: &[Point; 2]| self.all.iter().any(|line| line.crosses(a, b));
            let pending = island::beside(&self.runs, &samples, size, index, &cell, is_known)?;
            for ends in pending {
                self.search(ends)?;
            }
            self.runs.watch.report(Progress::Advance { steps: 1 });
        }
        self.complete()
    }

    /// Searches between pairs of places where runs differ. Returns whether something was found.
    pub fn look(&mut self, brackets: &[[Point; 2]]) -> Traced<bool, F> {
        /// More brackets show nothing new.
        const MOST: usize = 200;
        let before = self.changes;
        self.runs.watch.report(Progress::Begin { steps: brackets.len().min(MOST) });
        for &[a, b] in brackets.iter().take(MOST) {
            let seed = Seed::between(&self.runs, &[a, b])?;
            let begun = match &seed {
                Some(seed) => self.begin(&seed.point, &seed.margin, &(b - a))?,
                None => false,
            };
            if !begun {
                self.search([a, b])?;
            }
            self.runs.watch.report(Progress::Advance { steps: 1 });
        }
        let found = self.changes != before;
        self.complete()?;
        Ok(found)
    }

    /// The network of the lines that runs see.
    pub fn network(&mut self) -> Traced<NetworkOf<F>, F> {
        let Arranged { curves, vertices, strips, .. } = self.arranged()?;
        let mut unresolved = self.unfollowed();
        for between in strips {
            let labels = [self.runs.label(&between[0])?, self.runs.label(&between[1])?];
            unresolved.push(Unresolved::Change { between, labels });
        }
        let [free_runs, prescribed_runs] = self.runs.counts();
        let nodes = self.all.iter().map(|line| line.nodes.len()).sum();
        let statistics =
            TraceStatistics { free_runs, prescribed_runs, nodes, rejected: 0, seeds: self.seeds };
        let window = self.runs.window;
        let whole = NetworkOf::<F> { window, curves, vertices, statistics, unresolved };
        let network = cut(&self.runs, &whole, &self.window);
        self.curves.clone_from(&network.curves);
        Ok(network)
    }

    /// The places where the curves of the last network are extremal in a coordinate.
    pub fn extrema(&self) -> Traced<Vec<Extremum>, F> {
        extrema(&self.runs.aside(), &self.curves)
    }

    /// The free runs of a lattice, in columns. Its outermost places lie just inside the edges.
    fn lattice<E: Executor<F>>(&self, executor: &E) -> Traced<Vec<Sampled<F>>, F> {
        let cells = self.runs.options.cells;
        let inset = Point::repeat(self.runs.lengths.half);
        let low = self.runs.window.low + inset;
        let size = self.runs.window.extent() - 2.0 * inset;
        let place = |index: usize| {
            let part = Point::new((index / (cells + 1)) as f64, (index % (cells + 1)) as f64);
            low + size.component_mul(&part) / cells as f64
        };
        let points: Vec<Point> = (0..(cells + 1) * (cells + 1)).map(place).collect();
        let free = |portion: &[Point]| executor.free_runs(self.runs.family(), portion);
        let found = self.runs.watch.in_portions(&points, free).ok_or(TraceError::Cancelled)?;
        self.runs.count_free(points.len());
        let found = points.into_iter().zip(found);
        let found = found.map(|(point, run)| Ok((point, checked::<F>(&point, run)?)));
        found.collect()
    }

    /// Looks around the places where lines meet, and beside their ends, until nothing new is found.
    fn complete(&mut self) -> Traced<(), F> {
        for _ in 0..ROUNDS {
            let before = self.changes;
            let Arranged { vertices, doubts, strips, .. } = self.arranged()?;
            let inside = vertices.iter().filter(|vertex| !vertex.kind.is_on_window());
            let places: Vec<Point> = inside.map(|vertex| vertex.point).chain(doubts).collect();
            let ends = self.lost_ends();
            let steps = ends.len() + strips.len() + places.len();
            self.runs.watch.report(Progress::Begin { steps });
            for strip in strips {
                if self.is_new(&strip[1]) {
                    self.search(strip)?;
                }
                self.runs.watch.report(Progress::Advance { steps: 1 });
            }
            for [index, end] in ends {
                self.look_beside(index, end)?;
                self.runs.watch.report(Progress::Advance { steps: 1 });
            }
            for place in places {
                self.look_around(&place)?;
                self.runs.watch.report(Progress::Advance { steps: 1 });
            }
            if self.changes == before {
                break;
            }
        }
        Ok(())
    }

    /// The ends of lines that were lost, each a line and 0 or 1.
    fn lost_ends(&self) -> Vec<[usize; 2]> {
        let ends = (0..self.all.len()).flat_map(|index| [[index, 0], [index, 1]]);
        let is_lost = |[index, end]: &[usize; 2]| {
            self.all[*index].ends.is_some_and(|ends| ends[*end] == Reach::Lost)
        };
        ends.filter(is_lost).collect()
    }

    /// Searches between two places, in parts if the run in their middle differs from what the runs
    /// at both suggest.
    fn divide(&mut self, one: &Sampled<F>, other: &Sampled<F>, divisions: u32) -> Traced<(), F> {
        if divisions == 0 {
            return self.between(one, other);
        }
        let place = one.0.lerp(&other.0, 0.5);
        let middle = (place, self.runs.free(&place)?);
        if is_expected(&one.1, &middle.1, &other.1) {
            return self.between(one, other);
        }
        self.divide(one, &middle, divisions - 1)?;
        self.divide(&middle, other, divisions - 1)
    }

    /// Searches along a segment.
    fn search(&mut self, ends: [Point; 2]) -> Traced<(), F> {
        let ends = ends.map(|end| self.inside(&end));
        if (ends[1] - ends[0]).norm() <= self.runs.lengths.same {
            return Ok(());
        }
        let [one, other] = ends;
        let samples = [(one, self.runs.free(&one)?), (other, self.runs.free(&other)?)];
        self.between(&samples[0], &samples[1])
    }

    /// Searches on two polygons around a place, unless that was done.
    fn look_around(&mut self, place: &Point) -> Traced<(), F> {
        if !self.is_new(place) {
            return Ok(());
        }
        for radius in [self.runs.lengths.around, self.runs.lengths.close] {
            for side in polygon(place, radius, 8, 0.47).windows(2) {
                self.search([side[0], side[1]])?;
            }
        }
        Ok(())
    }

    /// Searches beside the last part of a line, where it makes a wedge with another one, unless
    /// that was done.
    fn look_beside(&mut self, index: usize, end: usize) -> Traced<(), F> {
        let line = &self.all[index];
        let tip = line.tip(end);
        let nodes: Vec<_> =
            if end == 0 { line.nodes.clone() } else { line.nodes.iter().rev().copied().collect() };
        if !self.is_new(&tip) {
            return Ok(());
        }
        let lengths = self.runs.lengths;
        for away in [lengths.beyond, lengths.around, 10.0 * lengths.close] {
            let Some(node) = nodes.iter().find(|node| (node.point - tip).norm() > away) else {
                continue;
            };
            let distance = (node.point - tip).norm();
            let left = Point::new(-node.tangent.y, node.tangent.x);
            for normal in [left, -left] {
                // Two lines that touch are this far apart, or farther.
                let touching = 0.01 * distance * (distance / lengths.scale).sqrt();
                let close = node.point + normal * touching.max(2.0 * lengths.same);
                self.search([close, node.point + normal * (0.3 * distance)])?;
            }
        }
        Ok(())
    }

    /// Whether no place so close was visited. From now on, one was.
    fn is_new(&mut self, place: &Point) -> bool {
        let unit = self.runs.lengths.half;
        let digits = [place.x, place.y].map(|part| (part / unit).round().to_bits());
        self.visited.insert(digits)
    }

    /// The place of the window that is nearest to a place.
    fn inside(&self, place: &Point) -> Point {
        place.sup(&self.runs.window.low).inf(&self.runs.window.high)
    }
}
