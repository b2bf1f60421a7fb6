//! The zero set of one margin, followed as far as the margin exists.

use crate::cubic::Cubic;
use crate::cubic::bernstein::each_root;
use crate::curve::Node;
use crate::family::Family;
use crate::tracing::corrector::{correct, correct_on_edge};
use crate::tracing::runs::{Runs, Traced};
use crate::window::{Point, Window};

/// Where a line ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reach {
    /// On an edge of the window.
    Edge,
    /// Where the margin could not be followed any further.
    Lost,
    /// Where it has as many nodes as the options allow.
    Limit,
}

/// The zero set of a margin.
#[derive(Clone, Debug)]
pub(super) struct Line<M> {
    /// The margin, as it is called where the line was found.
    pub margin: M,
    /// The nodes, of which a closed line repeats the first one.
    pub nodes: Vec<Node>,
    /// The name of the margin at each node.
    pub names: Vec<M>,
    /// Where it ends at its first and at its last node; `None` if it is closed.
    pub ends: Option<[Reach; 2]>,
    /// The corners of a rectangle around the line.
    bounds: [Point; 2],
}

/// A place on a line.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(super) struct Place {
    /// The cubic, counted from the first one. On a closed line, counting may go on behind the last.
    pub piece: usize,
    /// The parameter on the cubic, from 0 to 1.
    pub theta: f64,
}

/// A vertex at which a line is divided.
#[derive(Clone, Copy)]
pub(super) struct Cut {
    pub place: Place,
    pub vertex: usize,
}

impl<M: Clone> Line<M> {
    fn new(margin: &M, track: Track<M>, ends: Option<[Reach; 2]>) -> Self {
        let Track { nodes, names } = track;
        let mut line =
            Self { margin: margin.clone(), nodes, names, ends, bounds: [Point::zeros(); 2] };
        let first = line.cubic(0).bounds();
        line.bounds = (1..line.pieces())
            .map(|piece| line.cubic(piece).bounds())
            .fold(first, |[low, high], [least, most]| [low.inf(&least), high.sup(&most)]);
        line
    }

    /// The number of cubics.
    pub fn pieces(&self) -> usize {
        self.nodes.len() - 1
    }

    /// The cubic with this number.
    pub fn cubic(&self, piece: usize) -> Cubic {
        Cubic::between(self.node(piece), self.node(piece + 1))
    }

    /// The node with this number. A closed line goes on behind its end.
    pub fn node(&self, index: usize) -> &Node {
        if self.ends.is_none() { &self.nodes[index % self.pieces()] } else { &self.nodes[index] }
    }

    /// The last point at the start, or at the end.
    pub fn tip(&self, end: usize) -> Point {
        self.nodes[if end == 0 { 0 } else { self.pieces() }].point
    }

    /// The name of the margin at the start, or at the end.
    pub fn name(&self, end: usize) -> &M {
        &self.names[if end == 0 { 0 } else { self.pieces() }]
    }

    /// The node at the start, or at the end, with its tangent outwards.
    pub fn last(&self, end: usize) -> Node {
        let node = self.nodes[if end == 0 { 0 } else { self.pieces() }];
        if end == 0 { Node { tangent: -node.tangent, ..node } } else { node }
    }

    /// The place of the start, or of the end.
    pub fn end(&self, end: usize) -> Place {
        if end == 0 {
            Place { piece: 0, theta: 0.0 }
        } else {
            Place { piece: self.pieces() - 1, theta: 1.0 }
        }
    }

    pub fn at(&self, place: Place) -> Point {
        self.cubic(place.piece).at(place.theta)
    }

    /// The direction at a place.
    pub fn tangent(&self, place: Place) -> Point {
        match place.theta {
            0.0 => self.node(place.piece).tangent,
            1.0 => self.node(place.piece + 1).tangent,
            theta => self.cubic(place.piece).tangent(theta),
        }
    }

