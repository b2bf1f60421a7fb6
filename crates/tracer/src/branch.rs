//! One boundary, followed step by step.

use std::collections::VecDeque;

use crate::arc::Arc;
use crate::corrector::correct;
use crate::curve::{Node, VertexKind};
use crate::family::{Family, FreeRun, Point};
use crate::runs::{Runs, Traced};
use crate::special;

/// Nodes closer than this part of the window's shorter extent are one.
pub(crate) const SHORTEST: f64 = 1e-9;

/// A place on a boundary from which it can be followed.
#[derive(Clone, Debug)]
pub(crate) struct Seed<Label, Margin> {
    pub point: Point,
    /// A unit vector along the boundary.
    pub tangent: Point,
    pub margin: Margin,
    /// Labels where the margin is positive and where it is negative.
    pub labels: [Label; 2],
}

/// Why a branch ended.
#[derive(Clone, Debug)]
pub(crate) enum End<Margin> {
    /// It came back to where it started.
    Closed,
    /// At a vertex that was known, by its index.
    Known(usize),
    /// At a vertex that it found.
    Vertex(Special<Margin>),
    /// It has too many nodes.
    Limit,
}

/// A vertex as a branch finds it.
#[derive(Clone, Debug)]
pub(crate) struct Special<Margin> {
    pub point: Point,
    pub kind: VertexKind,
    pub margins: Vec<Margin>,
    /// How far off it may be.
    pub uncertainty: f64,
    /// Whether it was solved for; else it is only where the branch could not go on.
    pub solved: bool,
}

/// A vertex that is known, where branches through it end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stop {
    pub point: Point,
    pub uncertainty: f64,
}

/// An accepted place, with what is known there.
#[derive(Clone, Debug)]
pub(crate) struct Foothold<Label, Margin> {
    pub node: Node,
    pub gradient: Point,
    /// Free runs on the left and on the right.
    pub sides: [FreeRun<Label, Margin>; 2],
}

/// The label and margin types of a family, in a foothold.
pub(crate) type FootholdOf<F> = Foothold<<F as Family>::Label, <F as Family>::Margin>;

/// A boundary followed in one direction: an iterator over its nodes, the start not among them.
///
/// It runs one node behind the foothold, because a special point between the last two steps may take the last node back.
pub(crate) struct Branch<'a, 'f, F: Family> {
    pub(crate) runs: &'a Runs<'f, F>,
    pub(crate) margin: F::Margin,
    /// Labels on the left and on the right.
    pub(crate) sides: [F::Label; 2],
    /// 1 where the margin is positive on the left, −1 where it is on the right.
    pub(crate) orientation: f64,
    stops: &'a [Stop],
    origin: Node,
    /// The last two footholds.
    trail: VecDeque<FootholdOf<F>>,
    /// Whether the last of them is still to be handed out.
    held: bool,
    step: f64,
    radius: f64,
    taken: usize,
    ready: VecDeque<Node>,
    end: Option<End<F::Margin>>,
    pub(crate) rejected: usize,
}

/// What became of a step.
enum Attempt<Label, Margin> {
    Accepted {
        foothold: Foothold<Label, Margin>,
        error: f64,
        evaluations: usize,
        edge: bool,
    },
    /// The margin does not exist, or its zero is not found.
    Lost,
    /// It turns too much, by this angle.
    Turn(f64),
    /// The cubic misses it by this distance.
    Rough(f64),
    /// Labels on the sides are others.
    Labels(Foothold<Label, Margin>),
}

