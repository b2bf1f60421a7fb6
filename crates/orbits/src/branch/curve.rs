//! Curves of special orbits over two parameters, by pseudo-arclength.
//!
//! What is zero along a branch at a special orbit is one more equation, and a second parameter one
//! more unknown. Its derivatives are differences of its values, which are computed once for each
//! step: they make the search a little slower, and its result no less accurate.

use nalgebra::{DMatrix, DVector};
use stickslip_expression::InvalidValue;

use super::borders::{Borders, null_vectors};
use super::change::Margin;
use super::locate::zero;
use super::point::{Along, LEAST_TURN, NO_DIRECTION, Point};
use super::test::Test;
use super::{BranchOptions, Half, SpecialKind, SpecialOrbit};
use crate::equations::Equations;
use crate::error::OrbitError;
use crate::find::Orbits;
use crate::newton::correct;
use crate::orbit::Orbit;

/// How far unknowns are moved for differences.
const APART: f64 = 1e-5;

/// Special orbits of one kind over two parameters.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SpecialCurve<P = usize, O = Orbit> {
    /// Their kind.
    pub kind: SpecialKind,
    /// The parameters, by their places in the system.
    pub parameters: [P; 2],
    /// The window, an interval for each parameter.
    pub window: [[f64; 2]; 2],
    /// The orbits, in the order of the curve.
    pub points: Vec<O>,
    /// Orbits at which something else changes too, in the order of the curve.
    pub meetings: Vec<Meeting<O>>,
    /// Whether the curve comes back to its start.
    pub closed: bool,
    /// Why the curve is not complete.
    pub objection: Option<String>,
}

/// An orbit that is special twice.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Meeting<O = Orbit> {
    /// What changes besides. On a curve of `neimark-sacker`, `fold` is the resonance 1:1 and `flip`
    /// the resonance 1:2.
    pub kind: SpecialKind,
    /// The segment at which it happens, if it happens at one.
    pub segment: Option<usize>,
    /// The number of points of the curve before it.
    pub behind: usize,
    /// The orbit.
    pub orbit: O,
}

/// What is zero along a curve.
enum Tracked {
    Test(Test),
    Margin(Margin),
}

/// A place on a curve, with its direction.
#[derive(Clone)]
struct Station {
    point: Point,
    tangent: DVector<f64>,
}

/// What a curve follows.
struct Follower<'a> {
    along: Along<'a>,
    special: &'a SpecialOrbit,
    window: [[f64; 2]; 2],
}

impl Orbits {
    /// The curve of a special orbit over two parameters, in both directions from it.
    ///
    /// # Errors
    /// [`OrbitError`] if the curve does not begin: for instance for a kind that no function says,
    /// `branch-point` and `boundary`.
    pub fn curve(
        &self,
        special: &SpecialOrbit,
        parameters: [usize; 2],
        window: [[f64; 2]; 2],
        options: &BranchOptions,
    ) -> Result<SpecialCurve, OrbitError> {
        options.validate()?;
        self.compiled.with(&special.orbit.parameters)?;
        let [one, other] = parameters;
        let expected = "the places of two parameters";
        InvalidValue::check("the parameters", one, expected, one != other)?;
        for (place, range) in parameters.into_iter().zip(window) {
            self.require_range(&special.orbit, place, range)?;
        }
        let segments = &special.orbit.segments;
        let segment = special.segment.unwrap_or(0);
        let expected = format!("one of {} segments", segments.len());
        InvalidValue::check("the segment", segment, expected, segment < segments.len())?;
        let rules = self.system.modes.get(segments[segment].leg.mode);
        let rules = rules.map_or(0, |mode| mode.rules.len());
        let (rule, expected) = (special.rule.unwrap_or(0), format!("one of {rules} rules"));
        InvalidValue::check("the rule", rule, expected, special.rule.is_none() || rule < rules)?;
        let active = [0, 1].map(|k| (parameters[k], window[k][1] - window[k][0]));
        let draft = special.orbit.draft();
        let equations = Equations::new(&self.system, draft.clone(), &active, &self.options)?;
        let along = Along { orbits: self, equations: &equations, parameter: one, range: window[0] };
        let follower = Follower { along, special, window };
        // The special orbit may have been written and read.
        let start = follower.ahead(&follower.first(&equations.place(&draft))?, 0.0, None)?;
        let ahead = follower.half(&start, options);
        let turned = Station { tangent: -&start.tangent, ..start.clone() };
        let back = (!ahead.closed).then(|| follower.half(&turned, options));
        let start = self.judged(&equations, &start.point.orbit)?;
        let Half { points, specials: meetings, closed, objection } =
            ahead.joined(start, back, |meeting| &mut meeting.behind);
        let kind = special.kind;
        Ok(SpecialCurve { kind, parameters, window, points, meetings, closed, objection })
    }
}

