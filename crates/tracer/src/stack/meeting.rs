//! Where codimension-2 points meet: the place, and the value of the third parameter.

use std::convert::Infallible;

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

use crate::conditions::{self, Limits, Unsolved, Zero};
use crate::family::Family;
use crate::inverse;
use crate::lengths::of_stack::{LONG_STEP, PASSAGE, STEP, STRIDE};
use crate::lengths::{Lengths, angle};
use crate::stack::conditions::{Condition, Conditions, MeetingKind};
use crate::window::{Point, Window};

/// A place in the plane and a value of the third parameter at which codimension-2 points meet.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StackMeeting {
    /// What happens.
    pub kind: MeetingKind,
    /// The value of the third parameter.
    pub value: f64,
    /// The place in the plane.
    pub point: Point,
}

/// The window, and the values of the third parameter between which a meeting is searched. Unknowns
/// are parts of these.
#[derive(Clone, Copy, Debug)]
pub(super) struct Box3 {
    pub window: Window,
    pub values: [f64; 2],
}

impl Box3 {
    fn unknowns(&self, point: &Point, value: f64) -> Vector3<f64> {
        let place = (point - self.window.low).component_div(&self.window.extent());
        let [low, high] = self.values;
        Vector3::new(place.x, place.y, (value - low) / (high - low))
    }

    fn point(&self, unknowns: &Vector3<f64>) -> Point {
        self.window.low + unknowns.xy().component_mul(&self.window.extent())
    }

    fn value(&self, unknowns: &Vector3<f64>) -> f64 {
        let [low, high] = self.values;
        low + (high - low) * unknowns.z
    }

    /// Whether the family is defined there: up to a hundredth of the window beyond its edges.
    fn is_defined(unknowns: &Vector3<f64>) -> bool {
        let beyond = Lengths::PARTS.beyond;
        unknowns.xy().iter().all(|part| (-beyond..=1.0 + beyond).contains(part))
    }
}

/// The place and the value near a guess at which the conditions hold; `None` if there is none in
/// the box, or if a margin ceases to exist on the way.
pub(super) fn solve<F: Family>(
    family: &impl Fn(f64) -> F,
    conditions: Conditions<F::Margin>,
    guess: (Point, f64),
    within: &Box3,
) -> Option<Solved<F::Margin>> {
    newton(family, conditions, within.unknowns(&guess.0, guess.1), within)
}

/// What a search for a meeting finds.
pub(super) enum Solved<Margin> {
    /// A meeting.
    Sure(StackMeeting),
    /// A place at which a meeting may be.
    Vague(Vague<Margin>),
}

/// A place at which conditions nearly hold that nearly depend on each other there.
pub(super) struct Vague<Margin> {
    conditions: Conditions<Margin>,
    at: Vector3<f64>,
}

/// The meeting close to a vague place at which two of its boundaries touch.
///
/// Some boundaries touch for every value of the third parameter, as a graze does with the end at
/// which it leaves. There the values of margins determine the place to half the digits. The angle
/// between the two boundaries determines it to about 1e-6.
pub(super) fn touching<F: Family>(
    family: &impl Fn(f64) -> F,
    vague: &Vague<F::Margin>,
    within: &Box3,
) -> Option<StackMeeting> {
    let conditions = tangent(family, &vague.conditions, &vague.at, within)?;
    match newton(family, conditions, vague.at, within)? {
        Solved::Sure(meeting) => Some(meeting),
        Solved::Vague(_) => None,
    }
}

/// The meeting at a place, if that is in the box.
fn meeting(kind: MeetingKind, at: &Vector3<f64>, within: &Box3) -> Option<StackMeeting> {
    let slack = Lengths::PARTS.piece;
    let inside = at.xy().iter().all(|part| (-slack..=1.0 + slack).contains(part))
        && at.z > 0.0
        && at.z < 1.0;
    // On the edge of the window, the place is beside it by rounding.
    let at = at.map(|part| part.clamp(0.0, 1.0));
    inside.then(|| StackMeeting { kind, value: within.value(&at), point: within.point(&at) })
}