    /// The place of the line that is closest to `point`, and its distance, if it is no farther than
    /// `reach`.
    pub fn near(&self, point: &Point, reach: f64) -> Option<(Place, f64)> {
        let beyond = |low: &Point, high: &Point, room: f64| {
            point.x < low.x - room
                || point.x > high.x + room
                || point.y < low.y - room
                || point.y > high.y + room
        };
        if beyond(&self.bounds[0], &self.bounds[1], reach) {
            return None;
        }
        let mut best: Option<(Place, f64)> = None;
        for piece in 0..self.pieces() {
            let [a, b] = [self.nodes[piece].point, self.nodes[piece + 1].point];
            // A cubic bulges by less, since it turns little.
            let room = 0.2 * (b - a).norm() + reach;
            if beyond(&a.inf(&b), &a.sup(&b), room) {
                continue;
            }
            let (theta, distance) = self.cubic(piece).closest(point);
            if distance <= reach && best.is_none_or(|(_, least)| distance < least) {
                best = Some((Place { piece, theta }, distance));
            }
        }
        best
    }

    /// The distance of a point, if it is no farther than `reach`.
    pub fn distance(&self, point: &Point, reach: f64) -> Option<f64> {
        self.near(point, reach).map(|(_, distance)| distance)
    }

    /// The places from 0 to 1 where the line crosses a segment under this name.
    pub fn crossings(&self, a: &Point, b: &Point, name: &M) -> Vec<f64>
    where
        M: PartialEq,
    {
        let (low, high) = (a.inf(b), a.sup(b));
        let apart = |[least, most]: &[Point; 2]| {
            (0..2).any(|axis| most[axis] < low[axis] || least[axis] > high[axis])
        };
        let mut places = Vec::new();
        if !apart(&self.bounds) {
            for piece in 0..self.pieces() {
                let cubic = self.cubic(piece);
                let named = self.margin == *name || self.names[piece] == *name;
                if named && !apart(&cubic.bounds()) {
                    places.extend(cubic.crossings(a, b).into_iter().map(|[_, place]| place));
                }
            }
        }
        places
    }

    /// Whether the line crosses a segment.
    pub fn crosses(&self, a: &Point, b: &Point) -> bool {
        let (low, high) = (a.inf(b), a.sup(b));
        let apart = |[least, most]: &[Point; 2]| {
            (0..2).any(|axis| most[axis] < low[axis] || least[axis] > high[axis])
        };
        !apart(&self.bounds)
            && (0..self.pieces()).any(|piece| {
                let cubic = self.cubic(piece);
                !apart(&cubic.bounds()) && !cubic.crossings(a, b).is_empty()
            })
    }

    /// Whether another line runs along the whole of this one.
    pub fn is_part_of(&self, other: &Self, reach: f64) -> bool {
        let last = self.pieces();
        [0, last / 4, last / 2, 3 * last / 4, last - 1].into_iter().all(|piece| {
            let place = Place { piece, theta: if piece == 0 { 0.3 } else { 0.7 } };
            other.near(&self.at(place), reach).is_some()
        })
    }
}

/// Nodes in one direction, with the names of the margin there.
struct Track<M> {
    nodes: Vec<Node>,
    names: Vec<M>,
}

/// The line of a margin through a place on it, where it has this gradient; `None` if no step can be
/// taken.
pub(super) fn trace<F: Family>(
    runs: &Runs<'_, F>,
    margin: &F::Margin,
    origin: &Point,
    gradient: &Point,
) -> Traced<Option<Line<F::Margin>>, F> {
    let tangent = Point::new(gradient.y, -gradient.x).normalize();
    let start = Node { point: *origin, tangent };
    let (mut track, end) = follow(runs, margin, &start, gradient)?;
    let Some(end) = end else { return Ok(Some(Line::new(margin, track, None))) };
    let back = Node { point: *origin, tangent: -tangent };
    let (behind, first) = follow(runs, margin, &back, gradient)?;
    let turned = behind.nodes.iter().skip(1).rev();
    let mut nodes: Vec<Node> =
        turned.map(|node| Node { point: node.point, tangent: -node.tangent }).collect();
    let mut names: Vec<F::Margin> = behind.names.iter().skip(1).rev().cloned().collect();
    nodes.append(&mut track.nodes);
    names.append(&mut track.names);
    // A line that comes back the other way would have come back the first way.
    let ends = [first.unwrap_or(Reach::Lost), end];
    Ok((nodes.len() > 1).then(|| Line::new(margin, Track { nodes, names }, Some(ends))))
}

