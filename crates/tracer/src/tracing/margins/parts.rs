//! The parts of lines that runs see: those with different labels on their two sides.

use crate::cubic::Cubic;
use crate::curve::{Curve, Node, Vertex};
use crate::family::Family;
use crate::lengths::{Lengths, angle};
use crate::tracing::fit::mirrored;
use crate::tracing::margins::line::{Cut, Line, Place};
use crate::tracing::margins::{Arranged, Lines};
use crate::tracing::runs::Traced;
use crate::window::Point;

/// Where parts are looked at, in parts of their length.
const SHARES: [f64; 7] = [0.5, 0.3, 0.7, 0.15, 0.85, 0.06, 0.94];

/// A part of a line.
#[derive(Clone, Copy)]
pub(super) struct Part {
    pub line: usize,
    /// The vertices at its ends; `None` for a whole closed line.
    pub cuts: Option<[Cut; 2]>,
}

impl Part {
    /// The places of the ends.
    fn ends<M: Clone>(&self, line: &Line<M>) -> [Place; 2] {
        self.cuts.map_or_else(|| [0, 1].map(|end| line.end(end)), |cuts| cuts.map(|cut| cut.place))
    }

    /// The length, by chords.
    pub fn length<M: Clone>(&self, line: &Line<M>) -> f64 {
        let [from, to] = self.ends(line);
        let (mut length, mut last) = (0.0, line.at(from));
        for node in from.piece + 1..=to.piece {
            length += (line.node(node).point - last).norm();
            last = line.node(node).point;
        }
        length + (line.at(to) - last).norm()
    }

    /// The place after a share of the length.
    fn place<M: Clone>(&self, line: &Line<M>, share: f64) -> Place {
        let [from, to] = self.ends(line);
        let mut left = share * self.length(line);
        let mut start = from;
        while start.piece < to.piece {
            let step = (line.node(start.piece + 1).point - line.at(start)).norm();
            if left <= step && step > 0.0 {
                let theta = start.theta + (1.0 - start.theta) * left / step;
                return Place { theta, ..start };
            }
            left -= step;
            start = Place { piece: start.piece + 1, theta: 0.0 };
        }
        let step = (line.at(to) - line.at(start)).norm();
        let part = if step > 0.0 { (left / step).min(1.0) } else { 0.0 };
        Place { theta: start.theta + (to.theta - start.theta) * part, ..start }
    }
}

/// A part with different labels on its sides.
struct Seen<L> {
    part: Part,
    sides: [L; 2],
}