impl Follower<'_> {
    /// The function that is zero along the curve, from a point on.
    fn tracked(&self, point: &Point) -> Result<Tracked, OrbitError> {
        let equations = self.along.equations;
        let slopes = &point.evaluation.slopes;
        let SpecialOrbit { kind, segment, rule, .. } = *self.special;
        let unknown = || {
            let expected = "a kind of special orbit that has a function: not `branch-point` and \
                            not `boundary`";
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

    /// The station at which a curve starts.
    fn first(&self, place: &DVector<f64>) -> Result<Station, OrbitError> {
        let point = self.along.sketch(place.clone())?;
        let tracked = self.tracked(&point)?;
        let gradient = self.gradient(&tracked, place);
        let tangent = direction(&point.evaluation.slopes, &gradient, None);
        tangent.map(|tangent| Station { point, tangent }).ok_or(NO_DIRECTION)
    }

    /// The station ahead of another one by a length along its tangent, or where a parameter has a
    /// value.
    fn ahead(
        &self,
        from: &Station,
        length: f64,
        fixed: Option<(usize, f64)>,
    ) -> Result<Station, OrbitError> {
        let tracked = self.tracked(&from.point)?;
        let start = &from.point.place + length * &from.tangent;
        let gradient = self.gradient(&tracked, &start);
        let special = |place: &DVector<f64>| (self.value_at(&tracked, place), gradient.clone());
        let step = |place: &DVector<f64>| match fixed {
            None => (from.tangent.dot(&(place - &start)), from.tangent.clone()),
            Some((unknown, value)) => {
                let mut axis = DVector::zeros(place.len());
                axis[unknown] = 1.0;
                (place[unknown] - value, axis)
            }
        };
        let found = correct(self.along.equations, &start, &[&special, &step])?;
        let point = self.along.sketch(found.at)?;
        let gradient = self.gradient(&tracked, &point.place);
        let tangent = direction(&point.evaluation.slopes, &gradient, Some(&from.tangent));
        tangent.map(|tangent| Station { point, tangent }).ok_or(NO_DIRECTION)
    }

    /// The parameters at a place, in parts of the lengths of their ranges.
    fn parameters(&self, place: &DVector<f64>) -> [f64; 2] {
        let count = self.along.equations.count();
        [place[count], place[count + 1]]
    }

    /// Where the window ends in a parameter, in the same parts.
    fn ends(&self, parameter: usize) -> [f64; 2] {
        let [low, high] = self.window[parameter];
        [low / (high - low), high / (high - low)]
    }

    /// The next station: at most by `step` ahead, and not beyond the window.
    fn next(&self, from: &Station, step: f64) -> Result<(Station, bool), OrbitError> {
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

    /// Follows a curve in one direction, without its first point.
    fn half(&self, start: &Station, options: &BranchOptions) -> Half<Meeting> {
        let (mut half, mut last) = (Half::default(), start.clone());
        let mut step = options.first_step;
        loop {
            if half.points.len() + 1 >= options.most_points {
                let most = options.most_points;
                half.objection = Some(format!("the curve goes on behind {most} points"));
                return half;
            }
            let (next, is_last) = match self.next(&last, step) {
                Ok(found) => found,
                Err(_) if 0.5 * step >= options.shortest_step => {
                    step *= 0.5;
                    continue;
                }
                Err(error) => {
                    let at = &last.point.orbit.parameters;
                    half.objection = Some(format!("the curve breaks off at {at:?}: {error}"));
                    return half;
                }
            };
            let behind = half.points.len() + 1;
            match self.meetings(&last, &next, behind) {
                Ok(meetings) => half.specials.extend(meetings),
                Err(error) => half.objection = Some(format!("a meeting is not located: {error}")),
            }
            let away = &start.point.place - &last.point.place;
            let along = last.tangent.dot(&away);
            let closed = behind > 5
                && (0.0..=step).contains(&along)
                && (away - along * &last.tangent).norm() < 0.2 * step
                && last.tangent.dot(&start.tangent) > 0.9;
            if closed {
                half.closed = true;
                return half;
            }
            let orbit = self.along.orbits.judged(self.along.equations, &next.point.orbit);
            half.points.push(orbit.unwrap_or_else(|_| next.point.orbit.clone()));
            if is_last {
                return half;
            }
            if last.tangent.dot(&next.tangent) > 0.995 {
                step = (1.5 * step).min(options.longest_step);
            }
            last = next;
        }
    }

    /// Where something else changes between two stations.
    fn meetings(
        &self,
        from: &Station,
        to: &Station,
        behind: usize,
    ) -> Result<Vec<Meeting>, OrbitError> {
        let length = from.tangent.dot(&(&to.point.place - &from.point.place));
        let slopes = &from.point.evaluation.slopes;
        let equations = self.along.equations;
        let bordered = |factor: f64| Borders::of(&equations.returning(slopes, factor));
        let mut tests = Vec::new();
        if self.special.kind != SpecialKind::Fold {
            tests.push((SpecialKind::Fold, None, Test::Singular(bordered(1.0))));
        }
        if self.special.kind != SpecialKind::Flip {
            tests.push((SpecialKind::Flip, None, Test::Flip(bordered(-1.0))));
        }
        let own = self.tracked(&from.point)?;
        for segment in 0..from.point.evaluation.ends.len() {
            if !matches!(own, Tracked::Test(Test::Rate(own)) if own == segment) {
                tests.push((SpecialKind::Grazing, Some(segment), Test::Rate(segment)));
            }
        }
        let mut found: Vec<(f64, Meeting)> = Vec::new();
        for (kind, segment, test) in tests {
            let values = (test.value(&self.along, &from.point), test.value(&self.along, &to.point));
            let (Some(one), Some(other)) = values else { continue };
            if (one < 0.0) == (other < 0.0) || other == 0.0 {
                continue;
            }
            let place = zero((length, one, other), |at| {
                let station = self.ahead(from, at, None)?;
                Ok(test.value(&self.along, &station.point).map(|value| (value, station)))
            })?;
            if let Some((at, station)) = place {
                let orbit = self.along.orbits.judged(equations, &station.point.orbit)?;
                found.push((at, Meeting { kind, segment, behind, orbit }));
            }
        }
        found.sort_by(|one, other| one.0.total_cmp(&other.0));
        Ok(found.into_iter().map(|(_, meeting)| meeting).collect())
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
    let unit = null_vectors(&matrix).1;
    let turned = towards.is_some_and(|towards| unit.dot(towards) < 0.0);
    Some(if turned { -unit } else { unit })
}
