//! One boundary, followed step by step.
//!
//! In reading order: `track` (the state from which a step starts), `step` (one step), `ahead` (what
//! lies ahead of a branch), `special`, `cusp`, `touch` and `tangency` (the vertices at which it
//! ends).

mod ahead;
mod cusp;
pub(crate) mod special;
mod step;
pub(crate) mod tangency;
mod touch;
mod track;

use std::collections::VecDeque;

use crate::cubic::Cubic;
use crate::curve::{Node, VertexKind};
use crate::family::Family;
use crate::options::TraceError;
use crate::tracing::branch::step::Attempt;
use crate::tracing::branch::touch::touch;
use crate::tracing::branch::track::{FootholdOf, Track};
use crate::tracing::end::{End, Special, Stop};
use crate::tracing::fit::Target;
use crate::tracing::runs::{Runs, Traced};
use crate::tracing::seed::Seed;
use crate::window::Point;

/// A boundary that is followed in one direction. It is an iterator over the nodes after its start.
///
/// A step predicts along the last cubic and corrects along the normal. It is accepted if the
/// tangent turns little, if the cubic is as close to the boundary as the options ask, and if free
/// runs on both sides have the labels of the branch. The iterator returns each node one step late,
/// because a special point between the last two steps may replace the last node. A branch may run
/// past a place at which another boundary begins on it before runs show this; then the last nodes
/// lie behind the vertex of [`BoundaryWalk::end`].
///
/// ```
/// use stickslip_tracer::{Family, FreeRun, Point, TraceOptions, Window};
/// use stickslip_tracer::tracing::{BoundaryWalk, End, Runs, Seed};
///
/// /// A guard fires inside the unit circle.
/// struct Disc;
///
/// impl Family for Disc {
///     type Label = bool;
///     type Margin = ();
///     type Error = std::convert::Infallible;
///     fn label(&self, p: &Point) -> Result<bool, Self::Error> {
///         Ok(p.norm_squared() < 1.0)
///     }
///     fn margin(&self, p: &Point, (): &()) -> Result<Option<f64>, Self::Error> {
///         Ok(Some(p.norm_squared() - 1.0))
///     }
///     fn free_run(&self, p: &Point) -> Result<FreeRun<bool, ()>, Self::Error> {
///         Ok(FreeRun { label: self.label(p)?, margins: vec![((), p.norm_squared() - 1.0)] })
///     }
/// }
///
/// let window = Window { low: Point::new(-2.0, -2.0), high: Point::new(2.0, 2.0) };
/// let runs = Runs::new(&Disc, window, TraceOptions::default())?;
/// let seed = Seed::between(&runs, &[Point::zeros(), Point::new(1.5, 0.5)])?.expect("labels differ");
/// let mut branch = BoundaryWalk::new(&runs, &seed, true, &[])?.expect("on the boundary");
/// for node in &mut branch {
///     assert!((node?.point.norm() - 1.0).abs() < 1e-12);
/// }
/// assert!(matches!(branch.end(), Some(End::Closed)));
/// # Ok::<(), stickslip_tracer::TraceError<std::convert::Infallible>>(())
/// ```
pub struct BoundaryWalk<'a, 'f, F: Family> {
    track: Track<'a, 'f, F>,
    /// The nodes up to the last foothold that have not been returned yet.
    held: Vec<Node>,
    /// The nodes that the iterator returns next.
    ready: VecDeque<Node>,
    end: Option<End<F::Margin>>,
    rejected: usize,
    /// The shortest step within which a search for touches found nothing.
    untouched: f64,
    /// Whether the branch has gone past the vertex at which it ends.
    past: bool,
}

