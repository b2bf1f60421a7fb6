//! Ends of curves that begin on another one with its tangent.
//!
//! The last part of such a curve is closer to the other boundary than runs can resolve, so that the
//! branch ends beside the true vertex.

use crate::curve::VertexKind;
use crate::family::Family;
use crate::tracing::branch::tangency::Root;
use crate::tracing::end::{SHORTEST, Special};
use crate::tracing::runs::Traced;
use crate::tracing::tracer::Tracer;
use crate::window::Point;

impl<F: Family> Tracer<'_, F> {
    /// Moves the ends of curves that touch another curve to the places where they do.
    pub(super) fn move_to_tangencies(&mut self) -> Traced<(), F> {
        for index in (0..self.builder.stops.len()).rev() {
            let Some((point, uncertainty)) = self.tangency(index)? else { continue };
            let margins = self.builder.network.vertices[index].margins.clone();
            let kind = VertexKind::Crossing;
            self.builder
                .lead_to(index, &Special { point, kind, margins, uncertainty, solved: true });
        }
        Ok(())
    }

    /// The place where a curve that ends at a vertex touches the one on which it ends there, and
    /// the largest error of this place.
    fn tangency(&self, vertex: usize) -> Traced<Option<(Point, f64)>, F> {
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
            let root = Root { runs: &self.runs, own, graze: other, foot, along, gradient, side };
            if let Some((place, uncertainty)) = root.place()? {
                return Ok(root.point(place)?.map(|point| (point, uncertainty)));
            }
        }
        Ok(None)
    }
}