impl<'a, 'f, F: Family> Branch<'a, 'f, F> {
    /// The branch that leaves `seed` with the positive side on its left, or the other way; `None` if the seed is not on a
    /// boundary between its labels.
    pub fn new(
        runs: &'a Runs<'f, F>,
        seed: &Seed<F::Label, F::Margin>,
        forward: bool,
        stops: &'a [Stop],
    ) -> Traced<Option<Self>, F> {
        let [positive, negative] = seed.labels.clone();
        let (orientation, sides) =
            if forward { (1.0, [positive, negative]) } else { (-1.0, [negative, positive]) };
        let step = 1e-3 * runs.scale;
        let mut branch = Self {
            runs,
            margin: seed.margin.clone(),
            sides,
            orientation,
            stops,
            origin: Node { point: seed.point, tangent: Point::zeros() },
            trail: VecDeque::new(),
            held: false,
            step,
            radius: 0.1 * runs.scale,
            taken: 0,
            ready: VecDeque::new(),
            end: None,
            rejected: 0,
        };
        let Some(gradient) =
            runs.gradient(&seed.point, &seed.margin, &seed.tangent, branch.radius)?
        else {
            return Ok(None);
        };
        let Some(foothold) = branch.foothold(&seed.point, &gradient)?.ok() else { return Ok(None) };
        branch.origin = foothold.node;
        branch.trail.push_back(foothold);
        Ok(Some(branch))
    }

    /// Where it starts.
    pub fn origin(&self) -> Node {
        self.origin
    }

    /// Why it ended; `None` as long as it goes on.
    pub fn end(&self) -> Option<&End<F::Margin>> {
        self.end.as_ref()
    }

    /// The radius of curvature where it is.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The next node, or `None` at the end.
    pub fn advance(&mut self) -> Traced<Option<Node>, F> {
        while self.ready.is_empty() && self.end.is_none() {
            self.take_step()?;
        }
        Ok(self.ready.pop_front())
    }

    /// Tangent at a place with this gradient.
    pub fn tangent(&self, gradient: &Point) -> Point {
        Point::new(gradient.y, -gradient.x) * (self.orientation / gradient.norm())
    }

    /// The place on the boundary with the free runs on both sides; `Err` if their labels are not those of the branch.
    ///
    /// Where another boundary is closer than the offset, a smaller offset is tried, as far as the place itself is known.
    pub fn foothold(
        &self,
        point: &Point,
        gradient: &Point,
    ) -> Traced<Result<FootholdOf<F>, FootholdOf<F>>, F> {
        let tangent = self.tangent(gradient);
        let left = Point::new(-tangent.y, tangent.x);
        let resolution = self.runs.resolution(gradient.norm());
        let mut offset = self.runs.options.offset.max(10.0 * resolution);
        let node = Node { point: *point, tangent };
        let mut first = None;
        loop {
            let sides = [
                self.runs.free(&(point + left * offset))?,
                self.runs.free(&(point - left * offset))?,
            ];
            let holds = sides[0].label == self.sides[0] && sides[1].label == self.sides[1];
            let foothold = Foothold { node, gradient: *gradient, sides };
            if holds {
                return Ok(Ok(foothold));
            }
            offset *= 0.1;
            let widest = first.get_or_insert(foothold);
            if offset < 5.0 * resolution {
                return Ok(Err(widest.clone()));
            }
        }
    }

    fn take_step(&mut self) -> Traced<(), F> {
        let Some(from) = self.trail.back().cloned() else { return Ok(()) };
        if self.taken >= self.runs.options.max_nodes {
            return self.finish(End::Limit, None);
        }
        let mut h = self.limited_step(&from.node);
        let first_step = h;
        let mut failures = 0_u32;
        loop {
            let attempt = self.attempt(&from, h)?;
            let turned = matches!(attempt, Attempt::Turn(angle) if angle >= 1.0);
            let (factor, beyond) = match attempt {
                Attempt::Accepted { foothold, error, evaluations, edge } => {
                    return self.accept(&from, foothold, error, evaluations, edge, failures > 0);
                }
                Attempt::Turn(angle) if angle < 1.0 => {
                    ((0.8 * self.runs.options.max_angle / angle).clamp(0.1, 0.8), None)
                }
                Attempt::Rough(error) => (
                    (0.5 * self.runs.options.interpolation / error).powf(0.25).clamp(0.1, 0.8),
                    None,
                ),
                Attempt::Lost | Attempt::Turn(_) => (0.5, None),
                Attempt::Labels(beyond) => (0.5, Some(beyond)),
            };
            self.rejected += 1;
            failures += 1;
            if let Some(index) = self.aim(&from, h)? {
                return self.finish(End::Known(index), None);
            }
            let stuck = h < 1e-2 * first_step || beyond.is_some() || turned;
            if stuck && matches!(failures, 1 | 4 | 8 | 16 | 24 | 32) {
                if let Some(special) = special::locate(self, &from, beyond.as_ref(), h)? {
                    return self.finish_at(special);
                }
            }
            if h < 1e-12 * self.runs.scale {
                let special = special::give_up(self, &from, h)?;
                return self.finish_at(special);
            }
            h *= factor;
        }
    }