impl<'a, 'f, F: Family> BoundaryWalk<'a, 'f, F> {
    /// The branch from `seed`; `None` if the seed is not on a boundary between its labels.
    ///
    /// If `forward`, the margin is positive on the left of the branch, else on its right. The
    /// branch ends at each of the `stops` that it comes to.
    ///
    /// # Errors
    /// A run fails, or a margin is not a number.
    pub fn new(
        runs: &'a Runs<'f, F>,
        seed: &Seed<F::Label, F::Margin>,
        forward: bool,
        stops: &'a [Stop],
    ) -> Traced<Option<Self>, F> {
        let [positive, negative] = seed.labels.clone();
        let (orientation, sides) =
            if forward { (1.0, [positive, negative]) } else { (-1.0, [negative, positive]) };
        let step = runs.lengths.around;
        let mut track = Track {
            runs,
            margin: seed.margin.clone(),
            sides,
            orientation,
            stops,
            origin: Node { point: seed.point, tangent: Point::zeros() },
            footholds: VecDeque::new(),
            step,
            radius: 0.1 * runs.lengths.scale,
            taken: 0,
        };
        let Some(gradient) =
            runs.gradient(&seed.point, &seed.margin, &seed.tangent, track.radius)?
        else {
            return Ok(None);
        };
        let Some(foothold) = track.foothold(&seed.point, &gradient)?.ok() else { return Ok(None) };
        track.origin = foothold.node;
        track.footholds.push_back(foothold);
        Ok(Some(Self {
            track,
            held: Vec::new(),
            ready: VecDeque::new(),
            end: None,
            rejected: 0,
            untouched: f64::INFINITY,
            past: false,
        }))
    }

    /// The start of the branch.
    pub fn origin(&self) -> Node {
        self.track.origin
    }

    /// Why the branch ended; `None` as long as it goes on.
    pub fn end(&self) -> Option<&End<F::Margin>> {
        self.end.as_ref()
    }

    /// The number of steps that were rejected so far.
    pub fn rejected(&self) -> usize {
        self.rejected
    }

    /// The nodes after the start up to the end, or `None` if the end lies before the start. A
    /// branch can go past a vertex before runs show it; the nodes behind the vertex belong to
    /// another boundary. Each node is told to `reached`.
    pub(crate) fn rest(&mut self, reached: impl Fn()) -> Traced<Option<Vec<Node>>, F> {
        let mut nodes = Vec::new();
        while let Some(node) = self.advance()? {
            reached();
            nodes.push(node);
        }
        let Some(End::Vertex(special)) = self.end.as_ref().filter(|_| self.past) else {
            return Ok(Some(nodes));
        };
        let (runs, point) = (self.track.runs, special.point);
        let lies_before = |node: &Node| (point - node.point).dot(&node.tangent) > runs.lengths.same;
        while nodes.pop_if(|node| !lies_before(node)).is_some() {}
        let last = nodes.last().copied().unwrap_or(self.track.origin);
        if !lies_before(&last) {
            return Ok(None);
        }
        let Track { margin, radius, .. } = &self.track;
        let Some(gradient) = runs.gradient(&last.point, margin, &last.tangent, *radius)? else {
            return Ok(None);
        };
        nodes.extend(self.track.fit().nodes(&last, &gradient, Target::Vertex(point))?);
        Ok(Some(nodes))
    }

    /// The next node, or `None` at the end.
    fn advance(&mut self) -> Traced<Option<Node>, F> {
        while self.ready.is_empty() && self.end.is_none() {
            self.take_step()?;
        }
        Ok(self.ready.pop_front())
    }

