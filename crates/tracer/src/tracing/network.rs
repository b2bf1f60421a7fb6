//! The curves and vertices that a trace collects.

use crate::cubic::Cubic;
use crate::curve::{Curve, Node, Vertex};
use crate::family::Family;
use crate::tracing::branch::end::{SHORTEST, Special, Stop};
use crate::window::{Point, Window};

/// All curves on which the label changes in a window, and where they end.
#[derive(Clone, Debug, PartialEq)]
pub struct Network<Label, Margin> {
    /// Where it was looked for.
    pub window: Window,
    /// The curves, in the order in which they were found.
    pub curves: Vec<Curve<Label, Margin>>,
    /// Their ends. Corners of the window are among them only where a boundary ends there.
    pub vertices: Vec<Vertex<Margin>>,
    /// What it took.
    pub statistics: TraceStatistics,
    /// What is not sure.
    pub unresolved: Vec<Unresolved<Label>>,
}

/// The network of a family.
pub type NetworkOf<F> = Network<<F as Family>::Label, <F as Family>::Margin>;

/// The work of a trace.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TraceStatistics {
    /// Free runs.
    pub free_runs: usize,
    /// Runs with a prescribed itinerary, one a margin.
    pub prescribed_runs: usize,
    /// Nodes accepted.
    pub nodes: usize,
    /// Steps rejected.
    pub rejected: usize,
    /// Places from which a curve was traced.
    pub seeds: usize,
}

/// Something that a trace saw and could not explain.
#[derive(Clone, Debug, PartialEq)]
pub enum Unresolved<Label> {
    /// The label changes between two places, and no margin that vanishes between them is found.
    Change {
        /// The places.
        between: [Point; 2],
        /// Their labels.
        labels: [Label; 2],
    },
    /// A curve ends at this vertex without a cause that was solved for.
    Stalled {
        /// Index of the vertex.
        vertex: usize,
    },
    /// A curve has as many nodes as are allowed.
    TooManyNodes {
        /// Where it was left.
        point: Point,
    },
    /// There are as many curves as are allowed.
    TooManyCurves {
        /// Where one more starts.
        point: Point,
    },
}

/// Where a segment crosses a curve.
#[derive(Clone, Debug)]
pub(crate) struct Passage<Label> {
    /// Place on the segment, from 0 to 1.
    pub place: f64,
    /// Labels before and after it.
    pub labels: [Label; 2],
}

/// A network that grows, with an index of its pieces by place.
pub(crate) struct Builder<Label, Margin> {
    pub network: Network<Label, Margin>,
    pub stops: Vec<Stop>,
    /// Curves that came from parting one, whose sides must be looked at again.
    pub suspects: Vec<usize>,
    scale: f64,
    /// Pieces (curve, node) by cell of the window.
    cells: Vec<Vec<(usize, usize)>>,
}

/// Cells of the index along each axis.
const CELLS: usize = 64;

impl<Label: Clone + Eq, Margin: Clone + Ord> Builder<Label, Margin> {
    pub fn new(window: Window) -> Self {
        let network = Network {
            window,
            curves: Vec::new(),
            vertices: Vec::new(),
            statistics: TraceStatistics::default(),
            unresolved: Vec::new(),
        };
        let scale = window.extent().min();
        let cells = vec![Vec::new(); CELLS * CELLS];
        Self { network, stops: Vec::new(), suspects: Vec::new(), scale, cells }
    }

    /// Adds a vertex, or finds it among those there are; curves that pass through it are parted,
    /// and their parts are [suspects](Self::suspects).
    pub fn add_vertex(&mut self, special: &Special<Margin>) -> usize {
        let near = special.uncertainty + SHORTEST * self.scale;
        let known = self
            .stops
            .iter()
            .position(|stop| (stop.point - special.point).norm() <= stop.uncertainty + near);
        if let Some(index) = known {
            let margins = &mut self.network.vertices[index].margins;
            margins.extend(special.margins.iter().cloned());
            margins.sort();
            margins.dedup();
            if special.improves(&self.stops[index]) {
                self.move_vertex(index, special);
            }
            return index;
        }
        let mut margins = special.margins.clone();
        margins.sort();
        margins.dedup();
        let index = self.stops.len();
        self.stops.push(Stop { point: special.point, uncertainty: special.uncertainty });
        self.network.vertices.push(Vertex { point: special.point, kind: special.kind, margins });
        if !special.solved {
            self.network.unresolved.push(Unresolved::Stalled { vertex: index });
        }
        self.part_curves(index);
        index
    }

