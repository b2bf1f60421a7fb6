//! A network that grows while it is traced, with an index of its pieces by place.
//!
//! Each vertex has an error. Where boundaries touch, one pair of margins determines the place to
//! half the digits, another pair to all of them. A vertex that is found again with a smaller error
//! moves to the better place. In the end all other vertices are solved again with the margins of
//! all curves that end there.

use crate::cubic::Cubic;
use crate::curve::{Curve, Node, Vertex};
use crate::lengths::Lengths;
use crate::tracing::end::{Special, Stop};
use crate::tracing::network::{Network, TraceStatistics, Unresolved};
use crate::window::{Point, Window};

/// A place where a segment crosses a curve.
#[derive(Clone, Debug)]
pub(crate) struct Passage<Label> {
    /// The place on the segment, from 0 to 1.
    pub place: f64,
    /// The labels on the segment before and after this place.
    pub labels: [Label; 2],
}

/// A network that grows, with an index of its pieces by place.
pub(crate) struct Builder<Label, Margin> {
    pub network: Network<Label, Margin>,
    pub stops: Vec<Stop>,
    /// The parts of divided curves, whose labels must be checked again.
    pub suspects: Vec<usize>,
    lengths: Lengths,
    /// The pieces (curve, node) in every cell of the window.
    cells: Vec<Vec<(usize, usize)>>,
}

/// The number of cells of the index along each axis.
const CELLS: usize = 64;

impl<Label: Clone + Eq, Margin: Clone + Ord> Builder<Label, Margin> {
    /// A network without curves.
    pub fn new(window: Window, lengths: Lengths) -> Self {
        let network = Network {
            window,
            curves: Vec::new(),
            vertices: Vec::new(),
            statistics: TraceStatistics::default(),
            unresolved: Vec::new(),
        };
        let cells = vec![Vec::new(); CELLS * CELLS];
        Self { network, stops: Vec::new(), suspects: Vec::new(), lengths, cells }
    }

    /// A network that was begun before.
    pub fn of(
        stops: Vec<Stop>,
        network: Network<Label, Margin>,
        suspects: Vec<usize>,
        lengths: Lengths,
    ) -> Self {
        let mut builder = Self { stops, suspects, ..Self::new(network.window, lengths) };
        builder.network = network;
        builder.enter_all();
        builder
    }

    /// Adds a vertex, unless it is known, and returns its index. A new vertex divides the curves
    /// that pass through it, and their parts become [suspects](Self::suspects).
    pub fn add_vertex(&mut self, special: &Special<Margin>) -> usize {
        let near = special.uncertainty + self.lengths.same;
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
        self.divide_curves(index);
        index
    }

    /// The margins of the curves that end at a vertex, with the nodes next to these ends.
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

    /// Moves a vertex, and the curves that end there, to a more accurate place.
    pub fn move_vertex(&mut self, index: usize, special: &Special<Margin>) {
        self.stops[index] = Stop { point: special.point, uncertainty: special.uncertainty };
        self.network.vertices[index].point = special.point;
        self.network.vertices[index].kind = special.kind;
        for curve in 0..self.network.curves.len() {
            let Some(ends) = self.network.curves[curve].ends else { continue };
            if !ends.contains(&index) {
                continue;
            }
            self.leave(curve);
            let nodes = &mut self.network.curves[curve].nodes;
            let last = nodes.len() - 1;
            for (node, vertex) in [0, last].into_iter().zip(ends) {
                if vertex == index {
                    nodes[node].point = special.point;
                }
            }
            self.enter(curve);
        }
    }

    /// Gives a curve other nodes.
    pub fn replace_nodes(&mut self, curve: usize, nodes: Vec<Node>) {
        self.leave(curve);
        self.network.curves[curve].nodes = nodes;
        self.enter(curve);
    }

