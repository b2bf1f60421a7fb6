//! One step of a branch: predict, correct, and see whether it is good.

use crate::cubic::Cubic;
use crate::curve::Node;
use crate::family::{Family, Point};
use crate::tracing::branch::{Branch, Foothold, FootholdOf};
use crate::tracing::corrector::correct;
use crate::tracing::runs::Traced;

/// What became of a step.
pub(crate) enum Attempt<Label, Margin> {
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

impl<F: Family> Branch<'_, '_, F> {
    /// Tangent at a place with this gradient.
    pub(crate) fn tangent(&self, gradient: &Point) -> Point {
        Point::new(gradient.y, -gradient.x) * (self.orientation / gradient.norm())
    }

    /// The place on the boundary with the free runs on both sides; `Err` if their labels are not
    /// those of the branch.
    ///
    /// Where another boundary is closer than the offset, a smaller offset is tried, as far as the
    /// place itself is known.
    pub(crate) fn foothold(
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

    /// The step to try: not far beyond the window.
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
            .min(self.runs.options.max_step * self.runs.scale)
            .min(exit + 1e-3 * self.runs.scale)
    }

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
        // Off the middle, where the errors of fourth and of fifth order both show; the first has
        // 0.7 of its maximum there.
        let Some(value) = runs.margin(&arc.at(0.3), &self.margin)? else {
            return Ok(Attempt::Lost);
        };
        let slope = 0.5 * (gradient.norm() + from.gradient.norm());
        let error = ((value.abs() - runs.options.noise) / slope / 0.7).max(0.0);
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
                    // Another special point lies before the vertex: shorter steps find it.
                    if arc.chord() > 1e-6 * runs.scale && !self.is_clear(from, &arc)? {
                        return Ok(Attempt::Lost);
                    }
                }
                Attempt::Accepted { foothold, error, evaluations: corrected.evaluations, edge }
            }
            Err(beyond) => Attempt::Labels(beyond),
        })
    }

    /// The last cubic goes on, if the step is not much longer than it; else the tangent.
    pub(crate) fn predict(&self, from: &Node, h: f64) -> Point {
        let before = self.trail.len().checked_sub(2).map(|index| self.trail[index].node);
        if let Some(before) = before {
            let arc = Cubic::between(&before, from);
            if h < 2.5 * arc.chord() && arc.chord() > 1e-6 * self.runs.scale {
                return arc.at(1.0 + h / arc.chord());
            }
        }
        from.point + from.tangent * h
    }

    /// Where the piece leaves the window, solved on the edge; `None` if it does not.
    pub(crate) fn leave_window(&self, arc: &Cubic, gradient: &Point) -> Traced<Option<Point>, F> {
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
}
