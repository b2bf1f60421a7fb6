//! All boundaries in a window.

use crate::curve::{Node, VertexKind};
use crate::family::{Family, FreeRun};
use crate::options::{TraceError, TraceOptions};
use crate::tracing::branch::end::{SHORTEST, Special};
use crate::tracing::corrector::crossing;
use crate::tracing::extrema::{Extremum, extrema};
use crate::tracing::island::islands;
use crate::tracing::network::{Builder, NetworkOf};
use crate::tracing::runs::{Runs, Sampled, Traced};
use crate::window::{Point, Window};

/// Traces every boundary of a family in a window: what a new [`Tracer`] finds.
///
/// # Errors
/// Options out of range, a window that is not a rectangle, a run that fails, a margin that is not a
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

/// Looks for boundaries in a window, and keeps what it has found, so that it can be told to look
/// again.
///
/// Seeds come from the window's edges, from circles around every vertex, from a grid, and from the
/// minima of margins between its places. What can be missed are closed curves, or pieces between
/// two vertices, that pass between all of those: strips and islands with no place of the grid
/// inside whose margin has no minimum that the grid sees. A verification may come upon them, and
/// [`Self::look_between`] then finds them.
///
/// The family is evaluated up to a thousandth of the window's extent outside of it. Nodes are on
/// their boundary to `options.tolerance`, or as far as the noise of margins allows, the cubics
/// between them to `options.interpolation`.
pub struct Tracer<'f, F: Family> {
    pub(crate) runs: Runs<'f, F>,
    pub(crate) builder: Builder<F::Label, F::Margin>,
    /// Vertices around which seeds were looked for.
    probed: usize,
}

/// Radii of the circles around a vertex on which seeds are looked for, in parts of the window's
/// shorter extent.
const CIRCLES: [f64; 2] = [1e-3, 1e-5];

impl<'f, F: Family> Tracer<'f, F> {
    /// A tracer that has found nothing yet.
    ///
    /// # Errors
    /// Options out of range, a window that is not a rectangle.
    pub fn new(family: &'f F, window: &Window, options: &TraceOptions) -> Traced<Self, F> {
        let runs = Runs::new(family, *window, *options)?;
        Ok(Self { runs, builder: Builder::new(*window), probed: 0 })
    }

    /// Looks everywhere.
    ///
    /// # Errors
    /// A run fails, or a margin is not a number.
    pub fn explore(&mut self) -> Traced<(), F> {
        self.edges()?;
        self.vertices()?;
        self.grid()?;
        self.close_vertices()?;
        self.polish()
    }

    /// Looks between pairs of places for boundaries that are not known yet; whether there are any.
    ///
    /// # Errors
    /// As [`Self::explore`].
    pub fn look_between(&mut self, pairs: &[[Point; 2]]) -> Traced<bool, F> {
        let before = self.builder.network.curves.len();
        for &[a, b] in pairs {
            let labels = [self.runs.label(&a)?, self.runs.label(&b)?];
            self.scan([a, b], labels)?;
            self.vertices()?;
        }
        self.close_vertices()?;
        self.polish()?;
        Ok(self.builder.network.curves.len() != before)
    }

    /// What has been found so far.
    #[must_use]
    pub fn network(&self) -> NetworkOf<F> {
        let mut network = self.builder.network.clone();
        [network.statistics.free_runs, network.statistics.prescribed_runs] = self.runs.counts();
        network
    }

    /// Where the curves found so far are extremal in a coordinate, solved for on the boundaries, to
    /// about 1e-9 of their radius of curvature along them.
    ///
    /// A curve that runs along an axis to 1e-6 in its direction has none, and an extremum counts
    /// only if the curve departs from it in its coordinate by more than ten times
    /// `options.interpolation` on both sides, before the next one or the end. Ends of curves
    /// are none.
    ///
    /// # Errors
    /// A run fails, or a margin is not a number.
    pub fn extrema(&self) -> Traced<Vec<Extremum>, F> {
        extrema(&self.runs, &self.builder.network.curves)
    }

    /// Seeds from the window's edges, a ten-millionth inside.
    fn edges(&mut self) -> Traced<(), F> {
        let inset = Point::repeat(1e-7 * self.runs.scale);
        let (low, high) = (self.runs.window.low + inset, self.runs.window.high - inset);
        let corners = [low, Point::new(high.x, low.y), high, Point::new(low.x, high.y), low];
        let parts = 2 * self.runs.options.cells;
        let mut last = (low, self.runs.free(&low)?);
        for side in corners.windows(2) {
            for i in 1..=parts {
                let place = side[0].lerp(&side[1], i as f64 / parts as f64);
                let next = (place, self.runs.free(&place)?);
                self.divide(&last, &next, DIVISIONS)?;
                last = next;
            }
        }
        Ok(())
    }