    /// The step to try: not far beyond the window.
    fn limited_step(&self, from: &Node) -> f64 {
        let window = &self.runs.window;
        let mut exit = f64::INFINITY;
        for axis in 0..2 {
            let speed = from.tangent[axis];
            let room = if speed > 0.0 {
                window.high[axis] - from.point[axis]
            } else {
                from.point[axis] - window.low[axis]
            };
            exit = exit.min(room.max(0.0) / speed.abs());
        }
        self.step
            .min(self.runs.options.max_step * self.runs.scale)
            .min(exit + 1e-3 * self.runs.scale)
    }

    fn attempt(&self, from: &FootholdOf<F>, h: f64) -> Traced<Attempt<F::Label, F::Margin>, F> {
        let runs = self.runs;
        let guess = self.predict(&from.node, h);
        let reach = 0.3 * h + 100.0 * runs.options.tolerance;
        let Some(corrected) = correct(runs, &self.margin, &guess, &from.gradient, reach)? else {
            return Ok(Attempt::Lost);
        };
        let Some(gradient) =
            runs.gradient(&corrected.point, &self.margin, &from.node.tangent, self.radius)?
        else {
            return Ok(Attempt::Lost);
        };
        let tangent = self.tangent(&gradient);
        let angle = from.node.tangent.angle(&tangent);
        if !(angle <= runs.options.max_angle) {
            return Ok(Attempt::Turn(angle));
        }
        let node = Node { point: corrected.point, tangent };
        let arc = Arc::between(&from.node, &node);
        // Off the middle, where the errors of fourth and of fifth order both show; the first has 0.7 of its maximum there.
        let Some(value) = runs.margin(&arc.point(0.3), &self.margin)? else {
            return Ok(Attempt::Lost);
        };
        let slope = 0.5 * (gradient.norm() + from.gradient.norm());
        let error = ((value.abs() - runs.options.noise) / slope / 0.7).max(0.0);
        if !(error <= runs.options.interpolation) {
            return Ok(Attempt::Rough(error));
        }
        let (point, gradient, edge) = match self.leave_window(&arc, &gradient)? {
            Some(point) => {
                let Some(gradient) = runs.gradient(&point, &self.margin, &tangent, self.radius)?
                else {
                    return Ok(Attempt::Lost);
                };
                (point, gradient, true)
            }
            None => (corrected.point, gradient, false),
        };
        Ok(match self.foothold(&point, &gradient)? {
            Ok(foothold) => {
                Attempt::Accepted { foothold, error, evaluations: corrected.evaluations, edge }
            }
            Err(beyond) => Attempt::Labels(beyond),
        })
    }

    /// The last cubic goes on, if the step is not much longer than it; else the tangent.
    pub fn predict(&self, from: &Node, h: f64) -> Point {
        let before = self.trail.len().checked_sub(2).map(|index| self.trail[index].node);
        if let Some(before) = before {
            let arc = Arc::between(&before, from);
            if h < 2.5 * arc.chord() && arc.chord() > 1e-6 * self.runs.scale {
                return arc.point(1.0 + h / arc.chord());
            }
        }
        from.point + from.tangent * h
    }

