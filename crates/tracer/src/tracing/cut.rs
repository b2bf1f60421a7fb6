//! The part of a network that lies in a window.
//!
//! A trace follows boundaries a little beyond the window. Vertices just beyond an edge, or on it,
//! are then found like any other. Here curves are cut at the edges.
//!
//! A curve is divided where it crosses an edge, and at its nodes on an edge. A part belongs to the
//! window if it leads inside by more than the distance at which places are distinguished, so that
//! curves along an edge do not belong to it.

use crate::cubic::Cubic;
use crate::cubic::bernstein::each_root;
use crate::curve::{Curve, Node, Vertex, VertexKind};
use crate::family::Family;
use crate::tracing::corrector::correct_on_edge;
use crate::tracing::network::{Network, NetworkOf, Unresolved};
use crate::tracing::runs::{Runs, Traced};
use crate::window::{Point, Window};

/// The part of `network` that lies in `window`.
pub(crate) fn cut<F: Family>(
    runs: &Runs<'_, F>,
    network: &NetworkOf<F>,
    window: &Window,
) -> NetworkOf<F> {
    if network.window == *window {
        return network.clone();
    }
    let near = runs.lengths.same;
    let mut cutter =
        Cutter { runs, window, near, old: &network.vertices, new: Vec::new(), indices: Vec::new() };
    cutter.indices = (0..network.vertices.len()).map(|old| cutter.inner(old)).collect();
    let curves = network.curves.iter().flat_map(|curve| cutter.parts(curve)).collect();
    let unresolved = network.unresolved.iter().filter_map(|what| match what {
        Unresolved::Change { between, .. } => {
            between.iter().any(|place| window.contains(place)).then(|| what.clone())
        }
        Unresolved::Stalled { vertex } => {
            cutter.indices[*vertex].map(|vertex| Unresolved::Stalled { vertex })
        }
        Unresolved::NoLength { .. }
        | Unresolved::TooManyNodes { .. }
        | Unresolved::TooManyCurves { .. } => Some(what.clone()),
    });
    let unresolved = unresolved.collect();
    let statistics = network.statistics;
    Network { window: *window, curves, vertices: cutter.new, statistics, unresolved }
}

struct Cutter<'a, 'f, F: Family> {
    runs: &'a Runs<'f, F>,
    window: &'a Window,
    /// Places closer together than this count as one.
    near: f64,
    old: &'a [Vertex<F::Margin>],
    new: Vec<Vertex<F::Margin>>,
    /// The new indices of the old vertices.
    indices: Vec<Option<usize>>,
}

/// A place on an edge at which a curve is divided.
#[derive(Clone, Copy)]
struct Cut {
    /// The place along the curve, counted in pieces.
    place: f64,
    /// The axis along which the edge is constant.
    axis: usize,
    edge: f64,
}

/// A curve of a network as a sequence of cubics.
struct Path<'c> {
    nodes: &'c [Node],
}

impl Path<'_> {
    /// The number of pieces, which is also the place of the end.
    fn pieces(&self) -> usize {
        self.nodes.len() - 1
    }

    /// A cubic; closed curves go on behind their end.
    fn cubic(&self, piece: usize) -> Cubic {
        let piece = piece % self.pieces();
        Cubic::between(&self.nodes[piece], &self.nodes[piece + 1])
    }

    /// The cubic at a place, and the parameter on it.
    fn piece(&self, place: f64) -> (Cubic, f64) {
        let piece = floor(place).min(self.pieces() - 1);
        (self.cubic(piece), place - piece as f64)
    }

    /// The nodes between two places, with their places.
    fn nodes_between(&self, from: f64, to: f64) -> impl Iterator<Item = (f64, Node)> + '_ {
        let inside = move |place: &usize| (*place as f64) > from && (*place as f64) < to;
        let places = (floor(from)..=floor(to)).filter(inside);
        places.map(|place| (place as f64, self.nodes[place % self.pieces()]))
    }

    /// Points between two places, several on each piece.
    fn samples(&self, from: f64, to: f64) -> Vec<Point> {
        if to <= from {
            return Vec::new();
        }
        let nodes = self.nodes_between(from, to).map(|(place, _)| place);
        let places: Vec<f64> =
            std::iter::once(from).chain(nodes).chain(std::iter::once(to)).collect();
        let mut samples = Vec::new();
        for pair in places.windows(2) {
            let cubic = self.cubic(floor(pair[0]));
            let start = pair[0].floor();
            for part in [0.0, 0.25, 0.5, 0.75, 1.0] {
                samples.push(cubic.at(pair[0] + part * (pair[1] - pair[0]) - start));
            }
        }
        samples
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "places are not below 0"
)]
fn floor(place: f64) -> usize {
    place as usize
}

