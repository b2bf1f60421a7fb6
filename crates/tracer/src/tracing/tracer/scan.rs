//! The curves that change the label along a segment.

use crate::cubic::Cubic;
use crate::curve::{Curve, Node, VertexKind};
use crate::family::Family;
use crate::lengths::Lengths;
use crate::tracing::branch::BoundaryWalk;
use crate::tracing::corrector::correct;
use crate::tracing::end::{End, Special};
use crate::tracing::network::Unresolved;
use crate::tracing::runs::Traced;
use crate::tracing::seed::{Change, Seed, SeedOf, bisect, holds_closely, identify};
use crate::tracing::tracer::Tracer;
use crate::window::{Point, Window};

impl<F: Family> Tracer<'_, F> {
    /// Traces every curve that changes the label along a segment, unless it is known.
    ///
    /// The known curves that cross the segment explain how the label changes along it. A boundary
    /// is searched for by bisection only where their sides do not fit together, or do not fit the
    /// labels at the ends.
    pub(crate) fn scan(&mut self, segment: [Point; 2], labels: [F::Label; 2]) -> Traced<(), F> {
        /// The number of changes that are followed on one segment. Other edges of the grid find the
        /// curves of further changes.
        const CHANGES: usize = 64;
        let [a, b] = segment;
        let length = (b - a).norm();
        // In a gap behind a curve runs may not resolve the curve. On a short segment the gap is a
        // small part of it, but at least twice the error of the curve.
        let short =
            (2.0 * Lengths::PARTS.around * length).max(2.0 * self.runs.options.interpolation);
        let gap = (2.0 * self.runs.lengths.same).min(short) / length;
        let [mut label, last] = labels;
        let mut place = 0.0;
        for _ in 0..CHANGES {
            let mut unexplained = None;
            for passage in self.builder.passages(&a, &b) {
                if passage.place <= place {
                    continue;
                }
                if passage.labels[0] != label {
                    unexplained = Some(passage);
                    break;
                }
                place = passage.place + gap;
                label = passage.labels[1].clone();
            }
            let end = unexplained.as_ref().map_or(1.0, |passage| passage.place - gap);
            if place >= 1.0 || (unexplained.is_none() && last == label) {
                return Ok(());
            }
            // The labels so far came from curves. Here they come from runs.
            let first = if place > 0.0 { self.runs.label(&a.lerp(&b, place))? } else { label };
            let second = match &unexplained {
                Some(_) if end > place => self.runs.label(&a.lerp(&b, end))?,
                Some(_) => first.clone(),
                None => last.clone(),
            };
            let doubtful = first == second;
            let change = if !doubtful {
                bisect(&self.runs, &segment, [place, end], [first, second])?
            } else if let Some(passage) = &unexplained {
                // The labels on the sides of the curve are not the labels here: a vertex on it was
                // missed.
                let after = (end + 2.0 * gap).min(1.0);
                let labels = [second, self.runs.label(&a.lerp(&b, after))?];
                if labels[0] == labels[1] || labels == passage.labels {
                    place = after;
                    [_, label] = labels;
                    continue;
                }
                Change { places: [end, after], labels }
            } else {
                return Ok(());
            };
            let places = change.places.map(|place| a.lerp(&b, place));
            match identify(&self.runs, &places, &change.labels)? {
                Some(seed) => self.seed(&seed)?,
                // The labels beside a curve are not its own if another curve is closer than runs
                // can resolve.
                None if doubtful => {}
                None => {
                    let labels = change.labels.clone();
                    let unresolved = Unresolved::Change { between: places, labels };
                    self.builder.network.unresolved.push(unresolved);
                }
            }
            place = change.places[1];
            label = change.labels[1].clone();
        }
        Ok(())
    }

    /// Traces the curve through a seed in both directions, unless it is known. A curve along an
    /// edge of the window, no farther inside than the distance at which places are distinguished,
    /// is not in the window.
    fn seed(&mut self, seed: &SeedOf<F>) -> Traced<(), F> {
        if self.builder.covers(&seed.point, &seed.labels) || !self.runs.window.contains(&seed.point)
        {
            return Ok(());
        }
        let network = &mut self.builder.network;
        if network.curves.len() >= self.runs.options.max_curves.saturating_mul(2) {
            network.unresolved.push(Unresolved::TooManyCurves { point: seed.point });
            return Ok(());
        }
        network.statistics.seeds += 1;
        let known = self.builder.stops.len();
        let Some((origin, forward, end)) = self.follow(seed, true)? else {
            return Ok(());
        };
        let (nodes, ends) = match end {
            None => (std::iter::once(origin).chain(forward).collect(), None),
            Some(end) => {
                let Some((_, backward, start)) = self.follow(seed, false)? else { return Ok(()) };
                let turned = |node: &Node| Node { tangent: -node.tangent, ..*node };
                let mut nodes: Vec<Node> = backward.iter().rev().map(turned).collect();
                nodes.push(origin);
                nodes.extend(forward);
                // If a branch closes in one direction and ends in the other, the vertex lies at its
                // origin.
                (nodes, Some([start.unwrap_or(end), end]))
            }
        };
        if self.is_along_edge(&nodes) {
            self.builder.drop_unused(known);
            return Ok(());
        }
        let sides = seed.labels.clone();
        let curve = Curve { margin: seed.margin.clone(), sides, nodes, ends };
        self.runs.watch.show(|| curve.polyline(&self.window.extent()));
        self.builder.add_curve(curve);
        Ok(())
    }

    /// Whether all these nodes lie on one edge of the window, up to the distance at which places
    /// are distinguished.
    fn is_along_edge(&self, nodes: &[Node]) -> bool {
        let Window { low, high } = self.runs.window;
        let near = self.runs.lengths.same;
        (0..2).any(|axis| {
            [low[axis], high[axis]]
                .iter()
                .any(|edge| nodes.iter().all(|node| (node.point[axis] - edge).abs() <= near))
        })
    }

    /// Removes the suspects whose labels are wrong. Two vertices lay between two nodes of such a
    /// suspect, and only one of the two was found later. The circles around this vertex find the
    /// right curves.
    fn check_suspects(&mut self) -> Traced<(), F> {
        let mut wrong = Vec::new();
        for index in std::mem::take(&mut self.builder.suspects) {
            let curve = &self.builder.network.curves[index];
            let piece = (curve.nodes.len() - 1) / 2;
            let guess = Cubic::between(&curve.nodes[piece], &curve.nodes[piece + 1]);
            let (guess, tangent, reach) = (guess.at(0.5), guess.tangent(0.5), guess.chord());
            let margin = self.runs.moved(&guess, &curve.margin)?;
            let found =
                match self.runs.gradient(&guess, &margin, &tangent, self.runs.lengths.scale)? {
                    Some(gradient) => correct(&self.runs, &margin, &guess, &gradient, reach)?
                        .map(|found| (found.point, gradient)),
                    None => None,
                };
            let holds = match found {
                Some((point, gradient)) => {
                    let [left, right] = curve.sides.clone();
                    let on_left = gradient.dot(&Point::new(-tangent.y, tangent.x)) > 0.0;
                    let labels = if on_left { [left, right] } else { [right, left] };
                    let seed = Seed { point, tangent, margin, labels };
                    // Another boundary beside the curve has its labels farther away.
                    holds_closely(&self.runs, &seed, &gradient)?
                }
                None => false,
            };
            if !holds {
                wrong.push(index);
            }
        }
        if !wrong.is_empty() {
            self.builder.remove_curves(&wrong);
        }
        Ok(())
    }

    /// Follows a branch from a seed: its origin, its nodes, and the vertex at its end, `None` if it
    /// closes. The whole is `None` if no branch starts at the seed.
    #[expect(clippy::type_complexity)]
    fn follow(
        &mut self,
        seed: &SeedOf<F>,
        forward: bool,
    ) -> Traced<Option<(Node, Vec<Node>, Option<usize>)>, F> {
        let stops = self.builder.stops.clone();
        let Some(mut branch) = BoundaryWalk::new(&self.runs, seed, forward, &stops)? else {
            let between = [seed.point; 2];
            let labels = seed.labels.clone();
            self.builder.network.unresolved.push(Unresolved::Change { between, labels });
            return Ok(None);
        };
        let rest = branch.rest(|| ())?;
        let is_past = rest.is_none();
        let nodes = rest.unwrap_or_default();
        let last = nodes.last().map_or(seed.point, |node| node.point);
        let (origin, rejected) = (branch.origin(), branch.rejected());
        let end = match branch.end().cloned() {
            Some(End::Closed) => None,
            Some(End::Known(index)) => Some(index),
            Some(End::Vertex(special)) => {
                let index = self.builder.add_vertex(&special);
                self.check_suspects()?;
                Some(index)
            }
            Some(End::Limit) | None => {
                self.builder.network.unresolved.push(Unresolved::TooManyNodes { point: last });
                let special = Special {
                    point: last,
                    kind: VertexKind::Degenerate,
                    margins: vec![seed.margin.clone()],
                    uncertainty: 0.0,
                    solved: true,
                };
                Some(self.builder.add_vertex(&special))
            }
        };
        let statistics = &mut self.builder.network.statistics;
        statistics.nodes += nodes.len();
        statistics.rejected += rejected;
        if is_past {
            // The boundaries behind the vertex are found from elsewhere, or are in doubt.
            let (between, labels) = ([seed.point; 2], seed.labels.clone());
            self.builder.network.unresolved.push(Unresolved::Change { between, labels });
            return Ok(None);
        }
        Ok(Some((origin, nodes, end)))
    }
}
