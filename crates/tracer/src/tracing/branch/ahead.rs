//! What lies ahead of a branch: known vertices and its own start.

use crate::cubic::Cubic;
use crate::curve::Node;
use crate::family::Family;
use crate::tracing::branch::track::{FootholdOf, Track};
use crate::tracing::corrector::correct;
use crate::tracing::end::Stop;
use crate::tracing::fit::mirrored;
use crate::tracing::runs::Traced;
use crate::window::Point;

impl<F: Family> Track<'_, '_, F> {
    /// The index of the first known vertex on `arc`.
    pub(crate) fn passed_stop(&self, arc: &Cubic) -> Option<usize> {
        let [low, high] = arc.bounds();
        let passed = |stop: &Stop| {
            let near = stop.uncertainty + self.runs.lengths.same;
            let inside = (0..2).all(|axis| {
                stop.point[axis] > low[axis] - near && stop.point[axis] < high[axis] + near
            });
            let (theta, distance) = if inside { arc.closest(&stop.point) } else { return None };
            (distance < near && (self.taken > 0 || theta > 0.0)).then_some(theta)
        };
        let thetas = self.stops.iter().enumerate().filter_map(|(i, stop)| Some((passed(stop)?, i)));
        thetas.min_by(|one, two| one.0.total_cmp(&two.0)).map(|(_, index)| index)
    }

    /// The index of the known vertex that the branch reaches within a failed step of length `h`,
    /// without another special point before it.
    pub(crate) fn aim(&self, from: &FootholdOf<F>, h: f64) -> Traced<Option<usize>, F> {
        for (index, stop) in self.stops.iter().enumerate() {
            if let Some(arc) = self.leads_to(from, stop, 2.0 * h)?
                && self.is_clear(from, &arc, 0.0)?
            {
                return Ok(Some(index));
            }
        }
        Ok(None)
    }

    /// The index of the nearest known vertex to which the branch leads beyond a place where even
    /// the shortest step fails. Where boundaries touch, the strip between them is narrower than
    /// runs can resolve before it ends.
    pub(crate) fn touched(&self, from: &FootholdOf<F>) -> Traced<Option<usize>, F> {
        let distance = |index: usize| (self.stops[index].point - from.node.point).norm();
        let mut nearest: Option<usize> = None;
        for (index, stop) in self.stops.iter().enumerate() {
            if nearest.is_none_or(|other| distance(index) < distance(other))
                && self.leads_to(from, stop, self.runs.lengths.around)?.is_some()
            {
                nearest = Some(index);
            }
        }
        Ok(nearest)
    }

    /// The way along the branch to a known vertex ahead, at most `farthest` away; `None` if it does
    /// not pass through the vertex.
    fn leads_to(
        &self,
        from: &FootholdOf<F>,
        stop: &Stop,
        farthest: f64,
    ) -> Traced<Option<Cubic>, F> {
        let runs = self.runs;
        let chord = stop.point - from.node.point;
        let length = chord.norm();
        let angle = chord.angle(&from.node.tangent);
        let ahead = length > runs.lengths.same
            && length <= farthest
            && angle <= 0.5 * runs.options.max_angle;
        if !ahead {
            return Ok(None);
        }
        let end = Node { point: stop.point, tangent: mirrored(&from.node.tangent, &chord) };
        let arc = Cubic::between(&from.node, &end);
        for theta in [0.3, 0.7] {
            let value = runs.margin(&arc.at(theta), &self.margin)?;
            let on_branch = value.is_some_and(|value| {
                value.abs() <= runs.options.interpolation * from.gradient.norm()
            });
            if !on_branch {
                return Ok(None);
            }
        }
        Ok(Some(arc))
    }

    /// Whether the branch keeps its labels on `arc`, which ends at a vertex. They are computed at
    /// three places and close to the vertex, but no closer than `apart`: within that distance runs
    /// do not distinguish the boundaries that meet there.
    pub(crate) fn is_clear(
        &self,
        from: &FootholdOf<F>,
        arc: &Cubic,
        apart: f64,
    ) -> Traced<bool, F> {
        let chord = arc.chord();
        for theta in [0.5, 0.9, 0.99] {
            let is_apart = (1.0 - theta) * chord >= apart;
            if is_apart && !self.holds(from, &arc.at(theta), 0.3 * chord)? {
                return Ok(false);
            }
        }
        let close = self.runs.lengths.clear.max(apart) / chord;
        Ok(close > 0.5 || self.holds_closely(from, &arc.at(1.0 - close), 0.3 * chord)?)
    }

    /// Whether the branch passes close to `guess` and has its labels at the least distance that
    /// margins resolve, so that not even a thin region lies beside it.
    pub(crate) fn holds_closely(
        &self,
        from: &FootholdOf<F>,
        guess: &Point,
        reach: f64,
    ) -> Traced<bool, F> {
        let runs = self.runs;
        let Some(found) = correct(runs, &self.margin, guess, &from.gradient, reach)? else {
            return Ok(false);
        };
        let tangent = &from.node.tangent;
        let gradient = runs.gradient(&found.point, &self.margin, tangent, self.radius)?;
        let Some(gradient) = gradient else { return Ok(false) };
        let slope = gradient.norm();
        let left = gradient * (10.0 * self.orientation * runs.resolution(slope) / slope);
        Ok(runs.label(&(found.point + left))? == self.sides[0]
            && runs.label(&(found.point - left))? == self.sides[1])
    }

    /// Whether the branch passes close to `guess` and has its labels there.
    pub(crate) fn holds(&self, from: &FootholdOf<F>, guess: &Point, reach: f64) -> Traced<bool, F> {
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

    /// Whether `arc` passes through the start of the branch, in the direction of the branch there.
    pub(crate) fn passes_origin(&self, arc: &Cubic) -> bool {
        let (theta, distance) = arc.closest(&self.origin.point);
        distance < self.runs.lengths.touch && theta > 0.0 && {
            arc.tangent(theta).dot(&self.origin.tangent) > 0.5
        }
    }
}
