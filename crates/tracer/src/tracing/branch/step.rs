//! One step of a branch: predict, correct, and check.

use crate::cubic::Cubic;
use crate::curve::Node;
use crate::family::Family;
use crate::tracing::branch::track::{Foothold, FootholdOf, Track};
use crate::tracing::corrector::{correct, correct_on_edge};
use crate::tracing::fit::{SHOWING, SHOWN};
use crate::tracing::runs::Traced;
use crate::window::{Point, Window};

/// The outcome of a step that was tried.
pub(crate) enum Attempt<Label, Margin> {
    Accepted {
        foothold: Foothold<Label, Margin>,
        /// The distance of the new cubic from the boundary.
        error: f64,
        /// The number of evaluations of the margin in the correction.
        evaluations: usize,
        /// Whether the step ends at the edge of the window.
        edge: bool,
    },
    /// The margin does not exist, or its zero was not found.
    Lost,
    /// The tangent turns too much, by this angle.
    Turn(f64),
    /// The new cubic is too far from the boundary, by this distance.
    Rough(f64),
    /// The labels on the sides are not the labels of the branch.
    Labels(Foothold<Label, Margin>),
}

impl<F: Family> Track<'_, '_, F> {
    /// The length of the step to try, which does not lead far beyond the window.
    pub(crate) fn limited_step(&self, from: &Node) -> f64 {
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
            .min(self.runs.options.max_step * self.runs.lengths.scale)
            .min(exit + self.runs.lengths.around)
    }

    /// Tries a step of length `h`.
    pub(crate) fn attempt(
        &self,
        from: &FootholdOf<F>,
        h: f64,
    ) -> Traced<Attempt<F::Label, F::Margin>, F> {
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
        let straight = angle <= runs.options.max_angle;
        if !straight {
            return Ok(Attempt::Turn(angle));
        }
        let node = Node { point: corrected.point, tangent };
        let arc = Cubic::between(&from.node, &node);
        let Some(value) = runs.margin(&arc.at(SHOWING[0]), &self.margin)? else {
            return Ok(Attempt::Lost);
        };
        let slope = 0.5 * (gradient.norm() + from.gradient.norm());
        let error = ((value.abs() - runs.options.noise) / slope / SHOWN).max(0.0);
        let close = error <= runs.options.interpolation;
        if !close {
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
                let arc = Cubic::between(&from.node, &foothold.node);
                if let Some(index) = self.passed_stop(&arc) {
                    let end = self.end_node(&from.node, &self.stops[index].point)?;
                    let arc = Cubic::between(&from.node, &end);
                    // Another special point lies before the vertex. Shorter steps find it.
                    if arc.chord() > runs.lengths.piece && !self.is_clear(from, &arc, 0.0)? {
                        return Ok(Attempt::Lost);
                    }
                }
                Attempt::Accepted { foothold, error, evaluations: corrected.evaluations, edge }
            }
            Err(beyond) => Attempt::Labels(beyond),
        })
    }

    /// Whether an accepted step is close to the boundary at the other place too at which errors
    /// show. Where the margin does not exist, the step counts as close.
    pub(crate) fn is_close(&self, from: &FootholdOf<F>, arc: &Cubic) -> Traced<bool, F> {
        let options = &self.runs.options;
        let most = SHOWN * options.interpolation * from.gradient.norm() + options.noise;
        let value = self.runs.margin(&arc.at(SHOWING[1]), &self.margin)?;
        Ok(value.is_none_or(|value| value.abs() <= most))
    }

    /// The place where the branch leaves the window on its way from the last foothold to `point`;
    /// `None` if `point` lies in the window or on its edge.
    pub(crate) fn exit_before(&self, point: &Point) -> Traced<Option<Point>, F> {
        let Some(from) = self.footholds.back() else { return Ok(None) };
        let Window { low, high } = self.runs.window;
        let slack = Point::repeat(self.runs.lengths.same);
        if (Window { low: low - slack, high: high + slack }).contains(point) {
            return Ok(None);
        }
        let arc = Cubic::between(&from.node, &self.end_node(&from.node, point)?);
        self.leave_window(&arc, &from.gradient)
    }

    /// The place where `arc` leaves the window, solved for on the edge; `None` if it does not.
    fn leave_window(&self, arc: &Cubic, gradient: &Point) -> Traced<Option<Point>, F> {
        let window = &self.runs.window;
        if window.contains(&arc.at(1.0)) {
            return Ok(None);
        }
        let (mut inside, mut outside) = (0.0, 1.0);
        for _ in 0..50 {
            let middle = 0.5 * (inside + outside);
            if window.contains(&arc.at(middle)) { inside = middle } else { outside = middle }
        }
        let exit = arc.at(outside);
        let axis = usize::from(exit.y < window.low.y || exit.y > window.high.y);
        let edge =
            if exit[axis] > window.high[axis] { window.high[axis] } else { window.low[axis] };
        let mut guess = arc.at(inside);
        guess[axis] = edge;
        let reach = 0.3 * arc.chord();
        let solved = correct_on_edge(self.runs, &self.margin, &guess, gradient, axis, reach)?;
        let point = solved.unwrap_or(guess);
        Ok(Some(point.sup(&window.low).inf(&window.high)))
    }
}
