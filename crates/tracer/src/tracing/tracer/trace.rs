//! All boundaries in a window: where they are searched for.

use crate::curve::{Node, VertexKind};
use crate::executor::Serial;
use crate::family::{Family, FreeRun};
use crate::lengths::Lengths;
use crate::options::{TraceError, TraceOptions};
use crate::tracing::builder::Builder;
use crate::tracing::corrector::crossing;
use crate::tracing::cut::cut;
use crate::tracing::end::{Special, Stop};
use crate::tracing::extrema::{Extremum, extrema};
use crate::tracing::network::{NetworkOf, Unresolved};
use crate::tracing::runs::{Runs, Sampled, Traced};
use crate::tracing::tracer::Tracer;
use crate::tracing::tracer::stage::Stage;
use crate::watch::Watch;
use crate::window::{Point, Window};

/// Traces every boundary of a family in a window, with a new [`Tracer`].
///
/// # Errors
/// An option is out of its range, the window is not a rectangle, a run fails, or a margin is not a
/// number.
pub fn trace<F: Family>(
    family: &F,
    window: &Window,
    options: &TraceOptions,
) -> Result<NetworkOf<F>, TraceError<F::Error>> {
    let mut tracer = Tracer::new(family, window, options)?;
    tracer.explore()?;
    Ok(tracer.network())
}

impl<'f, F: Family> Tracer<'f, F> {
    /// A tracer that has found nothing yet.
    ///
    /// # Errors
    /// An option is out of its range, or the window is not a rectangle.
    pub fn new(family: &'f F, window: &Window, options: &TraceOptions) -> Traced<Self, F> {
        let runs = Runs::new(family, *window, *options)?;
        let outer = window.with_room(options.beyond);
        let builder = Builder::new(outer, runs.lengths);
        Ok(Self {
            runs: runs.within(outer),
            builder,
            window: *window,
            probed: 0,
            stage: Stage::Edges { next: 0 },
            sampled: Vec::new(),
            before_look: None,
        })
    }

    /// The same tracer, which reports to `watch` and ends when it cancels.
    #[must_use]
    pub fn watched(self, watch: Watch<'f>) -> Self {
        Self { runs: self.runs.watched(watch), ..self }
    }

    /// The window that is searched.
    pub(crate) fn window(&self) -> Window {
        self.window
    }

    /// Searches the whole window.
    ///
    /// # Errors
    /// A run fails, or a margin is not a number.
    pub fn explore(&mut self) -> Traced<(), F> {
        self.stage = Stage::Edges { next: 0 };
        self.proceed(&Serial).map(drop)
    }

    /// Searches between pairs of places for boundaries that are not known yet. Returns whether the
    /// number of curves has changed.
    ///
    /// # Errors
    /// A run fails, or a margin is not a number.
    pub fn look_between(&mut self, pairs: &[[Point; 2]]) -> Traced<bool, F> {
        let before = self.builder.network.curves.len();
        self.begin_between(pairs.to_vec());
        self.proceed(&Serial)?;
        Ok(self.builder.network.curves.len() != before)
    }

    /// Makes a search between pairs of places what [`Self::proceed`] does next.
    pub(crate) fn begin_between(&mut self, pairs: Vec<[Point; 2]>) {
        self.stage = Stage::Pairs { next: 0, pairs };
    }

    /// The network that has been found so far.
    #[must_use]
    pub fn network(&self) -> NetworkOf<F> {
        // A trace that was cancelled is cut once more.
        let mut network = cut(&self.runs.aside(), &self.builder.network, &self.window);
        self.count_runs(&mut network);
        network
    }

    /// The network before it is cut: it reaches some way beyond the window.
    pub(super) fn uncut(&self) -> NetworkOf<F> {
        let mut network = self.builder.network.clone();
        self.count_runs(&mut network);
        network
    }

    fn count_runs(&self, network: &mut NetworkOf<F>) {
        [network.statistics.free_runs, network.statistics.prescribed_runs] = self.runs.counts();
    }

    /// The places where the curves found so far are extremal in a coordinate. They are solved for
    /// on the boundaries; along them, the error is about 1e-9 of the radius of curvature.
    ///
    /// The ends of curves are not extrema. A curve that is parallel to an axis to 1e-6 has no
    /// extrema. On both sides of an extremum, before the next one or the end, the coordinate must
    /// change by more than ten times `options.interpolation`.
    ///
    /// # Errors
    /// A run fails, or a margin is not a number.
    pub fn extrema(&self) -> Traced<Vec<Extremum>, F> {
        extrema(&self.runs.aside(), &self.network().curves)
    }