fn newton<F: Family>(
    family: &impl Fn(f64) -> F,
    mut conditions: Conditions<F::Margin>,
    start: Vector3<f64>,
    within: &Box3,
) -> Option<Solved<F::Margin>> {
    let Lengths { half, least, .. } = Lengths::PARTS;
    let limits = Limits::new(f64::INFINITY, least);
    let limits = Limits { stride: STRIDE, square: half, retreat: half, rounds: 30, ..limits };
    let Ok(found) = conditions::solve(&start, &limits, |at, _| {
        at.z = at.z.clamp(0.0, 1.0);
        if !Box3::is_defined(at) {
            return Ok::<_, Infallible>(None);
        }
        conditions.move_to(&family(within.value(at)), &within.point(at));
        let values = residuals(family, &conditions, at, within);
        Ok(values.map(|values| (values, slopes(family, &conditions, at, within))))
    });
    match found {
        Ok(Zero { at, slopes, .. }) if independent(&slopes) => {
            let meets = is_passage(family, &conditions, (&at, &slopes), within);
            meets.then(|| meeting(conditions.kind, &at, within))?.map(Solved::Sure)
        }
        Err(Unsolved::Slow { update, .. }) if update >= LONG_STEP => None,
        Ok(Zero { at, .. }) | Err(Unsolved::Slow { at, .. }) => {
            Some(Solved::Vague(Vague { conditions, at }))
        }
        Err(_) => None,
    }
}

/// Whether the third of three conditions passes through zero where the first two hold, as its slope
/// says, when the third parameter passes.
///
/// A margin behind a graze may vanish wherever two others do, for every value of the parameter. If
/// it is singular there, its slope does not show this.
fn is_passage<F: Family>(
    family: &impl Fn(f64) -> F,
    conditions: &Conditions<F::Margin>,
    (at, slopes): (&Vector3<f64>, &Matrix3<f64>),
    within: &Box3,
) -> bool {
    if !conditions.are_boundaries() {
        return true;
    }
    let mut agreements = [0, 0];
    for third in 0..3 {
        let pair = [(third + 1) % 3, (third + 2) % 3];
        let [in_x, in_y, in_z] =
            [0, 1, 2].map(|axis| Vector2::from(pair.map(|index| slopes[(index, axis)])));
        let Some(inverse) = inverse::of_two(&Matrix2::from_columns(&[in_x, in_y])) else {
            continue;
        };
        let along = (-inverse * in_z).push(1.0);
        for change in [-PASSAGE, PASSAGE] {
            let mut place = at + along * change;
            let expected = (slopes.row(third) * along)[0] * change;
            let mut found = None;
            for _ in 0..8 {
                let inside = (0.0..=1.0).contains(&place.z);
                let values = inside.then(|| residuals(family, conditions, &place, within));
                let Some(values) = values.flatten() else {
                    found = None;
                    break;
                };
                let update = inverse * Vector2::new(values[pair[0]], values[pair[1]]);
                if update.norm() < 1e-3 * (along * change).norm() {
                    found = Some(values[third]);
                }
                place -= update.push(0.0);
            }
            if let Some(value) = found {
                let part = value / expected;
                agreements[usize::from((0.1..10.0).contains(&part))] += 1;
            }
        }
    }
    agreements[0] <= agreements[1]
}

/// The conditions for a touch of those two of three margins whose boundaries are nearly parallel.
fn tangent<F: Family>(
    family: &impl Fn(f64) -> F,
    conditions: &Conditions<F::Margin>,
    at: &Vector3<f64>,
    within: &Box3,
) -> Option<Conditions<F::Margin>> {
    if !conditions.are_boundaries() {
        return None;
    }
    let here = Here { family: &family(within.value(at)), within };
    let gradients = conditions.three.each_ref().map(|one| here.gradient(one, at));
    let pairs = [[0, 1], [1, 0], [0, 2], [2, 0], [1, 2], [2, 1]].into_iter().filter_map(|pair| {
        let [one, other] = pair.map(|index| gradients[index]);
        Some((one?.normalize().perp(&other?.normalize()).abs(), pair))
    });
    let (sine, pair) = pairs.min_by(|one, other| one.0.total_cmp(&other.0))?;
    (sine < angle::PARALLEL).then(|| conditions.touching(pair))
}