    /// Where the piece leaves the window, solved on the edge; `None` if it does not.
    fn leave_window(&self, arc: &Arc, gradient: &Point) -> Traced<Option<Point>, F> {
        let window = &self.runs.window;
        if window.contains(&arc.point(1.0)) {
            return Ok(None);
        }
        let (mut inside, mut outside) = (0.0, 1.0);
        for _ in 0..50 {
            let middle = 0.5 * (inside + outside);
            if window.contains(&arc.point(middle)) { inside = middle } else { outside = middle }
        }
        let exit = arc.point(outside);
        let axis = usize::from(exit.y < window.low.y || exit.y > window.high.y);
        let edge =
            if exit[axis] > window.high[axis] { window.high[axis] } else { window.low[axis] };
        let mut guess = arc.point(inside);
        guess[axis] = edge;
        let mut along = *gradient;
        along[axis] = 0.0;
        let reach = 0.3 * arc.chord();
        let solved = if along.norm() > 1e-3 * gradient.norm() {
            correct(self.runs, &self.margin, &guess, &along, reach)?
        } else {
            correct(self.runs, &self.margin, &guess, gradient, reach)?
        };
        let mut point = solved.map_or(guess, |found| found.point);
        point[axis] = edge;
        Ok(Some(point.sup(&window.low).inf(&window.high)))
    }

    fn accept(
        &mut self,
        from: &FootholdOf<F>,
        foothold: FootholdOf<F>,
        error: f64,
        evaluations: usize,
        edge: bool,
        shortened: bool,
    ) -> Traced<(), F> {
        let arc = Arc::between(&from.node, &foothold.node);
        let options = &self.runs.options;
        let angle = from.node.tangent.angle(&foothold.node.tangent);
        self.radius = (arc.chord() / angle).min(self.runs.scale);
        let by_error = (0.4 * options.interpolation / error).powf(0.25);
        let by_angle = 0.7 * options.max_angle / angle;
        let by_effort = 4.0 / evaluations as f64;
        let most = if shortened { 1.0 } else { 2.0 };
        self.step = arc.chord() * by_error.min(by_angle).min(by_effort).clamp(0.3, most);

        if let Some(index) = self.passed_stop(&arc) {
            return self.finish(End::Known(index), None);
        }
        if self.taken > 0 && self.passes_origin(&arc) {
            return self.finish(End::Closed, Some(self.origin));
        }
        if let Some((special, before_last)) = special::touch(self, &foothold)? {
            if before_last {
                self.trail.pop_back();
                self.held = false;
            }
            return self.finish_at(special);
        }
        self.hand_out();
        self.taken += 1;
        if edge {
            let special = special::edge(self.runs, &foothold.node.point, &self.margin);
            return self.finish(End::Vertex(special), Some(foothold.node));
        }
        self.margin = self.runs.moved(&foothold.node.point, &self.margin)?;
        self.trail.push_back(foothold);
        self.held = true;
        if self.trail.len() > 2 {
            self.trail.pop_front();
        }
        Ok(())
    }

    fn hand_out(&mut self) {
        if self.held {
            self.ready.extend(self.trail.back().map(|foothold| foothold.node));
            self.held = false;
        }
    }

    /// The last footholds, at most two, oldest first.
    pub fn trail(&self) -> &VecDeque<FootholdOf<F>> {
        &self.trail
    }

    fn passed_stop(&self, arc: &Arc) -> Option<usize> {
        self.stops.iter().position(|stop| {
            let near = stop.uncertainty + 1e-9 * self.runs.scale;
            let [low, high] = arc.bounds();
            (0..2).all(|axis| {
                stop.point[axis] > low[axis] - near && stop.point[axis] < high[axis] + near
            }) && {
                let (theta, distance) = arc.closest(&stop.point);
                distance < near && (self.taken > 0 || theta > 0.0)
            }
        })
    }