    /// Scans a segment. It is first halved if the run in its middle differs from what the runs at
    /// its ends suggest.
    pub(super) fn divide(&mut self, a: &Sampled<F>, b: &Sampled<F>) -> Traced<(), F> {
        /// How often a segment is halved, at most.
        const DIVISIONS: u32 = 4;
        self.divide_up_to(a, b, DIVISIONS)
    }

    fn divide_up_to(&mut self, a: &Sampled<F>, b: &Sampled<F>, depth: u32) -> Traced<(), F> {
        if depth == 0 {
            return self.scan([a.0, b.0], [a.1.label.clone(), b.1.label.clone()]);
        }
        let place = a.0.lerp(&b.0, 0.5);
        let middle = (place, self.runs.free(&place)?);
        if is_expected(&a.1, &middle.1, &b.1) {
            return self.scan([a.0, b.0], [a.1.label.clone(), b.1.label.clone()]);
        }
        self.divide_up_to(a, &middle, depth - 1)?;
        self.divide_up_to(&middle, b, depth - 1)
    }

    /// Searches on two circles around the next new vertex, unless it lies on the window's edge, and
    /// on a smaller one if the edge is closer. Returns whether there was a new vertex.
    pub(super) fn examine_vertex(&mut self) -> Traced<bool, F> {
        let Some(vertex) = self.builder.network.vertices.get(self.probed) else {
            return Ok(false);
        };
        let (point, kind) = (vertex.point, vertex.kind);
        self.probed += 1;
        if !kind.is_on_window() {
            let Lengths { around, close, same, .. } = self.runs.lengths;
            for radius in [around, close] {
                self.circle(&point, radius)?;
            }
            // Curves that leave the window between the vertex and these circles.
            let Window { low, high } = self.runs.window;
            let to_edge = (point - low).inf(&(high - point)).min();
            if (same..close).contains(&to_edge) {
                self.circle(&point, 0.5 * to_edge)?;
            }
        }
        Ok(true)
    }

    /// Scans once more where a change of the label was left open: curves that were found later may
    /// explain it.
    pub(super) fn settle(&mut self) -> Traced<(), F> {
        let unresolved = &mut self.builder.network.unresolved;
        let is_change = |what: &Unresolved<F::Label>| matches!(what, Unresolved::Change { .. });
        let (changes, others): (Vec<_>, Vec<_>) =
            std::mem::take(unresolved).into_iter().partition(is_change);
        *unresolved = others;
        for change in changes {
            let Unresolved::Change { between: [a, b], labels } = &change else { continue };
            if a == b {
                // A branch was tried there already.
                if !self.builder.covers(a, labels) {
                    self.builder.network.unresolved.push(change);
                }
                continue;
            }
            let beside = (b - a).try_normalize(0.0).unwrap_or_default() * self.runs.lengths.touch;
            let ends = [a - beside, b + beside];
            let labels = [self.runs.label(&ends[0])?, self.runs.label(&ends[1])?];
            if labels[0] == labels[1] && self.builder.passages(&ends[0], &ends[1]).is_empty() {
                self.builder.network.unresolved.push(change);
            } else {
                self.scan(ends, labels)?;
            }
        }
        Ok(())
    }

    /// Searches on a circle around a vertex with another one inside its circles. The circle passes
    /// between the two, where it crosses curves from one to the other.
    pub(super) fn search_beside(&mut self, vertex: usize) -> Traced<(), F> {
        let point = self.builder.stops[vertex].point;
        let distances = self.builder.stops.iter().map(|stop| (stop.point - point).norm());
        let nearest = distances.filter(|&distance| distance > 0.0).fold(f64::INFINITY, f64::min);
        if nearest < self.runs.lengths.around {
            self.circle(&point, 0.3 * nearest)?;
        }
        Ok(())
    }

    /// Solves again for inaccurate vertices, with the margins of all curves that end there. Two of
    /// these may meet at a large angle, which makes their crossing accurate. A vertex that turns
    /// out to be the place of another vertex is joined with it.
    pub(super) fn polish(&mut self) -> Traced<(), F> {
        /// How many tolerances apart vertices at both ends of a curve count as two.
        const APART: f64 = 1e3;
        let near = APART * self.runs.options.tolerance;
        let mut index = 0;
        while let Some(&stop) = self.builder.stops.get(index) {
            if let Some(target) = self.builder.indistinct(index, near) {
                self.builder.join(index, target);
                continue;
            }
            let special = self.better_place(index, &stop)?;
            let same = special.as_ref().and_then(|it| self.builder.same_place(index, it));
            if let Some(other) = same {
                self.builder.join(index, other);
                continue;
            }
            if let Some(special) = special {
                self.builder.move_vertex(index, &special);
            }
            index += 1;
        }
        Ok(())
    }