/// A place of a cubic that is farther beyond an edge of a window than `room`, or the end if that is
/// beyond: the first such place.
fn beyond(arc: &Cubic, window: &Window, room: f64) -> Option<f64> {
    let end = (!window.contains(&arc.points[3])).then_some(1.0);
    let bulge = |axis: usize, edge: f64, sign: f64| {
        let heights = arc.points.map(|point| sign * (point[axis] - edge));
        if heights.iter().all(|height| *height <= room) {
            return None;
        }
        let mut places = Vec::new();
        each_root(&heights, &mut |theta| places.push(theta));
        places.push(1.0);
        // Between two places on the edge, the cubic is on one side of it.
        let between = places.windows(2).map(|pair| f64::midpoint(pair[0], pair[1]));
        between.into_iter().find(|theta| sign * (arc.at(*theta)[axis] - edge) > room)
    };
    let edges =
        (0..2).flat_map(|axis| [(axis, window.low[axis], -1.0), (axis, window.high[axis], 1.0)]);
    let bulges = edges.filter_map(|(axis, edge, sign)| bulge(axis, edge, sign));
    bulges.chain(end).min_by(f64::total_cmp)
}

/// Follows a margin in one direction. The end is `None` if the line is closed.
fn follow<F: Family>(
    runs: &Runs<'_, F>,
    margin: &F::Margin,
    start: &Node,
    gradient: &Point,
) -> Traced<(Track<F::Margin>, Option<Reach>), F> {
    let (options, lengths) = (&runs.options, &runs.lengths);
    let mut track = Track { nodes: vec![*start], names: vec![margin.clone()] };
    let mut step = Step {
        runs,
        node: *start,
        gradient: *gradient,
        name: margin.clone(),
        curvature: 0.0,
        radius: 0.1 * lengths.scale,
    };
    let mut h = lengths.around;
    while track.nodes.len() < options.max_nodes {
        if h < lengths.same {
            step.end(&mut track)?;
            return Ok((track, Some(Reach::Lost)));
        }
        h = h.min(options.max_step * lengths.scale);
        let Taken { next, gradient, error, evaluations } = match step.attempt(h)? {
            Ok(taken) => taken,
            Err(factor) => {
                h *= factor;
                continue;
            }
        };
        let arc = Cubic::between(&step.node, &next);
        if let Some(outside) = beyond(&arc, &runs.window, 2.0 * options.interpolation) {
            step.leave(&arc, outside, &gradient, &mut track)?;
            return Ok((track, Some(Reach::Edge)));
        }
        if track.nodes.len() > 3 {
            let (theta, distance) = arc.closest(&start.point);
            let same_way = arc.tangent(theta).dot(&start.tangent) > 0.9;
            if distance < lengths.same && theta > 0.0 && theta < 1.0 && same_way {
                track.nodes.push(*start);
                track.names.push(margin.clone());
                return Ok((track, None));
            }
        }
        let angle = step.node.tangent.angle(&next.tangent);
        let by_error = (0.4 * options.interpolation / error.max(f64::MIN_POSITIVE)).powf(0.25);
        let by_angle = 0.7 * options.max_angle / angle.max(f64::MIN_POSITIVE);
        let by_effort = 4.0 / evaluations as f64;
        h = arc.chord() * by_error.min(by_angle).min(by_effort).clamp(0.3, 2.0);
        step.go(next, gradient)?;
        track.nodes.push(next);
        track.names.push(step.name.clone());
    }
    Ok((track, Some(Reach::Limit)))
}

/// Where a step begins.
struct Step<'r, 'f, F: Family> {
    runs: &'r Runs<'f, F>,
    node: Node,
    gradient: Point,
    name: F::Margin,
    curvature: f64,
    radius: f64,
}

/// A step that was taken.
struct Taken {
    next: Node,
    gradient: Point,
    error: f64,
    evaluations: usize,
}