impl<F: Family> Cutter<'_, '_, F> {
    /// The new index of an old vertex inside the window.
    fn inner(&mut self, old: usize) -> Option<usize> {
        let inside = self.window.depth(&self.old[old].point) > self.near;
        inside.then(|| {
            self.new.push(self.old[old].clone());
            self.new.len() - 1
        })
    }

    /// The parts of a curve that lie in the window.
    fn parts(&mut self, curve: &Curve<F::Label, F::Margin>) -> Vec<Curve<F::Label, F::Margin>> {
        let path = Path { nodes: &curve.nodes };
        let end = path.pieces() as f64;
        let mut cuts = self.cuts(&path, curve.ends.is_none());
        if curve.ends.is_some() {
            let start = self.is_on_edge(&curve.nodes[0].point);
            while start && cuts.first().is_some_and(|cut| self.hugs(&path, 0.0, cut.place)) {
                cuts.remove(0);
            }
            let last = self.is_on_edge(&curve.nodes[path.pieces()].point);
            while last && cuts.last().is_some_and(|cut| self.hugs(&path, cut.place, end)) {
                cuts.pop();
            }
        }
        let mut places: Vec<(f64, Option<Cut>)> =
            cuts.iter().map(|cut| (cut.place, Some(*cut))).collect();
        if let Some(first) = cuts.first().filter(|_| curve.ends.is_none()) {
            places.push((first.place + end, Some(*first)));
        } else {
            places.insert(0, (0.0, None));
            places.push((end, None));
        }
        let mut parts = Vec::new();
        for pair in places.windows(2) {
            let [(from, first), (to, last)] = [pair[0], pair[1]];
            let inside = |point: &Point| self.window.depth(point) > self.near;
            if !path.samples(from, to).iter().any(inside) {
                continue;
            }
            if first.is_none() && last.is_none() && curve.ends.is_none() {
                return vec![curve.clone()];
            }
            let old = curve.ends.unwrap_or_default();
            let (start, first) = self.end(curve, &path, first, old[0], 0);
            let (stop, last) = self.end(curve, &path, last, old[1], path.pieces());
            let apart = |node: &Node| {
                [first, last].iter().all(|end| (end.point - node.point).norm() > self.near)
            };
            let between = path.nodes_between(from, to).map(|(_, node)| node).filter(apart);
            let nodes = std::iter::once(first).chain(between).chain(std::iter::once(last));
            let nodes = nodes.collect();
            parts.push(Curve { nodes, ends: Some([start, stop]), ..curve.clone() });
        }
        parts
    }

    /// The places at which a curve crosses the edges of the window or has a node on one, in order.
    fn cuts(&self, path: &Path<'_>, closed: bool) -> Vec<Cut> {
        let mut cuts = Vec::new();
        let Window { low, high } = *self.window;
        for axis in 0..2 {
            let other = 1 - axis;
            for edge in [low[axis], high[axis]] {
                let mut keep = |place: f64, point: &Point| {
                    let along = point[other];
                    if along >= low[other] - self.near && along <= high[other] + self.near {
                        cuts.push(Cut { place, axis, edge });
                    }
                };
                for piece in 0..path.pieces() {
                    let cubic = path.cubic(piece);
                    let node = &path.nodes[piece].point;
                    if (piece > 0 || closed) && (node[axis] - edge).abs() <= self.near {
                        keep(piece as f64, node);
                    }
                    let heights = cubic.points.map(|point| point[axis] - edge);
                    each_root(&heights, &mut |theta| {
                        keep(piece as f64 + theta.min(1.0 - f64::EPSILON), &cubic.at(theta));
                    });
                }
            }
        }
        cuts.sort_by(|one, two| one.place.total_cmp(&two.place));
        cuts
    }

