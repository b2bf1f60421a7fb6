//! Places on a curve, and the way from one to the next.

use nalgebra::{DMatrix, DVector};
use stickslip_expression::InvalidValue;

use super::super::borders::{Borders, null_vector};
use super::super::change::Margin;
use super::super::point::{LEAST_TURN, NO_DIRECTION, Point};
use super::super::test::Test;
use super::{Follower, SpecialKind, SpecialOrbit, Station, Tracked};
use crate::error::OrbitError;
use crate::newton::correct;

/// How far unknowns are moved for differences.
const APART: f64 = 1e-5;

impl Follower<'_> {
    /// The function that is zero along the curve, from a point on.
    fn tracked(&self, point: &Point) -> Result<Tracked, OrbitError> {
        let equations = self.along.equations;
        let slopes = &point.evaluation.slopes;
        let SpecialOrbit { kind, segment, rule, .. } = *self.special;
        let unknown = || {
            let expected = "a kind of special orbit that has a function: not `branch-point`, \
                            `boundary` or `infinite-period`";
            InvalidValue::new("the special orbit", kind.name(), expected)
        };
        Ok(match (kind, segment, rule) {
            (SpecialKind::Fold, ..) => {
                Tracked::Test(Test::Singular(Borders::of(&equations.returning(slopes, 1.0))))
            }
            (SpecialKind::Flip, ..) => {
                Tracked::Test(Test::Flip(Borders::of(&equations.returning(slopes, -1.0))))
            }
            (SpecialKind::NeimarkSacker, ..) => Tracked::Test(Test::NeimarkSacker),
            (
                SpecialKind::Grazing | SpecialKind::GrazingSliding | SpecialKind::AddingSliding,
                Some(segment),
                Some(rule),
            ) => {
                let event = &point.evaluation.ends[segment].event;
                let at_event = equations.legs()[segment].rule == rule && event.grazes();
                if at_event {
                    Tracked::Test(Test::Rate(segment))
                } else {
                    Tracked::Margin(Margin::Inner { segment, rule })
                }
            }
            (SpecialKind::SlidingEdge | SpecialKind::Choice, Some(segment), _) => {
                Tracked::Margin(Margin::Choice { segment })
            }
            (SpecialKind::VanishingSegment, Some(segment), _) => {
                Tracked::Margin(Margin::Duration { segment })
            }
            (SpecialKind::CornerCollision, Some(segment), Some(rule)) => {
                let both = [Margin::AtEnd { segment, rule }, Margin::AtStart { segment, rule }];
                let size = |margin: &Margin| {
                    self.along.margin(margin, point).map_or(f64::INFINITY, f64::abs)
                };
                let [one, other] = both;
                Tracked::Margin(if size(&one) <= size(&other) { one } else { other })
            }
            _ => return Err(unknown().into()),
        })
    }

    fn value(&self, tracked: &Tracked, point: &Point) -> f64 {
        let value = match tracked {
            Tracked::Test(test) => test.value(&self.along, point),
            Tracked::Margin(margin) => self.along.margin(margin, point),
        };
        value.unwrap_or(f64::NAN)
    }

    fn value_at(&self, tracked: &Tracked, place: &DVector<f64>) -> f64 {
        let point = self.along.sketch(place.clone());
        point.map_or(f64::NAN, |point| self.value(tracked, &point))
    }

    /// The derivatives of the function by all unknowns.
    fn gradient(&self, tracked: &Tracked, place: &DVector<f64>) -> DVector<f64> {
        let by = (0..place.len()).map(|unknown| {
            let [above, below] = [APART, -APART].map(|apart| {
                let mut moved = place.clone();
                moved[unknown] += apart;
                self.value_at(tracked, &moved)
            });
            (above - below) / (2.0 * APART)
        });
        DVector::from_iterator(place.len(), by)
    }

    /// The station at a place, which goes on about in a direction.
    pub fn station(
        &self,
        place: DVector<f64>,
        towards: Option<&DVector<f64>>,
    ) -> Result<Station, OrbitError> {
        let point = self.along.sketch(place)?;
        let tracked = self.tracked(&point)?;
        let gradient = self.gradient(&tracked, &point.place);
        let tangent = direction(&point.evaluation.slopes, &gradient, towards);
        let tangent = tangent.ok_or(NO_DIRECTION)?;
        Ok(Station { point, tangent, tracked, gradient })
    }

    /// The station ahead of another one by a length along its tangent, or where a parameter has a
    /// value.
    pub fn ahead(
        &self,
        from: &Station,
        length: f64,
        fixed: Option<(usize, f64)>,
    ) -> Result<Station, OrbitError> {
        let start = &from.point.place + length * &from.tangent;
        let step = |place: &DVector<f64>| match fixed {
            None => (from.tangent.dot(&(place - &start)), from.tangent.clone()),
            Some((unknown, value)) => {
                let mut axis = DVector::zeros(place.len());
                axis[unknown] = 1.0;
                (place[unknown] - value, axis)
            }
        };
        let near = |own: &Station, start: &DVector<f64>| {
            let special =
                |place: &DVector<f64>| (self.value_at(&own.tracked, place), own.gradient.clone());
            correct(self.along.equations, start, &[&special, &step]).map(|found| found.at)
        };
        // With derivatives of the place before, and then with those of the place itself.
        let found = self.station(near(from, &start)?, Some(&from.tangent))?;
        let point = self.along.sketch(near(&found, &found.point.place)?)?;
        Ok(Station { point, ..found })
    }

    /// The parameters at a place, in parts of the lengths of their ranges.
    pub fn parameters(&self, place: &DVector<f64>) -> [f64; 2] {
        let count = self.along.equations.count();
        [place[count], place[count + 1]]
    }

    /// Where the window ends in a parameter, in the same parts.
    fn ends(&self, parameter: usize) -> [f64; 2] {
        let [low, high] = self.window[parameter];
        [low / (high - low), high / (high - low)]
    }

    /// The next station: at most by `step` ahead, and not beyond the window.
    pub fn next(&self, from: &Station, step: f64) -> Result<(Station, bool), OrbitError> {
        let next = self.ahead(from, step, None)?;
        let turn = from.tangent.dot(&next.tangent);
        if turn < LEAST_TURN {
            let reason = "the curve turns sharply";
            return Err(OrbitError::NotFound { reason, segment: 0, update: step });
        }
        let before = self.parameters(&from.point.place);
        let values = self.parameters(&next.point.place);
        let mut first: Option<(f64, usize, f64)> = None;
        for (parameter, value) in values.into_iter().enumerate() {
            let [low, high] = self.ends(parameter);
            let end = if value < low { low } else { high };
            if !(low..=high).contains(&value) {
                let part = (end - before[parameter]) / (value - before[parameter]);
                if first.is_none_or(|(other, ..)| part < other) {
                    first = Some((part, parameter, end));
                }
            }
        }
        let Some((part, parameter, end)) = first else { return Ok((next, false)) };
        let unknown = self.along.equations.count() + parameter;
        let last = self.ahead(from, part * step, Some((unknown, end)))?;
        Ok((last, true))
    }
}

/// The direction of a curve, of length 1, towards the side of another one.
fn direction(
    slopes: &DMatrix<f64>,
    gradient: &DVector<f64>,
    towards: Option<&DVector<f64>>,
) -> Option<DVector<f64>> {
    let count = slopes.nrows();
    let mut matrix = slopes.clone().insert_rows(count, 2, 0.0);
    let size = gradient.norm();
    if !(size > 0.0 && size.is_finite()) {
        return None;
    }
    matrix.row_mut(count).copy_from(&(gradient / size).transpose());
    let unit = null_vector(&matrix);
    let turned = towards.is_some_and(|towards| unit.dot(towards) < 0.0);
    Some(if turned { -unit } else { unit })
}