impl<F: Family> Step<'_, '_, F> {
    /// A step of the length `h`, or by what it has to be shortened.
    fn attempt(&self, h: f64) -> Traced<Result<Taken, f64>, F> {
        const LOST: f64 = 0.4;
        let (runs, node, name) = (self.runs, &self.node, &self.name);
        let options = &runs.options;
        let normal = Point::new(-node.tangent.y, node.tangent.x);
        let guess = node.point + node.tangent * h + normal * (0.5 * self.curvature * h * h);
        let reach = 0.3 * h + 100.0 * options.tolerance;
        let Some(found) = correct(runs, name, &guess, &self.gradient, reach)? else {
            return Ok(Err(LOST));
        };
        let gradient = runs.gradient(&found.point, name, &node.tangent, self.radius)?;
        let Some(gradient) = gradient else { return Ok(Err(LOST)) };
        // The margin is positive on the same side all along.
        let side = node.tangent.perp(&self.gradient).signum();
        let tangent = side * Point::new(gradient.y, -gradient.x).normalize();
        if node.tangent.angle(&tangent) > options.max_angle {
            return Ok(Err(0.5));
        }
        let next = Node { point: found.point, tangent };
        let arc = Cubic::between(node, &next);
        let slope = 0.5 * (gradient.norm() + self.gradient.norm());
        let mut error: f64 = 0.0;
        for theta in [0.3, 0.7] {
            let Some(value) = runs.margin(&arc.at(theta), name)? else { return Ok(Err(LOST)) };
            // The error at these places is 0.7 of the largest one.
            error = error.max((value.abs() - options.noise).max(0.0) / slope / 0.7);
        }
        if error > options.interpolation && arc.chord() > runs.lengths.half {
            let shorter = (0.4 * options.interpolation / error).powf(0.25).clamp(0.1, 0.7);
            return Ok(Err(shorter * arc.chord() / h));
        }
        Ok(Ok(Taken { next, gradient, error, evaluations: found.evaluations }))
    }

    /// Goes on to a node.
    fn go(&mut self, next: Node, gradient: Point) -> Traced<(), F> {
        let arc = Cubic::between(&self.node, &next);
        let turn = self.node.tangent.perp(&next.tangent).clamp(-1.0, 1.0).asin();
        self.curvature = turn / arc.chord();
        self.radius = (arc.chord() / turn.abs()).min(self.runs.lengths.scale);
        self.name = self.runs.moved(&next.point, &self.name)?;
        (self.node, self.gradient) = (next, gradient);
        Ok(())
    }

    /// Moves the last node of a track that was lost to where the margin ceases to exist.
    fn end(&self, track: &mut Track<F::Margin>) -> Traced<(), F> {
        let (runs, node) = (self.runs, &self.node);
        let (mut exists, mut ceases) = (0.0, runs.lengths.same);
        let mut last = node.point;
        while ceases - exists > runs.options.tolerance {
            let middle = f64::midpoint(exists, ceases);
            if middle <= exists || middle >= ceases {
                break;
            }
            let guess = node.point + node.tangent * middle;
            match correct(runs, &self.name, &guess, &self.gradient, 0.3 * middle)? {
                Some(found) if runs.window.contains(&found.point) => {
                    (exists, last) = (middle, found.point);
                }
                _ => ceases = middle,
            }
        }
        // The only node of a track is where the other track begins.
        if let [_, .., end] = &mut track.nodes[..] {
            end.point = last;
        }
        Ok(())
    }

    /// Ends a track on the edge through which a cubic leaves the window before a place that is
    /// outside.
    fn leave(
        &self,
        arc: &Cubic,
        mut outside: f64,
        gradient: &Point,
        track: &mut Track<F::Margin>,
    ) -> Traced<(), F> {
        let (runs, window) = (self.runs, self.runs.window);
        let mut inside = 0.0;
        while outside - inside > f64::EPSILON {
            let middle = f64::midpoint(inside, outside);
            if window.contains(&arc.at(middle)) {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        let exit = arc.at(outside);
        let axis = usize::from(exit.y < window.low.y || exit.y > window.high.y);
        let mut guess = arc.at(inside);
        guess[axis] = if exit[axis] > window.high[axis] { window.high } else { window.low }[axis];
        let reach = 0.3 * arc.chord() + runs.lengths.same;
        let solved = correct_on_edge(runs, &self.name, &guess, gradient, axis, reach)?;
        let point = solved.unwrap_or(guess).sup(&window.low).inf(&window.high);
        if (point - self.node.point).norm() > runs.lengths.least {
            track.nodes.push(Node { point, tangent: arc.tangent(inside) });
            track.names.push(self.name.clone());
        } else if let [_, .., last] = &mut track.nodes[..] {
            last.point = point;
        }
        Ok(())
    }
}