    /// Another vertex at a place for which a vertex was solved. Its error must be no larger than
    /// the distance at which places are distinguished.
    pub fn same_place(&self, index: usize, special: &Special<Margin>) -> Option<usize> {
        let shortest = self.lengths.same;
        let is_there = |stop: &Stop| {
            let distance = (stop.point - special.point).norm();
            stop.uncertainty <= shortest && distance <= special.uncertainty + 2.0 * shortest
        };
        (0..self.stops.len()).find(|&other| other != index && is_there(&self.stops[other]))
    }

    /// A vertex that cannot be distinguished from `index`. A curve leads from one to the other, and
    /// is shorter than `near`; or a branch stalled at `index`, and the curve is shorter than runs
    /// can resolve in a narrow window.
    pub fn indistinct(&self, index: usize, near: f64) -> Option<usize> {
        let is_stalled = |vertex| self.network.unresolved.contains(&Unresolved::Stalled { vertex });
        let on_edge = |vertex: usize| self.network.vertices[vertex].kind.is_on_window();
        let Stop { point: from, uncertainty } = self.stops[index];
        let stalled = is_stalled(index);
        if !stalled && on_edge(index) {
            return None;
        }
        let farthest = if stalled { self.lengths.close } else { near };
        let is_short = |curve: &&Curve<Label, Margin>| {
            curve.nodes.iter().all(|node| (node.point - from).norm() <= farthest)
        };
        let other = |curve: &Curve<Label, Margin>| match curve.ends? {
            [start, end] if start == index && end != index => Some(end),
            [start, end] if end == index && start != index => Some(start),
            _ => None,
        };
        let is_better =
            |vertex: usize| !on_edge(vertex) && self.stops[vertex].uncertainty <= uncertainty;
        let mut others = self.network.curves.iter().filter(is_short).filter_map(other);
        others.find(|&vertex| !is_stalled(vertex) && (stalled || is_better(vertex)))
    }

    /// Leads the curves that end at a vertex to a better place, which may be another known vertex.
    pub fn lead_to(&mut self, index: usize, special: &Special<Margin>) {
        let target = self.add_vertex(special);
        if target != index {
            // A curve that it divides loses the part with the wrong labels.
            self.suspects.clear();
            self.join(index, target);
        }
    }

    /// Leads the curves that end at a vertex to another one. Removes the first vertex, the short
    /// curves between the two, and curves that lead back to it.
    pub fn join(&mut self, index: usize, target: usize) {
        let from = self.stops[index].point;
        let point = self.stops[target].point;
        let farthest = 2.0 * (point - from).norm();
        let mut removed = Vec::new();
        for curve in 0..self.network.curves.len() {
            let Some(ends) = self.network.curves[curve].ends.filter(|ends| ends.contains(&index))
            else {
                continue;
            };
            self.leave(curve);
            let own = &mut self.network.curves[curve];
            let is_short = own.nodes.iter().all(|node| (node.point - point).norm() <= farthest);
            if is_short && (ends.contains(&target) || ends == [index; 2]) {
                removed.push(curve);
            }
            let last = own.nodes.len() - 1;
            for (node, vertex) in [0, last].into_iter().zip(ends) {
                if vertex == index {
                    own.nodes[node].point = point;
                }
            }
            own.ends = Some(ends.map(|vertex| if vertex == index { target } else { vertex }));
            self.enter(curve);
        }
        self.remove_curves(&removed);
        self.remove_vertex(index);
    }

    /// Removes the vertices from the index `first` on at which no curve ends.
    pub fn drop_unused(&mut self, first: usize) {
        for vertex in (first..self.stops.len()).rev() {
            let ends = |curve: &Curve<_, _>| curve.ends.is_some_and(|ends| ends.contains(&vertex));
            if !self.network.curves.iter().any(ends) {
                self.remove_vertex(vertex);
            }
        }
    }