    /// Shortens the step until it is accepted, or until a vertex ends the branch.
    fn take_step(&mut self) -> Traced<(), F> {
        /// Touches are searched for again once the step is at most this part of the last step that
        /// was searched.
        const SHRUNK: f64 = 0.3;
        let Some(from) = self.track.footholds.back().cloned() else { return Ok(()) };
        let runs = self.track.runs;
        if self.track.taken >= runs.options.max_nodes {
            return self.finish(End::Limit, Vec::new());
        }
        let mut h = self.track.limited_step(&from.node);
        let first_step = h;
        let mut failures = 0_u32;
        loop {
            let attempt = self.track.attempt(&from, h)?;
            let turned = matches!(attempt, Attempt::Turn(angle) if angle >= 1.0);
            let (factor, beyond) = match attempt {
                Attempt::Accepted { foothold, error, evaluations, edge } => {
                    return self.accept(&from, foothold, error, evaluations, edge, failures > 0);
                }
                Attempt::Turn(angle) if angle < 1.0 => {
                    ((0.8 * runs.options.max_angle / angle).clamp(0.1, 0.8), None)
                }
                Attempt::Rough(error) => {
                    ((0.5 * runs.options.interpolation / error).powf(0.25).clamp(0.1, 0.8), None)
                }
                Attempt::Lost | Attempt::Turn(_) => (0.5, None),
                Attempt::Labels(beyond) => (0.5, Some(beyond)),
            };
            self.rejected += 1;
            failures += 1;
            if let Some(index) = self.track.aim(&from, h)? {
                return self.finish(End::Known(index), Vec::new());
            }
            let cusps = cusp::ahead(&self.track, &from, 2.0 * h)?;
            for &place in &cusps {
                if let Some(special) = cusp::reached(&self.track, &from, place)? {
                    return self.finish_at(special);
                }
            }
            let stuck = h < 1e-2 * first_step || beyond.is_some() || turned;
            if stuck && matches!(failures, 1 | 4 | 8 | 16 | 24 | 32) {
                let touches = h <= SHRUNK * self.untouched;
                if touches {
                    self.untouched = h;
                }
                let search = special::Search { alone: cusps.is_empty(), touches };
                let found = special::locate(&self.track, &from, beyond.as_ref(), h, search)?;
                if let Some(special) = found {
                    return self.finish_at(special);
                }
            }
            if h < runs.lengths.least {
                return self.stall(&from, beyond.as_ref(), h);
            }
            h *= factor;
        }
    }

    /// Ends the branch where even the shortest step `h` fails.
    fn stall(
        &mut self,
        from: &FootholdOf<F>,
        beyond: Option<&FootholdOf<F>>,
        h: f64,
    ) -> Traced<(), F> {
        if let Some(special) = cusp::beyond(&self.track, from)? {
            return self.finish_at(special);
        }
        let mut found = tangency::begins_on_branch(&self.track, from, beyond)?;
        if found.is_none() {
            let other = special::give_up(&self.track, from, beyond, h)?;
            // The end is found without a tangency only where the margin ceases to exist.
            let ceases = other.solved && other.kind == VertexKind::Degenerate;
            // A tangency close to it is the same place, and more accurate.
            let near = self.track.runs.lengths.beyond;
            found = tangency::branch_begins(&self.track, from)?
                .filter(|(place, _)| !ceases || (place.point - other.point).norm() <= near);
            if found.is_none() && !other.solved {
                if let Some(index) = self.track.touched(from)? {
                    return self.finish(End::Known(index), Vec::new());
                }
                let ahead = from.node.point + from.node.tangent * self.track.runs.lengths.half;
                if let Some(exit) = self.track.exit_before(&ahead)? {
                    let exit = special::edge(self.track.runs, &exit, &self.track.margin);
                    return self.finish_at(exit);
                }
            }
            found = found.or(Some((other, true)));
        }
        match found {
            Some((special, false)) if self.track.runs.window.contains(&special.point) => {
                self.past = true;
                self.finish(End::Vertex(special), Vec::new())
            }
            Some((special, _)) => self.finish_at(special),
            None => Ok(()),
        }
    }