    /// The curves that end at a vertex: their margins, with the nodes before the ends.
    pub fn arrivals(&self, vertex: usize) -> Vec<(Node, Margin)> {
        let mut found = Vec::new();
        for curve in &self.network.curves {
            let Some([start, end]) = curve.ends else { continue };
            let before_last = curve.nodes.len() - 2;
            for (node, at) in [(1, start), (before_last, end)] {
                if at == vertex {
                    found.push((curve.nodes[node], curve.margin.clone()));
                }
            }
        }
        found
    }

    /// Puts a vertex where it is known better, with the curves that end there.
    pub fn move_vertex(&mut self, index: usize, special: &Special<Margin>) {
        self.stops[index] = Stop { point: special.point, uncertainty: special.uncertainty };
        self.network.vertices[index].point = special.point;
        self.network.vertices[index].kind = special.kind;
        for curve in &mut self.network.curves {
            let Some([start, end]) = curve.ends else { continue };
            let last = curve.nodes.len() - 1;
            for (node, vertex) in [(0, start), (last, end)] {
                if vertex == index {
                    curve.nodes[node].point = special.point;
                }
            }
        }
        self.rebuild_index();
    }

    /// Adds a curve; nodes that nearly coincide become one, ends go first.
    pub fn add_curve(&mut self, mut curve: Curve<Label, Margin>) -> Option<usize> {
        let shortest = SHORTEST * self.scale;
        let last = curve.nodes.len().checked_sub(1)?;
        let end = curve.nodes[last];
        let mut nodes: Vec<Node> = Vec::with_capacity(curve.nodes.len());
        for node in &curve.nodes[..last] {
            if nodes.last().is_none_or(|kept| (kept.point - node.point).norm() > shortest) {
                nodes.push(*node);
            }
        }
        while nodes.len() > 1
            && nodes.last().is_some_and(|kept| (kept.point - end.point).norm() <= shortest)
        {
            nodes.pop();
        }
        nodes.push(end);
        if nodes.len() == 2 && (nodes[0].point - nodes[1].point).norm() <= shortest {
            return None;
        }
        curve.nodes = nodes;
        let index = self.network.curves.len();
        for piece in 0..curve.nodes.len() - 1 {
            self.enter(index, piece, &Cubic::between(&curve.nodes[piece], &curve.nodes[piece + 1]));
        }
        self.network.curves.push(curve);
        Some(index)
    }

    /// Whether a place on a boundary with these labels on its sides lies on a curve that is there,
    /// whatever its margin is called.
    pub fn covers(&self, point: &Point, labels: &[Label; 2]) -> bool {
        let near = 1e-8 * self.scale;
        self.near(&[*point, *point]).into_iter().any(|(curve, piece)| {
            let sides = &self.network.curves[curve].sides;
            (sides == labels || (sides[0] == labels[1] && sides[1] == labels[0]))
                && self.arc(curve, piece).closest(point).1 < near
        })
    }

    /// Where the segment from `a` to `b` crosses curves, in order.
    pub fn passages(&self, a: &Point, b: &Point) -> Vec<Passage<Label>> {
        let mut found = Vec::new();
        for (curve, piece) in self.near(&[a.inf(b), a.sup(b)]) {
            let arc = self.arc(curve, piece);
            for [theta, place] in arc.crossings(a, b) {
                let [left, right] = self.network.curves[curve].sides.clone();
                let from_left = arc.derivative(theta).perp(&(b - a)) < 0.0;
                let labels = if from_left { [left, right] } else { [right, left] };
                found.push(Passage { place, labels });
            }
        }
        found.sort_by(|one, two| one.place.total_cmp(&two.place));
        found
    }