    /// Scans a segment, in halves where its middle has another label or other margins than its ends
    /// let expect.
    fn divide(&mut self, a: &Sampled<F>, b: &Sampled<F>, depth: u32) -> Traced<(), F> {
        if depth == 0 {
            return self.scan([a.0, b.0], [a.1.label.clone(), b.1.label.clone()]);
        }
        let place = a.0.lerp(&b.0, 0.5);
        let middle = (place, self.runs.free(&place)?);
        if is_expected(&a.1, &middle.1, &b.1) {
            return self.scan([a.0, b.0], [a.1.label.clone(), b.1.label.clone()]);
        }
        self.divide(a, &middle, depth - 1)?;
        self.divide(&middle, b, depth - 1)
    }

    /// Seeds from two circles around every vertex that has come up and does not lie on the window's
    /// edge.
    fn vertices(&mut self) -> Traced<(), F> {
        while let Some(vertex) = self.builder.network.vertices.get(self.probed) {
            let (point, kind) = (vertex.point, vertex.kind);
            self.probed += 1;
            if matches!(kind, VertexKind::WindowEdge | VertexKind::WindowCorner) {
                continue;
            }
            for radius in CIRCLES {
                self.circle(&point, radius * self.runs.scale)?;
            }
        }
        Ok(())
    }

    /// Seeds from a circle around every vertex that has others inside its circles: between them,
    /// where curves from one to the other pass.
    fn close_vertices(&mut self) -> Traced<(), F> {
        let mut done = 0;
        while done < self.builder.stops.len() {
            let point = self.builder.stops[done].point;
            let distances = self.builder.stops.iter().map(|stop| (stop.point - point).norm());
            let nearest =
                distances.filter(|&distance| distance > 0.0).fold(f64::INFINITY, f64::min);
            done += 1;
            if nearest < CIRCLES[0] * self.runs.scale {
                self.circle(&point, 0.3 * nearest)?;
                self.vertices()?;
            }
        }
        Ok(())
    }

    /// Solves again for vertices that are not known well, with the margins of all curves that end
    /// there: two of them may meet at a large angle.
    fn polish(&mut self) -> Traced<(), F> {
        for index in 0..self.builder.stops.len() {
            let stop = self.builder.stops[index];
            if stop.uncertainty <= SHORTEST * self.runs.scale {
                continue;
            }
            let mut arrivals: Vec<(Node, F::Margin)> = Vec::new();
            for (node, margin) in self.builder.arrivals(index) {
                let margin = self.runs.moved(&node.point, &margin)?;
                arrivals.push((node, margin));
            }
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
                        self.runs.scale,
                        reach,
                    )?;
                    if let Some((point, off)) = found
                        && (point - stop.point).norm() <= 10.0 * stop.uncertainty
                        && off < best.as_ref().map_or(0.2 * stop.uncertainty, |best| best.1)
                    {
                        best = Some((point, off, margins.map(Clone::clone)));
                    }
                }
            }
            if let Some((point, uncertainty, margins)) = best {
                let kind = VertexKind::Crossing;
                let margins = margins.to_vec();
                let special = Special { point, kind, margins, uncertainty, solved: true };
                self.builder.move_vertex(index, &special);
            }
        }
        Ok(())
    }

    fn circle(&mut self, centre: &Point, radius: f64) -> Traced<(), F> {
        const CORNERS: u32 = 16;
        let places: Vec<Point> = (0..=CORNERS)
            .map(|i| {
                // Turned, so that no corner lies on a line through the vertex along an axis or a
                // diagonal.
                let turns = (f64::from(i % CORNERS) + 0.3) / f64::from(CORNERS);
                let (sine, cosine) = (std::f64::consts::TAU * turns).sin_cos();
                centre + Point::new(cosine, sine) * radius
            })
            .collect();
        self.walk(&places)
    }

    /// Seeds from the grid and from the islands between its places.
    fn grid(&mut self) -> Traced<(), F> {
        let cells = self.runs.options.cells;
        let window = self.runs.window;
        let cell = window.extent() / cells as f64;
        let mut grid: Vec<Sampled<F>> = Vec::with_capacity(cells * cells);
        for column in 0..cells {
            for row in 0..cells {
                let part = Point::new(column as f64 + 0.5, row as f64 + 0.5);
                let point = window.low + cell.component_mul(&part);
                grid.push((point, self.runs.free(&point)?));
            }
        }
        for index in 0..grid.len() {
            let (column, row) = (index / cells, index % cells);
            let (here, run) = &grid[index];
            for (inside, other) in
                [(row + 1 < cells, index + 1), (column + 1 < cells, index + cells)]
            {
                if inside {
                    let (there, next) = &grid[other];
                    self.scan([*here, *there], [run.label.clone(), next.label.clone()])?;
                    self.vertices()?;
                }
            }
        }
        for segment in islands(&self.runs, &grid, cells, &cell)? {
            let labels = [self.runs.label(&segment[0])?, self.runs.label(&segment[1])?];
            self.scan(segment, labels)?;
            self.vertices()?;
        }
        Ok(())
    }

    /// Scans the segments of a polygon.
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

/// Halvings of a segment on the window's edge.
const DIVISIONS: u32 = 4;

/// Whether a run between two others is what these let expect: the same label, and margins near the
/// mean of theirs.
fn is_expected<L: Eq, M: PartialEq>(
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