    /// The place of an inaccurate vertex, solved for with the margins of all curves that end there.
    /// Where two of these curves touch, the new place may be farther away than its error says. It
    /// is then left out, unless a curve misses the vertex by as much.
    fn better_place(&self, index: usize, stop: &Stop) -> Traced<Option<Special<F::Margin>>, F> {
        let arrivals = self.builder.arrivals(index);
        let missed = arrivals.iter().map(|(node, _)| missed_by(node, &stop.point));
        let missed = missed.fold(0.0, f64::max);
        let uncertainty = stop.uncertainty.max(missed);
        if uncertainty <= self.runs.lengths.same {
            return Ok(None);
        }
        let moved = |(node, margin): (Node, F::Margin)| {
            self.runs.moved(&node.point, &margin).map(|margin| (node, margin))
        };
        let arrivals: Vec<_> = arrivals.into_iter().map(moved).collect::<Traced<_, F>>()?;
        let farthest = (10.0 * stop.uncertainty).max(2.0 * missed);
        let mut best: Option<(Point, f64, [F::Margin; 2])> = None;
        for (node, own) in &arrivals {
            for (_, other) in arrivals.iter().filter(|(_, other)| other != own) {
                let reach = 2.0 * (node.point - stop.point).norm();
                let margins = [own, other];
                let found = crossing(
                    &self.runs,
                    margins,
                    &node.point,
                    &node.tangent,
                    self.runs.lengths.scale,
                    reach,
                )?;
                if let Some((point, off)) = found
                    && off <= self.runs.lengths.same
                    && (point - stop.point).norm() <= farthest
                    && off < best.as_ref().map_or(0.2 * uncertainty, |best| best.1)
                {
                    best = Some((point, off, margins.map(Clone::clone)));
                }
            }
        }
        Ok(best.map(|(point, uncertainty, margins)| {
            let (kind, margins) = (VertexKind::Crossing, margins.to_vec());
            Special { point, kind, margins, uncertainty, solved: true }
        }))
    }

    /// Searches on a circle.
    fn circle(&mut self, centre: &Point, radius: f64) -> Traced<(), F> {
        self.walk(&polygon(centre, radius, 16, 0.3))
    }

    /// Scans the sides of a polygon.
    fn walk(&mut self, places: &[Point]) -> Traced<(), F> {
        let mut labels = Vec::with_capacity(places.len());
        for place in places {
            labels.push(self.runs.label(place)?);
        }
        for (segment, ends) in places.windows(2).zip(labels.windows(2)) {
            self.scan([segment[0], segment[1]], [ends[0].clone(), ends[1].clone()])?;
        }
        Ok(())
    }
}

/// The corners of a polygon around a place; the last one is the first. The polygon is turned by a
/// part of a side, so that no corner lies on an axis or a diagonal through the place.
pub(crate) fn polygon(centre: &Point, radius: f64, corners: u32, turned: f64) -> Vec<Point> {
    let corner = |index: u32| {
        let turns = (f64::from(index % corners) + turned) / f64::from(corners);
        let (sine, cosine) = (std::f64::consts::TAU * turns).sin_cos();
        centre + Point::new(cosine, sine) * radius
    };
    (0..=corners).map(corner).collect()
}

/// Whether a run between two others is as they suggest: it has the same label, and margins near the
/// mean of their margins.
pub(crate) fn is_expected<L: Eq, M: PartialEq>(
    a: &FreeRun<L, M>,
    middle: &FreeRun<L, M>,
    b: &FreeRun<L, M>,
) -> bool {
    let value = |run: &FreeRun<L, M>, margin: &M| {
        run.margins.iter().find(|(own, _)| own == margin).map(|(_, value)| *value)
    };
    a.label == middle.label
        && middle.label == b.label
        && middle.margins.iter().all(|(margin, here)| match (value(a, margin), value(b, margin)) {
            (Some(one), Some(two)) => {
                let least = here.abs().min(one.abs()).min(two.abs());
                (here - 0.5 * (one + two)).abs() <= 0.5 * least
            }
            _ => true,
        })
}

/// The distance of a vertex from a curve that ends there, if the curve would have to turn by more
/// than a step allows. `node` is its last node before the end.
fn missed_by(node: &Node, vertex: &Point) -> f64 {
    let chord = vertex - node.point;
    let beside = node.tangent.perp(&chord).abs();
    if beside > 0.5 * chord.norm() { beside } else { 0.0 }
}
