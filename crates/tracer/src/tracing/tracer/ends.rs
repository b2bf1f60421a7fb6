//! The ends of curves, when all curves are known.
//!
//! The last part of a curve that begins on another one with its tangent is closer to the other
//! boundary than runs can resolve, so that the branch ends beside the true vertex.

use crate::cubic::Cubic;
use crate::curve::{Node, VertexKind};
use crate::family::Family;
use crate::tracing::branch::tangency::Root;
use crate::tracing::end::Special;
use crate::tracing::fit::{Fit, Target};
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
        if kind != VertexKind::Degenerate || stop.uncertainty <= self.runs.lengths.same {
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
        let Some(gradient) = self.runs.gradient(&foot, other, &along, self.runs.lengths.scale)?
        else {
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

    /// Leads curves to their vertices again where these have moved since they were traced.
    pub(super) fn fit_ends(&mut self) -> Traced<(), F> {
        for index in 0..self.builder.network.curves.len() {
            for start in [true, false] {
                let curve = &self.builder.network.curves[index];
                if curve.ends.is_none() {
                    break;
                }
                let mut nodes = curve.nodes.clone();
                if start {
                    turn(&mut nodes);
                }
                let [.., last, end] = nodes[..] else { break };
                let margin = self.runs.moved(&last.point, &curve.margin)?;
                let arc = Cubic::between(&last, &end);
                let radius =
                    (arc.chord() / last.tangent.angle(&end.tangent)).min(self.runs.lengths.scale);
                let fit = Fit { runs: &self.runs, margin: &margin, radius };
                let gradient = self.runs.gradient(&last.point, &margin, &last.tangent, radius)?;
                let Some(gradient) = gradient else { continue };
                if fit.error(&arc, &gradient)? <= self.runs.options.interpolation {
                    continue;
                }
                nodes.pop();
                nodes.extend(fit.nodes(&last, &gradient, Target::Vertex(end.point))?);
                if start {
                    turn(&mut nodes);
                }
                self.builder.replace_nodes(index, nodes);
            }
        }
        Ok(())
    }
}

/// Turns the direction of a curve.
fn turn(nodes: &mut [Node]) {
    nodes.reverse();
    for node in nodes {
        node.tangent = -node.tangent;
    }
}
