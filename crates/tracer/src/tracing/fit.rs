//! Curves as close to their boundary as the options ask.
//!
//! The steps along a curve do not end at its vertices. At a vertex a margin may be singular, or
//! exist up to it only; its gradient then does not give the direction of the curve. So an accepted
//! cubic is compared with the boundary at a second place, and divided if it is too far from it
//! there. Refusing the step instead would not help: next to a singular vertex, a branch would end
//! beside it in ever shorter steps, which locate the vertex worse than a long step does.

use crate::cubic::Cubic;
use crate::curve::Node;
use crate::family::Family;
use crate::lengths::angle;
use crate::tracing::corrector::correct;
use crate::tracing::runs::{Runs, Traced};
use crate::window::Point;

/// Where cubics are compared with the boundary. The errors of fourth and of fifth order together
/// vanish at one of these places at most.
pub(crate) const SHOWING: [f64; 2] = [0.3, 0.7];
/// The part of its maximum that the error of fourth order has there.
pub(crate) const SHOWN: f64 = 0.7;

/// The boundary of a margin, to which curves are fitted.
pub(crate) struct Fit<'r, 'f, F: Family> {
    pub runs: &'r Runs<'f, F>,
    pub margin: &'r F::Margin,
    /// The radius of curvature of the boundary.
    pub radius: f64,
}

/// Where a piece of a curve ends.
#[derive(Clone, Copy)]
pub(crate) enum Target {
    /// At a node of the boundary.
    Node(Node),
    /// At a vertex, with a tangent that is still open.
    Vertex(Point),
}

impl<F: Family> Fit<'_, '_, F> {
    /// The nodes behind `last` up to `target`. Cubics between them are as close to the boundary as
    /// the options ask, or as shorter ones can be. `gradient` is the gradient of the margin at
    /// `last`.
    pub fn nodes(&self, last: &Node, gradient: &Point, target: Target) -> Traced<Vec<Node>, F> {
        let (mut last, mut gradient) = (*last, *gradient);
        let mut nodes = Vec::new();
        // The ends of pieces that were divided, nearest last, with the gradients there.
        let mut ahead: Vec<(Node, Point)> = Vec::new();
        loop {
            let next = ahead.last().map_or(target, |(node, _)| Target::Node(*node));
            let (node, error) = self.best(&last, &gradient, next)?;
            if let Some(middle) = self.middle(&last, &gradient, (next, node), error)? {
                ahead.push(middle);
                continue;
            }
            nodes.push(node);
            match ahead.pop() {
                Some((_, slope)) => (last, gradient) = (node, slope),
                None => return Ok(nodes),
            }
        }
    }

    /// The distance of a cubic from the boundary, where the margin exists.
    pub fn error(&self, arc: &Cubic, gradient: &Point) -> Traced<f64, F> {
        let mut error: f64 = 0.0;
        for theta in SHOWING {
            let guess = arc.at(theta);
            let found = correct(self.runs, self.margin, &guess, gradient, 0.3 * arc.chord())?;
            error = error.max(found.map_or(0.0, |found| (found.point - guess).norm()));
        }
        Ok(error / SHOWN)
    }

    /// The node at a vertex behind `last`. Its tangent is normal to the gradient if there is one,
    /// else tangent to the circle through `last`.
    pub fn end(&self, last: &Node, vertex: &Point) -> Traced<Node, F> {
        Ok(self.ends(last, vertex)?[0])
    }

    /// The node at a vertex behind `last`, and the same with the tangent of the circle through
    /// `last` if the first one is normal to the gradient.
    fn ends(&self, last: &Node, vertex: &Point) -> Traced<Vec<Node>, F> {
        let chord = vertex - last.point;
        let end = |tangent| Node { point: *vertex, tangent };
        // A chord as short as the tolerance has no meaningful direction.
        if chord.norm() < self.runs.lengths.same {
            return Ok(vec![end(last.tangent)]);
        }
        let circular = mirrored(&last.tangent, &chord);
        let mut ends = vec![end(circular)];
        let gradient = self.runs.gradient(vertex, self.margin, &circular, self.radius)?;
        if let Some(tangent) = gradient.map(|gradient| normal(&gradient, &circular)) {
            let turn = tangent.angle(&circular);
            if turn < 0.1 * last.tangent.angle(&chord) + angle::STRAIGHT {
                ends.insert(0, end(tangent));
            }
        }
        Ok(ends)
    }

    /// The end of the piece from `last` to `target` with which its cubic is as close to the
    /// boundary as the options ask, or closest, and the distance of this cubic.
    fn best(&self, last: &Node, gradient: &Point, target: Target) -> Traced<(Node, f64), F> {
        let ends = match target {
            Target::Node(node) => vec![node],
            Target::Vertex(vertex) => self.ends(last, &vertex)?,
        };
        let mut best = (ends[0], f64::INFINITY);
        for node in ends {
            let error = self.error(&Cubic::between(last, &node), gradient)?;
            if error < best.1 {
                best = (node, error);
            }
            if error <= self.runs.options.interpolation {
                break;
            }
        }
        Ok(best)
    }

    /// A node in the middle of a piece, with its gradient, if it makes a cubic with this error
    /// better.
    fn middle(
        &self,
        last: &Node,
        gradient: &Point,
        (target, end): (Target, Node),
        error: f64,
    ) -> Traced<Option<(Node, Point)>, F> {
        let arc = Cubic::between(last, &end);
        if error <= self.runs.options.interpolation || arc.chord() <= self.runs.lengths.piece {
            return Ok(None);
        }
        let (guess, tangent) = (arc.at(0.5), arc.tangent(0.5));
        let reach = 0.3 * arc.chord();
        let Some(found) = correct(self.runs, self.margin, &guess, gradient, reach)? else {
            return Ok(None);
        };
        let slope = self.runs.gradient(&found.point, self.margin, &tangent, self.radius)?;
        let Some(slope) = slope else { return Ok(None) };
        let node = Node { point: found.point, tangent: normal(&slope, &tangent) };
        // If the vertex lies beside the boundary, or the boundary turns just before it, every cubic
        // up to it has the same error.
        let better = self.error(&Cubic::between(last, &node), gradient)? <= 0.5 * error
            && self.best(&node, &slope, target)?.1 <= 0.5 * error;
        Ok(better.then_some((node, slope)))
    }
}

/// The unit vector normal to a gradient that is closer to `direction`.
fn normal(gradient: &Point, direction: &Point) -> Point {
    let tangent = Point::new(gradient.y, -gradient.x).normalize();
    if tangent.dot(direction) < 0.0 { -tangent } else { tangent }
}

/// The tangent at the end of a circular arc that starts with `tangent`.
pub(crate) fn mirrored(tangent: &Point, chord: &Point) -> Point {
    let chord = chord.normalize();
    chord * (2.0 * chord.dot(tangent)) - tangent
}