    /// The known vertex ahead, within a step that failed, that the branch runs into without another special point before.
    fn aim(&self, from: &FootholdOf<F>, h: f64) -> Traced<Option<usize>, F> {
        let runs = self.runs;
        for (index, stop) in self.stops.iter().enumerate() {
            let chord = stop.point - from.node.point;
            let length = chord.norm();
            let angle = chord.angle(&from.node.tangent);
            if !(length <= 2.0 * h && length > SHORTEST * runs.scale)
                || !(angle <= 0.5 * runs.options.max_angle)
            {
                continue;
            }
            let end = Node { point: stop.point, tangent: mirrored(&from.node.tangent, &chord) };
            let arc = Arc::between(&from.node, &end);
            let mut runs_in = true;
            for theta in [0.3, 0.7] {
                let value = runs.margin(&arc.point(theta), &self.margin)?;
                runs_in &= value.is_some_and(|value| {
                    value.abs() <= runs.options.interpolation * from.gradient.norm()
                });
            }
            if !runs_in {
                continue;
            }
            // Halfway, and just before the vertex.
            for theta in [0.5, 0.97] {
                runs_in = runs_in && self.holds(from, &arc.point(theta), 0.1 * length)?;
            }
            if runs_in {
                return Ok(Some(index));
            }
        }
        Ok(None)
    }

    /// Whether the branch passes close to `guess` with its labels.
    pub fn holds(&self, from: &FootholdOf<F>, guess: &Point, reach: f64) -> Traced<bool, F> {
        let runs = self.runs;
        let reach = reach + 100.0 * runs.options.tolerance;
        let Some(found) = correct(runs, &self.margin, guess, &from.gradient, reach)? else {
            return Ok(false);
        };
        let tangent = &from.node.tangent;
        let gradient = runs.gradient(&found.point, &self.margin, tangent, self.radius)?;
        Ok(match gradient {
            Some(gradient) => self.foothold(&found.point, &gradient)?.is_ok(),
            None => false,
        })
    }

    fn passes_origin(&self, arc: &Arc) -> bool {
        let (theta, distance) = arc.closest(&self.origin.point);
        distance < 1e-8 * self.runs.scale && theta > 0.0 && {
            arc.tangent(theta).dot(&self.origin.tangent) > 0.5
        }
    }

    /// Ends at a special point, which becomes the last node.
    fn finish_at(&mut self, special: Special<F::Margin>) -> Traced<(), F> {
        let near = special.uncertainty + 1e-9 * self.runs.scale;
        let known = self
            .stops
            .iter()
            .position(|stop| (stop.point - special.point).norm() <= stop.uncertainty + near);
        let point = known.map_or(special.point, |index| self.stops[index].point);
        self.finish_with(known.map_or(End::Vertex(special), End::Known), point)
    }

    fn finish(&mut self, end: End<F::Margin>, last: Option<Node>) -> Traced<(), F> {
        if let End::Known(index) = end {
            let point = self.stops[index].point;
            return self.finish_with(end, point);
        }
        self.hand_out();
        self.ready.extend(last);
        self.end = Some(end);
        Ok(())
    }

    /// Hands out the node that was held back, then `point`.
    fn finish_with(&mut self, end: End<F::Margin>, point: Point) -> Traced<(), F> {
        self.hand_out();
        if let Some(last) = self.trail.back().map(|foothold| foothold.node) {
            // Nothing can be said of directions over distances comparable to the tolerance.
            let tangent = if (point - last.point).norm() < SHORTEST * self.runs.scale {
                last.tangent
            } else {
                self.end_tangent(&last, &point)?
            };
            self.ready.push_back(Node { point, tangent });
        }
        self.end = Some(end);
        Ok(())
    }

    /// The tangent at an end: across the gradient where there is one, else that of the circle through the last node.
    fn end_tangent(&self, last: &Node, point: &Point) -> Traced<Point, F> {
        let chord = point - last.point;
        let mirrored = mirrored(&last.tangent, &chord);
        if let Some(gradient) = self.runs.gradient(point, &self.margin, &mirrored, self.radius)? {
            let tangent = self.tangent(&gradient);
            let turn = tangent.angle(&mirrored);
            if turn < 0.1 * last.tangent.angle(&chord) + 1e-6 {
                return Ok(tangent);
            }
        }
        Ok(mirrored)
    }
}

/// The tangent at the other end of a circle's arc with this tangent at one end.
fn mirrored(tangent: &Point, chord: &Point) -> Point {
    let chord = chord.normalize();
    chord * (2.0 * chord.dot(tangent)) - tangent
}
