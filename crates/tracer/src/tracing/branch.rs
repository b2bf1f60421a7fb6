//! One boundary, followed step by step.

mod ahead;
mod special;
mod step;
mod touch;

use std::collections::VecDeque;

use crate::cubic::Cubic;
use crate::curve::{Node, VertexKind};
use crate::family::{Family, FreeRun, Point};
use crate::options::TraceError;
use crate::tracing::branch::step::Attempt;
use crate::tracing::branch::touch::touch;
use crate::tracing::runs::{Runs, Traced};

/// Nodes closer than this part of the window's shorter extent are one.
pub(crate) const SHORTEST: f64 = 1e-9;

/// A place on a boundary from which it can be followed.
#[derive(Clone, Debug)]
pub struct Seed<Label, Margin> {
    /// The place.
    pub point: Point,
    /// A unit vector along the boundary.
    pub tangent: Point,
    /// The margin that vanishes.
    pub margin: Margin,
    /// Labels where the margin is positive and where it is negative.
    pub labels: [Label; 2],
}

/// The seed of a family.
pub(crate) type SeedOf<F> = Seed<<F as Family>::Label, <F as Family>::Margin>;

/// Why a branch ended.
#[derive(Clone, Debug)]
pub enum End<Margin> {
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
pub struct Special<Margin> {
    /// Where.
    pub point: Point,
    /// What it is.
    pub kind: VertexKind,
    /// The margins known to vanish there.
    pub margins: Vec<Margin>,
    /// How far off it may be.
    pub uncertainty: f64,
    /// Whether it was solved for; else it is only where the branch could not go on.
    pub solved: bool,
}

impl<Margin> Special<Margin> {
    /// Whether it tells much better where a known vertex is.
    pub(crate) fn improves(&self, stop: &Stop) -> bool {
        self.solved && self.uncertainty < 0.2 * stop.uncertainty
    }
}

/// A vertex that is known, where branches through it end.
#[derive(Clone, Copy, Debug)]
pub struct Stop {
    /// Where.
    pub point: Point,
    /// How far off it may be.
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
/// A step predicts along the last cubic, corrects along the normal, and is accepted if the tangent
/// turns little, the cubic is as close to the boundary as asked, and free runs on both sides have
/// the labels of the branch. The iterator is one node behind, because a special point between the
/// last two steps may take the last node back.
///
/// ```
/// use stickslip_tracer::{Branch, End, Family, FreeRun, Point, Runs, Seed, TraceOptions, Window};
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
/// let mut branch = Branch::new(&runs, &seed, true, &[])?.expect("on the boundary");
/// for node in &mut branch {
///     assert!((node?.point.norm() - 1.0).abs() < 1e-12);
/// }
/// assert!(matches!(branch.end(), Some(End::Closed)));
/// # Ok::<(), stickslip_tracer::TraceError<std::convert::Infallible>>(())
/// ```
pub struct Branch<'a, 'f, F: Family> {
    pub(crate) runs: &'a Runs<'f, F>,
    pub(crate) margin: F::Margin,
    /// Labels on the left and on the right.
    pub(crate) sides: [F::Label; 2],
    /// 1 where the margin is positive on the left, −1 where it is on the right.
    pub(crate) orientation: f64,
    pub(crate) stops: &'a [Stop],
    pub(crate) origin: Node,
    /// The last two footholds.
    pub(crate) trail: VecDeque<FootholdOf<F>>,
    /// Whether the last of them is still to be handed out.
    held: bool,
    pub(crate) step: f64,
    pub(crate) radius: f64,
    pub(crate) taken: usize,
    ready: VecDeque<Node>,
    end: Option<End<F::Margin>>,
    rejected: usize,
}

impl<'a, 'f, F: Family> Branch<'a, 'f, F> {
    /// The branch that leaves `seed` with the positive side on its left (`forward`), or the other
    /// way, and ends at the `stops` it comes to; `None` if the seed is not on a boundary
    /// between its labels.
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

    /// Steps that were rejected so far.
    pub fn rejected(&self) -> usize {
        self.rejected
    }

    /// The radius of curvature where it is.
    pub(crate) fn radius(&self) -> f64 {
        self.radius
    }

    /// The next node, or `None` at the end.
    fn advance(&mut self) -> Traced<Option<Node>, F> {
        while self.ready.is_empty() && self.end.is_none() {
            self.take_step()?;
        }
        Ok(self.ready.pop_front())
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
            if stuck
                && matches!(failures, 1 | 4 | 8 | 16 | 24 | 32)
                && let Some(special) = special::locate(self, &from, beyond.as_ref(), h)?
            {
                return self.finish_at(special);
            }
            if h < 1e-12 * self.runs.scale {
                let special = special::give_up(self, &from, h)?;
                return self.finish_at(special);
            }
            h *= factor;
        }
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
        let arc = Cubic::between(&from.node, &foothold.node);
        let options = &self.runs.options;
        let angle = from.node.tangent.angle(&foothold.node.tangent);
        self.radius = (arc.chord() / angle).min(self.runs.scale);
        let by_error = (0.4 * options.interpolation / error).powf(0.25);
        let by_angle = 0.7 * options.max_angle / angle;
        let by_effort = 4.0 / evaluations as f64;
        let most = if shortened { 1.0 } else { 2.0 };
        self.step = arc.chord() * by_error.min(by_angle).min(by_effort).clamp(0.3, most);

        if let Some((special, before_last)) = touch(self, &foothold)? {
            if before_last {
                self.trail.pop_back();
                self.held = false;
            }
            return self.finish_at(special);
        }
        if let Some(index) = self.passed_stop(&arc) {
            return self.finish(End::Known(index), None);
        }
        if self.taken > 0 && self.passes_origin(&arc) {
            return self.finish(End::Closed, Some(self.origin));
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
    pub(crate) fn trail(&self) -> &VecDeque<FootholdOf<F>> {
        &self.trail
    }

    /// Ends at a special point, which becomes the last node.
    fn finish_at(&mut self, special: Special<F::Margin>) -> Traced<(), F> {
        let near = special.uncertainty + SHORTEST * self.runs.scale;
        let known = self
            .stops
            .iter()
            .position(|stop| (stop.point - special.point).norm() <= stop.uncertainty + near)
            .filter(|&index| !special.improves(&self.stops[index]));
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

    /// Hands out the node that was held back, then `point`, or a known vertex that lies before it.
    fn finish_with(&mut self, end: End<F::Margin>, point: Point) -> Traced<(), F> {
        self.hand_out();
        let Some(last) = self.trail.back().map(|foothold| foothold.node) else { return Ok(()) };
        let mut node = self.end_node(&last, &point)?;
        self.end = Some(end);
        let reaches = |stop: &Stop| (stop.point - point).norm() <= stop.uncertainty;
        if let Some(index) = self.passed_stop(&Cubic::between(&last, &node))
            && !reaches(&self.stops[index])
        {
            node = self.end_node(&last, &self.stops[index].point)?;
            self.end = Some(End::Known(index));
        }
        self.ready.push_back(node);
        Ok(())
    }
}

impl<F: Family> Iterator for Branch<'_, '_, F> {
    type Item = Result<Node, TraceError<F::Error>>;

    fn next(&mut self) -> Option<Self::Item> {
        self.advance().transpose()
    }
}
