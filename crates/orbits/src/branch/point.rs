//! Points of a branch, and the way from one to the next.

use nalgebra::{DMatrix, DVector};

use super::borders::null_vector;
use super::watches::Watches;
use crate::equations::{Draft, Equations, Evaluation};
use crate::error::OrbitError;
use crate::find::Orbits;
use crate::newton::correct;
use crate::orbit::Orbit;

/// The least cosine of the angle between the tangents at two neighbours.
pub(super) const LEAST_TURN: f64 = 0.95;
/// What is said where no direction leads on.
pub(super) const NO_DIRECTION: OrbitError = OrbitError::nowhere("the branch has no direction");
/// A point is not so far from the one before as so many steps.
const FARTHEST: f64 = 1.5;

/// What a branch follows.
pub(crate) struct Along<'a> {
    pub orbits: &'a Orbits,
    pub equations: &'a Equations,
    pub parameter: usize,
    pub range: [f64; 2],
    /// Whether points have verdicts.
    pub judged: bool,
    pub watches: Watches,
}

/// A point of a branch.
#[derive(Clone, Debug)]
pub(crate) struct Point {
    pub place: DVector<f64>,
    /// The direction of the branch, of length 1.
    pub tangent: DVector<f64>,
    pub evaluation: Evaluation,
    pub orbit: Orbit,
}

impl Point {
    /// The point with the other direction.
    pub fn turned(&self) -> Self {
        Self { tangent: -&self.tangent, ..self.clone() }
    }

    /// Whether the branch passes its start between this point and the next one.
    pub fn passes(&self, other: &Self, start: &Self) -> bool {
        let (whole, part) = (&other.place - &self.place, &start.place - &self.place);
        let along = self.tangent.dot(&part);
        let length = self.tangent.dot(&whole);
        let aside = (part - along * &self.tangent).norm();
        (0.0..=length).contains(&along)
            && aside < 0.2 * length
            && self.tangent.dot(&start.tangent) > 0.9
    }
}

impl<'a> Along<'a> {
    /// What follows a branch over a range of a parameter.
    pub fn new(
        orbits: &'a Orbits,
        equations: &'a Equations,
        parameter: usize,
        range: [f64; 2],
    ) -> Self {
        let watches = Watches::default();
        Self { orbits, equations, parameter, range, judged: true, watches }
    }
}

impl Along<'_> {
    /// The unknown that is the parameter.
    fn last(&self) -> usize {
        self.equations.count()
    }

    /// The value of the parameter at a place.
    pub fn value(&self, place: &DVector<f64>) -> f64 {
        place[self.last()] * self.equations.size(self.last())
    }

    /// The point at which a branch starts.
    pub fn first(&self, draft: &Draft) -> Result<Point, OrbitError> {
        let place = self.equations.place(draft);
        let place = self.at_parameter(&place, draft.parameters[self.parameter])?;
        let mut axis = DVector::zeros(place.len());
        axis[self.last()] = 1.0;
        self.point(place, &axis)
    }

    /// The place near another one with this value of the parameter.
    fn at_parameter(&self, near: &DVector<f64>, value: f64) -> Result<DVector<f64>, OrbitError> {
        let last = self.last();
        let wanted = value / self.equations.size(last);
        let condition = |place: &DVector<f64>| {
            let mut axis = DVector::zeros(place.len());
            axis[last] = 1.0;
            (place[last] - wanted, axis)
        };
        let mut start = near.clone();
        start[last] = wanted;
        correct(self.equations, &start, &[&condition]).map(|zero| zero.at)
    }

    /// A place without direction and verdict.
    pub fn sketch(&self, place: DVector<f64>) -> Result<Point, OrbitError> {
        self.orbits.require_wanted()?;
        let evaluation = self.equations.at(&place)?;
        let draft = self.equations.draft(&place);
        let orbit = Orbits::sketched(self.equations, &draft, &evaluation, 1e-13);
        Ok(Point { place, tangent: DVector::zeros(0), evaluation, orbit })
    }

    /// The point at a place of the branch, which goes on about in a direction.
    fn point(&self, place: DVector<f64>, direction: &DVector<f64>) -> Result<Point, OrbitError> {
        let evaluation = self.equations.at(&place)?;
        let tangent = tangent(&evaluation.slopes, direction).ok_or(NO_DIRECTION)?;
        let draft = self.equations.draft(&place);
        let orbit = if self.judged {
            self.orbits.orbit(self.equations, &draft, &evaluation, 1e-13)?
        } else {
            Orbits::sketched(self.equations, &draft, &evaluation, 1e-13)
        };
        Ok(Point { place, tangent, evaluation, orbit })
    }

    /// The point of the branch that is ahead of another one by a length along its tangent.
    pub fn ahead(&self, from: &Point, length: f64) -> Result<Point, OrbitError> {
        self.orbits.require_wanted()?;
        let start = &from.place + length * &from.tangent;
        let condition =
            |place: &DVector<f64>| (from.tangent.dot(&(place - &start)), from.tangent.clone());
        let zero = correct(self.equations, &start, &[&condition])?;
        self.point(zero.at, &from.tangent)
    }

    /// The next point: at most by `step` ahead, and not beyond the range.
    pub fn step(&self, from: &Point, step: f64) -> Result<Point, OrbitError> {
        let next = self.ahead(from, step)?;
        let away = (&next.place - &from.place).norm();
        let turn = from.tangent.dot(&next.tangent);
        if turn < LEAST_TURN || away > FARTHEST * step {
            return Err(OrbitError::NotFound {
                reason: "the branch turns sharply",
                segment: 0,
                update: away,
            });
        }
        let value = self.value(&next.place);
        let [low, high] = self.range;
        if (low..=high).contains(&value) {
            return Ok(next);
        }
        let end = if value < low { low } else { high };
        let (before, last) = (self.value(&from.place), self.last());
        let part = (end - before) / (value - before);
        let near = &from.place + part * (&next.place - &from.place);
        let mut place = self.at_parameter(&near, end)?;
        place[last] = end / self.equations.size(last);
        self.point(place, &from.tangent)
    }

    /// Whether a point is at an end of the range, and the branch leads out of it.
    pub fn is_at_end(&self, point: &Point) -> bool {
        let (value, last) = (self.value(&point.place), self.last());
        let [low, high] = self.range;
        let near = 1e-12 * (high - low);
        let out = point.tangent[last];
        (value <= low + near && out < 0.0) || (value >= high - near && out > 0.0)
    }
}

/// The direction of a branch, of length 1 and towards the same side as another one.
fn tangent(slopes: &DMatrix<f64>, direction: &DVector<f64>) -> Option<DVector<f64>> {
    let count = slopes.nrows();
    let mut matrix = slopes.clone().insert_row(count, 0.0);
    matrix.row_mut(count).copy_from(&direction.transpose());
    let mut right = DVector::zeros(count + 1);
    right[count] = 1.0;
    let solved = matrix.clone().lu().solve(&right).filter(|it| it.iter().all(|x| x.is_finite()));
    let found = solved.unwrap_or_else(|| {
        // Across the direction: the null vector of the equations alone.
        matrix.row_mut(count).fill(0.0);
        null_vector(&matrix)
    });
    let unit = found.try_normalize(0.0)?;
    Some(if unit.dot(direction) < 0.0 { -unit } else { unit })
}