    /// Removes a vertex at which no curve ends. The indices of all later vertices change.
    fn remove_vertex(&mut self, index: usize) {
        self.stops.remove(index);
        self.network.vertices.remove(index);
        let moved = |vertex: usize| vertex - usize::from(vertex > index);
        for curve in &mut self.network.curves {
            curve.ends = curve.ends.map(|ends| ends.map(moved));
        }
        // A boundary that had no known cause to end there ends at a known vertex now.
        let stalled = Unresolved::Stalled { vertex: index };
        self.network.unresolved.retain(|open| *open != stalled);
        for open in &mut self.network.unresolved {
            if let Unresolved::Stalled { vertex } = open {
                *vertex = moved(*vertex);
            }
        }
    }

    /// Adds a curve. Of nodes that nearly coincide one is kept, preferably the end of the curve.
    pub fn add_curve(&mut self, mut curve: Curve<Label, Margin>) -> Option<usize> {
        let shortest = self.lengths.same;
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
        self.network.curves.push(curve);
        self.enter(index);
        Some(index)
    }

    /// Whether a place on a boundary with these labels on its sides lies on a known curve, whatever
    /// the margin of this curve is.
    pub fn covers(&self, point: &Point, labels: &[Label; 2]) -> bool {
        let near = self.lengths.touch;
        self.near(&[*point, *point]).into_iter().any(|(curve, piece)| {
            let sides = &self.network.curves[curve].sides;
            (sides == labels || (sides[0] == labels[1] && sides[1] == labels[0]))
                && self.arc(curve, piece).closest(point).1 < near
        })
    }

    /// Whether known curves through a place lead from one label to another, in any order: the
    /// curves are closer together than runs can resolve.
    fn leads(&self, point: &Point, labels: &[Label; 2]) -> bool {
        let near = 4.0 * self.lengths.touch;
        let pieces = self.near(&[*point, *point]).into_iter();
        let through =
            pieces.filter(|&(curve, piece)| self.arc(curve, piece).closest(point).1 < near);
        let sides: Vec<_> = through.map(|(curve, _)| &self.network.curves[curve].sides).collect();
        let mut reached = vec![&labels[0]];
        while let Some(next) = sides.iter().find_map(|[left, right]| {
            match [left, right].map(|label| reached.contains(&label)) {
                [true, false] => Some(right),
                [false, true] => Some(left),
                _ => None,
            }
        }) {
            reached.push(next);
        }
        reached.contains(&&labels[1])
    }

    /// Drops duplicates, and changes that curves found elsewhere explain, though no margin was
    /// found where the change was seen.
    pub fn drop_explained(&mut self) {
        for open in std::mem::take(&mut self.network.unresolved) {
            let explained = match &open {
                Unresolved::Change { between: [one, other], labels } => {
                    let middle = one.lerp(other, 0.5);
                    self.covers(&middle, labels) || self.leads(&middle, labels)
                }
                _ => false,
            };
            if !explained && !self.network.unresolved.contains(&open) {
                self.network.unresolved.push(open);
            }
        }
    }