/// Whether conditions with these derivatives hold at one point only, and not along a curve.
fn independent(slopes: &Matrix3<f64>) -> bool {
    let mut unit = *slopes;
    for mut row in unit.row_iter_mut() {
        row.normalize_mut();
    }
    for mut column in unit.column_iter_mut() {
        column.normalize_mut();
    }
    unit.determinant().abs() > angle::PLANE
}

/// The derivatives of the residuals, by differences.
fn slopes<F: Family>(
    family: &impl Fn(f64) -> F,
    conditions: &Conditions<F::Margin>,
    at: &Vector3<f64>,
    within: &Box3,
) -> Option<Matrix3<f64>> {
    let step = if conditions.are_values() { STEP } else { LONG_STEP };
    let mut columns = [Vector3::zeros(); 3];
    for (axis, column) in columns.iter_mut().enumerate() {
        let along = Vector3::ith(axis, 1.0);
        let residuals = |from: &Vector3<f64>| residuals(family, conditions, from, within);
        *column = difference(at, &along, step, axis == 2, residuals)?;
    }
    Some(Matrix3::from_columns(&columns))
}

/// A derivative of `values` along a direction: central, or one-sided of second order where they
/// exist on one side only. The third unknown stays between 0 and 1 if `bounded`.
fn difference(
    at: &Vector3<f64>,
    along: &Vector3<f64>,
    step: f64,
    bounded: bool,
    values: impl Fn(&Vector3<f64>) -> Option<Vector3<f64>>,
) -> Option<Vector3<f64>> {
    let value = |length: f64| {
        let place = at + along * length;
        let allowed = !bounded || (0.0..=1.0).contains(&place.z);
        allowed.then(|| values(&place)).flatten()
    };
    match (value(-step), value(step)) {
        (Some(behind), Some(ahead)) => Some((ahead - behind) / (2.0 * step)),
        (behind, ahead) => {
            let sign = if ahead.is_some() { 1.0 } else { -1.0 };
            let (near, far) = (ahead.or(behind)?, value(2.0 * sign * step)?);
            Some((4.0 * near - 3.0 * value(0.0)? - far) * (sign / (2.0 * step)))
        }
    }
}

/// The family at a value of the third parameter.
struct Here<'a, F> {
    family: &'a F,
    within: &'a Box3,
}

impl<F: Family> Here<'_, F> {
    /// The value of a condition.
    fn value(&self, condition: &Condition<F::Margin>, at: &Vector3<f64>) -> Option<f64> {
        match condition {
            Condition::Margin(_) if !Box3::is_defined(at) => None,
            Condition::Margin(margin) => {
                let value = self.family.margin(&self.within.point(at), margin).ok().flatten();
                value.filter(|value| value.is_finite())
            }
            Condition::CurveSide(0) => Some(at.y),
            Condition::CurveSide(1) => Some(1.0 - at.x),
            Condition::CurveSide(2) => Some(1.0 - at.y),
            Condition::CurveSide(_) => Some(at.x),
            Condition::Angle(two) => {
                let [one, other] = two.each_ref().map(|condition| self.gradient(condition, at));
                Some(one?.normalize().perp(&other?.normalize()))
            }
            Condition::Slope(margin, axis) => {
                self.slope(&Condition::Margin(margin.clone()), *axis, at)
            }
        }
    }

    /// Its slope along an axis, by differences.
    fn slope(
        &self,
        condition: &Condition<F::Margin>,
        axis: usize,
        at: &Vector3<f64>,
    ) -> Option<f64> {
        let value = |at: &Vector3<f64>| Some(Vector3::new(self.value(condition, at)?, 0.0, 0.0));
        Some(difference(at, &Vector3::ith(axis, 1.0), STEP, false, value)?.x)
    }

    /// Its gradient in the plane.
    fn gradient(&self, condition: &Condition<F::Margin>, at: &Vector3<f64>) -> Option<Point> {
        Some(Point::new(self.slope(condition, 0, at)?, self.slope(condition, 1, at)?))
    }
}

/// What has to vanish.
fn residuals<F: Family>(
    family: &impl Fn(f64) -> F,
    conditions: &Conditions<F::Margin>,
    at: &Vector3<f64>,
    within: &Box3,
) -> Option<Vector3<f64>> {
    let here = Here { family: &family(within.value(at)), within };
    let [one, two, three] = conditions.three.each_ref().map(|one| here.value(one, at));
    Some(Vector3::new(one?, two?, three?))
}
