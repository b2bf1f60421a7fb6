//! Ends of curves that touch another one with a square root.
//!
//! Behind the graze of a guard, everything that depends on when it fires has a square root in the
//! distance from the boundary of the graze. A margin of it is m₀ + α √d + β d + …, and its boundary
//! touches that of the graze where m₀ = 0, as a parabola. The last part of the parabola is closer
//! to the other boundary than runs can tell apart, so that the branch ends beside the true vertex.

use crate::curve::VertexKind;
use crate::family::Family;
use crate::tracing::branch::end::{SHORTEST, Special};
use crate::tracing::corrector::correct;
use crate::tracing::runs::{Runs, Traced};
use crate::tracing::tracer::Tracer;
use crate::window::Point;

/// The farthest along the curve that the true vertex is looked for, as a part of the window's
/// shorter extent.
const REACH: f64 = 1e-3;
/// The least distance from the curve at which the margin is taken, as a part of the same.
const NEAR: f64 = 1e-6;

impl<F: Family> Tracer<'_, F> {
    /// Moves the ends of curves that touch another curve to the places where they do.
    pub(super) fn move_to_tangencies(&mut self) -> Traced<(), F> {
        for index in (0..self.builder.stops.len()).rev() {
            let Some(point) = self.tangency(index)? else { continue };
            let margins = self.builder.network.vertices[index].margins.clone();
            let uncertainty = SHORTEST * self.runs.scale;
            let kind = VertexKind::Crossing;
            self.builder
                .lead_to(index, &Special { point, kind, margins, uncertainty, solved: true });
        }
        Ok(())
    }

    /// The place where a curve that ends at a vertex touches the one on which it ends there.
    fn tangency(&self, vertex: usize) -> Traced<Option<Point>, F> {
        let stop = self.builder.stops[vertex];
        let kind = self.builder.network.vertices[vertex].kind;
        if kind != VertexKind::Degenerate || stop.uncertainty <= SHORTEST * self.runs.scale {
            return Ok(None);
        }
        let arrivals = self.builder.arrivals(vertex);
        let [(one, first), (two, second), (three, third)] = &arrivals[..] else { return Ok(None) };
        // The vertex divides the other curve into two.
        let (own, other, node) = match () {
            () if first == second => (third, first, one),
            () if second == third => (first, second, two),
            () if third == first => (second, third, three),
            () => return Ok(None),
        };
        let foot = stop.point;
        let along = (node.point - foot).normalize();
        let Some(gradient) = self.runs.gradient(&foot, other, &along, self.runs.scale)? else {
            return Ok(None);
        };
        let along = Point::new(-gradient.y, gradient.x).normalize();
        for side in [1.0, -1.0] {
            let touch = Touch { runs: &self.runs, own, other, foot, along, gradient, side };
            if let Some(place) = touch.place()? {
                return touch.point(place);
            }
        }
        Ok(None)
    }
}

/// A margin beside the boundary of another one.
struct Touch<'r, F: Family> {
    runs: &'r Runs<'r, F>,
    own: &'r F::Margin,
    other: &'r F::Margin,
    /// A place on the other boundary, with a unit vector along it and the gradient there.
    foot: Point,
    along: Point,
    gradient: Point,
    /// 1 or −1: the side on which the margin exists, as the sign of the other one.
    side: f64,
}

impl<F: Family> Touch<'_, F> {
    /// The place along the boundary where m₀ vanishes, by the secant method.
    fn place(&self) -> Traced<Option<f64>, F> {
        let (reach, close) = (REACH * self.runs.scale, 0.01 * SHORTEST * self.runs.scale);
        let (mut last, mut here) = (0.0, 1e-3 * reach);
        let Some(mut before) = self.limit(last)? else { return Ok(None) };
        for _ in 0..20 {
            let Some(value) = self.limit(here)? else { return Ok(None) };
            let next = here - value * (here - last) / (value - before);
            let within = next.abs() <= reach;
            if !within {
                return Ok(None);
            }
            if (next - here).abs() <= close {
                return Ok(Some(next));
            }
            (last, before, here) = (here, value, next);
        }
        Ok(None)
    }

    /// The point of the other boundary at a place along it.
    fn point(&self, place: f64) -> Traced<Option<Point>, F> {
        let guess = self.foot + self.along * place;
        let found =
            correct(self.runs, self.other, &guess, &self.gradient, REACH * self.runs.scale)?;
        Ok(found.map(|found| found.point))
    }

    /// m₀ at a place along the boundary, from the margin at three distances: the polynomial in √d
    /// through its values.
    fn limit(&self, place: f64) -> Traced<Option<f64>, F> {
        let Some(point) = self.point(place)? else { return Ok(None) };
        let inwards = self.gradient.normalize() * self.side;
        let mut limit = 0.0;
        for (times, weight) in [(1.0, 8.0 / 3.0), (4.0, -2.0), (16.0, 1.0 / 3.0)] {
            let beside = point + inwards * (times * NEAR * self.runs.scale);
            let Some(value) = self.runs.margin(&beside, self.own)? else { return Ok(None) };
            limit += weight * value;
        }
        Ok(Some(limit))
    }
}