    /// The places where the segment from `a` to `b` crosses curves, in order.
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
                // Places at the edge of a cell belong to its neighbour too.
                let place = bounds[end][axis] + sign * self.lengths.half;
                let part = (place - self.network.window.low[axis]) / extent[axis];
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
                let cell = (part * CELLS as f64).clamp(0.0, CELLS as f64 - 1.0) as usize;
                cell
            })
        })
    }

    /// Enters the pieces of a curve into the index.
    fn enter(&mut self, curve: usize) {
        self.each_cell(curve, |cell, piece| cell.push((curve, piece)));
    }

    /// Takes the pieces of a curve out of the index, before the curve changes.
    fn leave(&mut self, curve: usize) {
        self.each_cell(curve, |cell, _| cell.retain(|&(other, _)| other != curve));
    }

    /// Calls `f` with every cell that a piece of a curve may reach into, and the piece.
    fn each_cell(&mut self, curve: usize, f: impl Fn(&mut Vec<(usize, usize)>, usize)) {
        for piece in 0..self.network.curves[curve].nodes.len() - 1 {
            let [columns, rows] = self.cell_range(&self.arc(curve, piece).bounds());
            for column in columns[0]..=columns[1] {
                for row in rows[0]..=rows[1] {
                    f(&mut self.cells[column * CELLS + row], piece);
                }
            }
        }
    }

    /// The pieces that may reach into a box, in order.
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

    /// Divides the curves that pass through a vertex.
    fn divide_curves(&mut self, vertex: usize) {
        let Stop { point, uncertainty } = self.stops[vertex];
        let near = uncertainty + self.lengths.same;
        let mut hits: Vec<(usize, usize, f64)> = Vec::new();
        for (curve, piece) in self.near(&[point, point]) {
            let (theta, distance) = self.arc(curve, piece).closest(&point);
            let nodes = &self.network.curves[curve].nodes;
            let ends = self.network.curves[curve].ends.is_some()
                && [nodes[0], nodes[nodes.len() - 1]]
                    .iter()
                    .any(|end| (end.point - point).norm() <= near);
            // If two adjacent pieces of a curve pass through the vertex, the first one counts.
            if distance <= near && !ends && hits.last().is_none_or(|hit| hit.0 != curve) {
                hits.push((curve, piece, theta));
            }
        }
        for (curve, piece, theta) in hits {
            let tangent = self.arc(curve, piece).tangent(theta);
            let here = Node { point, tangent };
            self.suspects.push(curve);
            self.leave(curve);
            let own = &mut self.network.curves[curve];
            let after: Vec<Node> =
                std::iter::once(here).chain(own.nodes[piece + 1..].iter().copied()).collect();
            own.nodes.truncate(piece + 1);
            own.nodes.push(here);
            if let Some([start, end]) = own.ends {
                own.ends = Some([start, vertex]);
                let rest = Curve { nodes: after, ends: Some([vertex, end]), ..own.clone() };
                let index = self.network.curves.len();
                self.suspects.push(index);
                self.network.curves.push(rest);
                self.enter(index);
            } else {
                // A closed curve stays whole and starts at the vertex.
                let mut nodes = after;
                nodes.extend_from_slice(&own.nodes[1..]);
                own.nodes = nodes;
                own.ends = Some([vertex, vertex]);
            }
            self.enter(curve);
        }
    }

    /// Removes curves. The indices of all later curves change.
    pub fn remove_curves(&mut self, curves: &[usize]) {
        let mut removed = curves.to_vec();
        removed.sort_unstable();
        removed.dedup();
        for &curve in &removed {
            self.leave(curve);
        }
        let mut index = 0;
        self.network.curves.retain(|_| {
            index += 1;
            removed.binary_search(&(index - 1)).is_err()
        });
        for (curve, _) in self.cells.iter_mut().flatten() {
            *curve -= removed.partition_point(|&other| other < *curve);
        }
    }

    fn enter_all(&mut self) {
        for curve in 0..self.network.curves.len() {
            self.enter(curve);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::VertexKind;

    /// A boundary that stalled at a vertex ends at the vertex with which its own is joined.
    #[test]
    fn a_stalled_vertex_may_be_joined_with_another_one() {
        let window = Window { low: Point::new(0.0, 0.0), high: Point::new(1.0, 1.0) };
        let special = |x: f64, solved: bool| Special {
            point: Point::new(x, 0.5),
            kind: VertexKind::Crossing,
            margins: Vec::new(),
            uncertainty: 1e-12,
            solved,
        };
        let mut builder = Builder::<usize, usize>::new(window, Lengths::PARTS);
        let [first, last] =
            [special(0.2, true), special(0.4, false)].map(|special| builder.add_vertex(&special));
        builder.join(last, first);
        assert_eq!(builder.network.vertices.len(), 1);
        assert_eq!(builder.network.unresolved, []);
    }
}