    /// Whether a curve lies on an edge between two places.
    fn hugs(&self, path: &Path<'_>, from: f64, to: f64) -> bool {
        path.samples(from, to).iter().all(|point| self.window.depth(point).abs() <= self.near)
    }

    fn is_on_edge(&self, point: &Point) -> bool {
        self.window.onto_boundary(point, self.near).is_some()
    }

    /// The vertex and the node at an end of a part: the place where it is cut, or the end of the
    /// curve at an old vertex, with the index of its node.
    fn end(
        &mut self,
        curve: &Curve<F::Label, F::Margin>,
        path: &Path<'_>,
        cut: Option<Cut>,
        old: usize,
        node: usize,
    ) -> (usize, Node) {
        let Some(cut) = cut else {
            let Node { point, tangent } = curve.nodes[node];
            let vertex = match self.indices[old] {
                Some(vertex) => vertex,
                None => self.edge_vertex(&point, &self.old[old].margins),
            };
            self.indices[old] = Some(vertex);
            return (vertex, Node { point: self.new[vertex].point, tangent });
        };
        let (cubic, theta) = path.piece(cut.place);
        let (mut guess, tangent) = (cubic.at(theta), cubic.tangent(theta));
        guess[cut.axis] = cut.edge;
        // Where no run gives a better place, the place of the cubic is used.
        let solved = self.solve(curve, &guess, &tangent, &cubic, cut.axis).ok().flatten();
        let Node { point, tangent } = solved.unwrap_or(Node { point: guess, tangent });
        let vertex = self.edge_vertex(&point, std::slice::from_ref(&curve.margin));
        (vertex, Node { point: self.new[vertex].point, tangent })
    }

    /// The node of a boundary on an edge, solved for with its margin.
    fn solve(
        &self,
        curve: &Curve<F::Label, F::Margin>,
        guess: &Point,
        tangent: &Point,
        cubic: &Cubic,
        axis: usize,
    ) -> Traced<Option<Node>, F> {
        let runs = self.runs;
        let margin = runs.moved(guess, &curve.margin)?;
        let radius = cubic.chord() / cubic.tangent(0.0).angle(&cubic.tangent(1.0));
        let Some(gradient) = runs.gradient(guess, &margin, tangent, radius)? else {
            return Ok(None);
        };
        let reach = 10.0 * runs.options.interpolation.max(runs.resolution(gradient.norm()));
        let found = correct_on_edge(runs, &margin, guess, &gradient, axis, reach)?;
        let normal = Point::new(gradient.y, -gradient.x).normalize();
        let along = if normal.dot(tangent) > 0.0 { normal } else { -normal };
        // The tangent of the cubic counts where the margin ceases to exist, as beside a vertex.
        let tangent = if along.angle(tangent) < runs.options.max_angle { along } else { *tangent };
        Ok(found.map(|point| Node { point, tangent }))
    }

    /// The vertex at a place on an edge, a known one if there is one.
    fn edge_vertex(&mut self, place: &Point, margins: &[F::Margin]) -> usize {
        let Window { low, high } = *self.window;
        let place = place.sup(&low).inf(&high);
        let point = self.window.onto_boundary(&place, self.near).unwrap_or(place);
        let known = |vertex: &Vertex<F::Margin>| {
            vertex.kind.is_on_window() && (vertex.point - point).norm() <= self.near
        };
        let index = self.new.iter().position(known).unwrap_or_else(|| {
            let corner = self.window.corners().contains(&point);
            let kind = if corner { VertexKind::WindowCorner } else { VertexKind::WindowEdge };
            self.new.push(Vertex { point, kind, margins: Vec::new() });
            self.new.len() - 1
        });
        let own = &mut self.new[index].margins;
        own.extend_from_slice(margins);
        own.sort();
        own.dedup();
        index
    }
}