impl<F: Family> Lines<'_, F> {
    /// The curves that runs see of the parts, and their vertices.
    pub(super) fn seen(
        &mut self,
        parts: &[Part],
        vertices: Vec<Vertex<F::Margin>>,
    ) -> Traced<Arranged<F>, F> {
        let (mut doubts, mut strips) = (Vec::new(), Vec::new());
        let mut all = Vec::new();
        for part in parts {
            self.runs.go_on()?;
            let sides = self.sides(part, &mut doubts, &mut strips)?;
            if sides[0] != sides[1] {
                let length = part.length(&self.all[part.line]);
                all.push((length, all.len(), Seen { part: *part, sides }));
            }
        }
        // Shorter parts may run along longer ones.
        all.sort_by(|one, other| other.0.total_cmp(&one.0));
        let mut seen: Vec<(usize, Seen<F::Label>)> = Vec::new();
        for (_, order, next) in all {
            self.runs.go_on()?;
            if !self.is_twin(&next, &seen) {
                seen.push((order, next));
            }
        }
        seen.sort_by_key(|(order, _)| *order);
        let seen: Vec<Seen<F::Label>> = seen.into_iter().map(|(_, seen)| seen).collect();
        let degrees = degrees(&seen, vertices.len());
        let seen = self.joined(seen, &degrees);
        let degrees = self::degrees(&seen, vertices.len());
        let mut curves: Vec<Curve<F::Label, F::Margin>> = Vec::new();
        for Seen { part, sides } in seen {
            let nodes = self.nodes(&part, &vertices);
            let ends = part.cuts.map(|cuts| cuts.map(|cut| cut.vertex));
            let margin = self.all[part.line].margin.clone();
            curves.push(Curve { margin, sides, nodes, ends });
        }
        let mut numbers = vec![0; vertices.len()];
        let mut kept: Vec<Vertex<F::Margin>> = Vec::new();
        for (index, vertex) in vertices.into_iter().enumerate() {
            if degrees[index] == 1 && !vertex.kind.is_on_window() {
                doubts.push(vertex.point);
            }
            if degrees[index] > 0 {
                numbers[index] = kept.len();
                kept.push(vertex);
            }
        }
        for ends in curves.iter_mut().filter_map(|curve| curve.ends.as_mut()) {
            *ends = ends.map(|vertex| numbers[vertex]);
        }
        for (index, vertex) in kept.iter_mut().enumerate() {
            let arrive =
                curves.iter().filter(|curve| curve.ends.is_some_and(|ends| ends.contains(&index)));
            vertex.margins.extend(arrive.map(|curve| curve.margin.clone()));
            vertex.margins.sort();
            vertex.margins.dedup();
        }
        Ok(Arranged { curves, vertices: kept, doubts, strips })
    }

    /// The labels on the left and on the right of a part, where it is farthest from other lines.
    /// Places where it has others are `doubts`, and segments beside it on which the label changes
    /// are `strips`.
    fn sides(
        &mut self,
        part: &Part,
        doubts: &mut Vec<Point>,
        strips: &mut Vec<[Point; 2]>,
    ) -> Traced<[F::Label; 2], F> {
        let (lengths, line) = (self.runs.lengths, &self.all[part.line]);
        let length = part.length(line);
        let places = SHARES.map(|share| part.place(line, share));
        let points = places.map(|place| line.at(place));
        let others = self.all.iter().enumerate().filter(|(index, _)| *index != part.line);
        // Lines that are one along the whole part do not make it narrow.
        let same = 4.0 * self.runs.options.interpolation;
        let others: Vec<[f64; 7]> = others
            .map(|(_, other)| points.map(|point| other.distance(&point, lengths.close)))
            .map(|distances| distances.map(|distance| distance.unwrap_or(lengths.close)))
            .filter(|distances| distances.iter().any(|distance| *distance > same))
            .collect();
        let mut places: Vec<(f64, Point, Point)> = (0..SHARES.len())
            .map(|index| {
                let width = others.iter().map(|distances| distances[index]);
                // Beyond an edge, lines end that labels know.
                let width = width.fold(lengths.close, f64::min);
                let width = width.min(self.runs.window.depth(&points[index]).max(0.0));
                (width, points[index], line.tangent(places[index]))
            })
            .collect();
        // Stable: of places that are as wide, the one nearest to the middle comes first.
        places.sort_by(|one, other| other.0.total_cmp(&one.0));
        let (width, point, tangent) = places[0];
        let sides = self.labels_beside(width, &point, &tangent)?;
        if length > lengths.around {
            for (width, place, tangent) in &places[5..] {
                if *width > lengths.half && self.labels_beside(*width, place, tangent)? != sides {
                    doubts.extend([*place, point]);
                }
            }
            if sides[0] != sides[1] {
                for (width, place, tangent) in &places[..3] {
                    strips.extend(self.strips(*width, place, tangent)?);
                }
            }
        }
        Ok(sides)
    }

    /// The segments beside a place, left and right, on which the label changes up to other lines
    /// that are so far away.
    fn strips(&mut self, width: f64, point: &Point, tangent: &Point) -> Traced<Vec<[Point; 2]>, F> {
        let options = &self.runs.options;
        let near = options.offset.max(4.0 * options.interpolation);
        let left = Point::new(-tangent.y, tangent.x);
        let mut found = Vec::new();
        if 0.3 * width > 2.0 * near {
            for normal in [left, -left] {
                let ends = [near, 0.3 * width].map(|away| point + normal * away);
                if self.label(&ends[0])? != self.label(&ends[1])? {
                    found.push(ends);
                }
            }
        }
        Ok(found)
    }

    /// The labels on the left and on the right of a place that is so far from other lines.
    fn labels_beside(
        &mut self,
        width: f64,
        point: &Point,
        tangent: &Point,
    ) -> Traced<[F::Label; 2], F> {
        let away = (0.3 * width).max(4.0 * self.runs.options.interpolation);
        let left = Point::new(-tangent.y, tangent.x) * away;
        Ok([self.label(&(point + left))?, self.label(&(point - left))?])
    }

    fn label(&mut self, point: &Point) -> Traced<F::Label, F> {
        let digits = [point.x.to_bits(), point.y.to_bits()];
        if let Some(label) = self.labels.get(&digits) {
            return Ok(label.clone());
        }
        let label = self.runs.label(point)?;
        self.labels.insert(digits, label.clone());
        Ok(label)
    }

    /// Whether a part runs along one that is seen: two margins are one function there, or cannot be
    /// told apart. Two sides of a strip have the labels of their sides in opposite order.
    fn is_twin(&self, part: &Seen<F::Label>, seen: &[(usize, Seen<F::Label>)]) -> bool {
        let line = &self.all[part.part.line];
        let places = SHARES.map(|share| part.part.place(line, share));
        let [left, right] = &part.sides;
        seen.iter().any(|(_, other)| {
            let along = &self.all[other.part.line];
            let [from, to] = other.part.ends(along);
            let touch = self.runs.lengths.touch;
            let runs_along = |place: &Place| {
                let near = along.near(&line.at(*place), touch).map(|(near, _)| near);
                near.is_some_and(|near| {
                    let same_way = along.tangent(near).dot(&line.tangent(*place)) > 0.0;
                    let sides = if same_way { [left, right] } else { [right, left] };
                    let inside = along.ends.is_none() || (from <= near && near <= to);
                    inside && other.sides.each_ref() == sides
                })
            };
            other.part.line != part.part.line && places.iter().all(runs_along)
        })
    }

    /// The parts, joined where nothing ends that runs see.
    fn joined(&self, seen: Vec<Seen<F::Label>>, degrees: &[usize]) -> Vec<Seen<F::Label>> {
        let passes = |one: &Seen<F::Label>, other: &Seen<F::Label>| {
            let (Some([_, end]), Some([start, _])) = (one.part.cuts, other.part.cuts) else {
                return false;
            };
            one.part.line == other.part.line
                && end.vertex == start.vertex
                && degrees[end.vertex] == 2
                && one.sides == other.sides
        };
        let mut joined: Vec<Seen<F::Label>> = Vec::new();
        for next in seen {
            match joined.last_mut() {
                Some(last) if passes(last, &next) => {
                    if let (Some(cuts), Some(more)) = (&mut last.part.cuts, next.part.cuts) {
                        cuts[1] = more[1];
                    }
                }
                _ => joined.push(next),
            }
        }
        // A closed line may go on behind its end.
        let mut index = 0;
        while index < joined.len() {
            let line = joined[index].part.line;
            let last = joined.iter().rposition(|other| other.part.line == line).unwrap_or(index);
            let is_closed = self.all[line].ends.is_none();
            if is_closed && passes(&joined[last], &joined[index]) {
                if last == index {
                    joined[index].part.cuts = None;
                } else if let Some([_, end]) = joined[index].part.cuts {
                    let piece = end.place.piece + self.all[line].pieces();
                    let end = Cut { place: Place { piece, ..end.place }, ..end };
                    if let Some(cuts) = &mut joined[last].part.cuts {
                        cuts[1] = end;
                    }
                    joined.remove(index);
                }
            }
            while joined.get(index).is_some_and(|other| other.part.line == line) {
                index += 1;
            }
        }
        joined
    }

    /// The nodes of a part, which ends at its vertices.
    fn nodes(&self, part: &Part, vertices: &[Vertex<F::Margin>]) -> Vec<Node> {
        let line = &self.all[part.line];
        let Some([from, to]) = part.cuts else { return line.nodes.clone() };
        let [start, end] = [from, to].map(|cut| Node {
            point: vertices[cut.vertex].point,
            tangent: line.tangent(cut.place),
        });
        let solved = self.runs.lengths.solved;
        let (mut nodes, [start, end]) = self.inner(line, [from, to], [start, end]);
        let is_moved =
            |cut: &Cut| (line.at(cut.place) - vertices[cut.vertex].point).norm() > solved;
        nodes.insert(0, start);
        if is_moved(&to) {
            self.lead(&mut nodes, end, part.line);
        } else {
            nodes.push(end);
        }
        if is_moved(&from) {
            let turned = |node: &Node| Node { tangent: -node.tangent, ..*node };
            nodes = nodes.iter().skip(1).rev().map(turned).collect();
            self.lead(&mut nodes, turned(&start), part.line);
            nodes = nodes.iter().rev().map(turned).collect();
        }
        nodes
    }

    /// The nodes that a part needs between its ends, and its ends. Close to them, where margins may
    /// be flat, nodes and tangents have errors. A part has none there if one cubic shows as much.
    fn inner(
        &self,
        line: &Line<F::Margin>,
        [from, to]: [Cut; 2],
        ends: [Node; 2],
    ) -> (Vec<Node>, [Node; 2]) {
        let Lengths { piece, close, around, .. } = self.runs.lengths;
        let numbers = from.place.piece + 1..=to.place.piece;
        let all: Vec<Node> = numbers.clone().map(|index| *line.node(index)).collect();
        let middles = numbers.skip(1).map(|index| line.cubic(index - 1).at(0.5));
        let samples: Vec<Point> = all.iter().map(|node| node.point).chain(middles).collect();
        let apart =
            |point: &Point, room: f64| ends.iter().all(|end| (point - end.point).norm() > room);
        let beyond = |room: f64| -> Vec<Node> {
            all.iter().filter(|node| apart(&node.point, room)).copied().collect()
        };
        for room in [around, close] {
            let nodes = beyond(room);
            let (Some(first), Some(last)) = (nodes.first(), nodes.last()) else { continue };
            let back = -mirrored(&-first.tangent, &(ends[0].point - first.point));
            let forth = mirrored(&last.tangent, &(ends[1].point - last.point));
            let circular = [Node { tangent: back, ..ends[0] }, Node { tangent: forth, ..ends[1] }];
            for ends in [ends, circular] {
                let arcs = [Cubic::between(&ends[0], first), Cubic::between(last, &ends[1])];
                let fits = |point: &Point| {
                    let off = arcs.iter().map(|arc| arc.closest(point).1);
                    off.fold(f64::INFINITY, f64::min) <= self.runs.options.interpolation
                };
                if samples.iter().filter(|point| !apart(point, room)).all(fits) {
                    return (nodes, ends);
                }
            }
        }
        (beyond(piece), ends)
    }

    /// Leads a curve on a line to a place that is a little farther, or beside its last node.
    fn lead(&self, nodes: &mut Vec<Node>, end: Node, line: usize) {
        let misses = |node: &Node| node.tangent.angle(&(end.point - node.point)) > angle::PARALLEL;
        while nodes.len() > 1 && nodes.last().is_some_and(misses) {
            nodes.pop();
        }
        let Some(last) = nodes.last() else { return };
        let chord = end.point - last.point;
        let tangent = if misses(last) {
            chord.normalize()
        } else {
            let circular = mirrored(&last.tangent, &chord);
            self.beside(&end.point, &circular, line).unwrap_or(circular)
        };
        nodes.push(Node { point: end.point, tangent });
    }

    /// The tangent of another line at a vertex where a line with nearly this tangent ends. It
    /// begins there on the other one.
    fn beside(&self, vertex: &Point, tangent: &Point, line: usize) -> Option<Point> {
        let others = self.all.iter().enumerate().filter(|(other, _)| *other != line);
        let tangents = others.filter_map(|(_, other)| {
            let (place, _) = other.near(vertex, 2.0 * self.runs.lengths.same)?;
            let along = other.tangent(place);
            Some(along * along.dot(tangent).signum())
        });
        let near = tangents.filter(|along| along.angle(tangent) < angle::ORDERED);
        near.min_by(|one, other| one.angle(tangent).total_cmp(&other.angle(tangent)))
    }
}

/// How many parts end at each vertex.
fn degrees<L>(seen: &[Seen<L>], vertices: usize) -> Vec<usize> {
    let mut degrees = vec![0; vertices];
    for cut in seen.iter().filter_map(|seen| seen.part.cuts).flatten() {
        degrees[cut.vertex] += 1;
    }
    degrees
}