    fn arc(&self, curve: usize, piece: usize) -> Cubic {
        let nodes = &self.network.curves[curve].nodes;
        Cubic::between(&nodes[piece], &nodes[piece + 1])
    }

    fn cell_range(&self, bounds: &[Point; 2]) -> [[usize; 2]; 2] {
        let extent = self.network.window.extent();
        [0, 1].map(|axis| {
            [0, 1].map(|end| {
                let sign = if end == 0 { -1.0 } else { 1.0 };
                // Places that touch a cell count to both.
                let place = bounds[end][axis] + sign * 1e-7 * self.scale;
                let part = (place - self.network.window.low[axis]) / extent[axis];
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
                let cell = (part * CELLS as f64).clamp(0.0, CELLS as f64 - 1.0) as usize;
                cell
            })
        })
    }

    fn enter(&mut self, curve: usize, piece: usize, arc: &Cubic) {
        let [columns, rows] = self.cell_range(&arc.bounds());
        for column in columns[0]..=columns[1] {
            for row in rows[0]..=rows[1] {
                self.cells[column * CELLS + row].push((curve, piece));
            }
        }
    }

    /// Pieces that may reach into a box, in order.
    fn near(&self, bounds: &[Point; 2]) -> Vec<(usize, usize)> {
        let [columns, rows] = self.cell_range(bounds);
        let mut pieces = Vec::new();
        for column in columns[0]..=columns[1] {
            for row in rows[0]..=rows[1] {
                pieces.extend_from_slice(&self.cells[column * CELLS + row]);
            }
        }
        pieces.sort_unstable();
        pieces.dedup();
        pieces
    }

    /// Parts the curves in whose interior a vertex lies.
    fn part_curves(&mut self, vertex: usize) {
        let Stop { point, uncertainty } = self.stops[vertex];
        let near = uncertainty + SHORTEST * self.scale;
        let mut hits: Vec<(usize, usize, f64)> = Vec::new();
        for (curve, piece) in self.near(&[point, point]) {
            let (theta, distance) = self.arc(curve, piece).closest(&point);
            let nodes = &self.network.curves[curve].nodes;
            let ends = self.network.curves[curve].ends.is_some()
                && [nodes[0], nodes[nodes.len() - 1]]
                    .iter()
                    .any(|end| (end.point - point).norm() <= near);
            // Of a curve that is hit in two adjacent pieces, the first one counts.
            if distance <= near && !ends && hits.last().is_none_or(|hit| hit.0 != curve) {
                hits.push((curve, piece, theta));
            }
        }
        if hits.is_empty() {
            return;
        }
        for (curve, piece, theta) in hits {
            let tangent = self.arc(curve, piece).tangent(theta);
            let here = Node { point, tangent };
            self.suspects.push(curve);
            let own = &mut self.network.curves[curve];
            let after: Vec<Node> =
                std::iter::once(here).chain(own.nodes[piece + 1..].iter().copied()).collect();
            own.nodes.truncate(piece + 1);
            own.nodes.push(here);
            if let Some([start, end]) = own.ends {
                own.ends = Some([start, vertex]);
                let rest = Curve { nodes: after, ends: Some([vertex, end]), ..own.clone() };
                self.suspects.push(self.network.curves.len());
                self.network.curves.push(rest);
            } else {
                // A closed curve only starts elsewhere.
                let mut nodes = after;
                nodes.extend_from_slice(&own.nodes[1..]);
                own.nodes = nodes;
                own.ends = Some([vertex, vertex]);
            }
        }
        self.rebuild_index();
    }

    /// Takes curves out.
    pub fn remove_curves(&mut self, removed: &[usize]) {
        let mut index = 0;
        self.network.curves.retain(|_| {
            index += 1;
            !removed.contains(&(index - 1))
        });
        self.rebuild_index();
    }

    fn rebuild_index(&mut self) {
        self.cells.iter_mut().for_each(Vec::clear);
        for curve in 0..self.network.curves.len() {
            for piece in 0..self.network.curves[curve].nodes.len() - 1 {
                let arc = self.arc(curve, piece);
                self.enter(curve, piece, &arc);
            }
        }
    }
}