    /// Goes on to a foothold, chooses the length of the next step, and looks for an end in between.
    fn accept(
        &mut self,
        from: &FootholdOf<F>,
        foothold: FootholdOf<F>,
        error: f64,
        evaluations: usize,
        edge: bool,
        shortened: bool,
    ) -> Traced<(), F> {
        let runs = self.track.runs;
        let options = &runs.options;
        let arc = Cubic::between(&from.node, &foothold.node);
        let angle = from.node.tangent.angle(&foothold.node.tangent);
        self.track.radius = (arc.chord() / angle).min(runs.lengths.scale);
        let by_error = (0.4 * options.interpolation / error).powf(0.25);
        let by_angle = 0.7 * options.max_angle / angle;
        let by_effort = 4.0 / evaluations as f64;
        let most = if shortened { 1.0 } else { 2.0 };
        self.track.step = arc.chord() * by_error.min(by_angle).min(by_effort).clamp(0.3, most);

        if let Some((special, before_last)) = touch(&self.track, &foothold)? {
            if before_last {
                self.track.footholds.pop_back();
                self.held.clear();
            }
            return self.finish_at(special);
        }
        if let Some(index) = self.track.passed_stop(&arc) {
            return self.finish(End::Known(index), Vec::new());
        }
        let fit = self.track.fit();
        if self.track.taken > 0 && self.track.passes_origin(&arc) {
            let nodes = fit.nodes(&from.node, &from.gradient, Target::Node(self.track.origin))?;
            return self.finish(End::Closed, nodes);
        }
        let nodes = if self.track.is_close(from, &arc)? {
            vec![foothold.node]
        } else {
            fit.nodes(&from.node, &from.gradient, Target::Node(foothold.node))?
        };
        self.hand_out();
        self.track.taken += 1;
        if edge {
            let special = special::edge(runs, &foothold.node.point, &self.track.margin);
            return self.finish(End::Vertex(special), nodes);
        }
        self.track.margin = runs.moved(&foothold.node.point, &self.track.margin)?;
        self.track.footholds.push_back(foothold);
        self.held = nodes;
        if self.track.footholds.len() > 2 {
            self.track.footholds.pop_front();
        }
        Ok(())
    }

    /// Returns the nodes that were held back.
    fn hand_out(&mut self) {
        self.ready.extend(self.held.drain(..));
    }

    /// Ends the branch at a special point, or at the known vertex that is the same place. If the
    /// special point lies beyond the window's edge, the branch ends at the edge.
    fn finish_at(&mut self, special: Special<F::Margin>) -> Traced<(), F> {
        let special = match self.track.exit_before(&special.point)? {
            Some(exit) => special::edge(self.track.runs, &exit, &self.track.margin),
            None => special,
        };
        let near = special.uncertainty + self.track.runs.lengths.same;
        let known = self
            .track
            .stops
            .iter()
            .position(|stop| (stop.point - special.point).norm() <= stop.uncertainty + near)
            .filter(|&index| !special.improves(&self.track.stops[index]));
        let point = known.map_or(special.point, |index| self.track.stops[index].point);
        self.finish_with(known.map_or(End::Vertex(special), End::Known), point)
    }

    /// Ends the branch after the nodes `last`, or at the known vertex that `end` names.
    fn finish(&mut self, end: End<F::Margin>, last: Vec<Node>) -> Traced<(), F> {
        if let End::Known(index) = end {
            let point = self.track.stops[index].point;
            return self.finish_with(end, point);
        }
        self.hand_out();
        self.ready.extend(last);
        self.end = Some(end);
        Ok(())
    }

    /// Ends the branch at `point`, or at a known vertex before it.
    fn finish_with(&mut self, end: End<F::Margin>, mut point: Point) -> Traced<(), F> {
        self.hand_out();
        let Some(last) = self.track.footholds.back().cloned() else { return Ok(()) };
        let node = self.track.end_node(&last.node, &point)?;
        self.end = Some(end);
        let reaches = |stop: &Stop| (stop.point - point).norm() <= stop.uncertainty;
        if let Some(index) = self.track.passed_stop(&Cubic::between(&last.node, &node))
            && !reaches(&self.track.stops[index])
        {
            point = self.track.stops[index].point;
            self.end = Some(End::Known(index));
        }
        let fit = self.track.fit();
        self.ready.extend(fit.nodes(&last.node, &last.gradient, Target::Vertex(point))?);
        Ok(())
    }
}

impl<F: Family> Iterator for BoundaryWalk<'_, '_, F> {
    type Item = Result<Node, TraceError<F::Error>>;

    fn next(&mut self) -> Option<Self::Item> {
        self.advance().transpose()
    }
}
