//! Where codimension-2 points meet: the place, and the value of the third parameter.

use nalgebra::{Matrix3, Vector3};

use crate::family::Family;
use crate::window::{Point, Window};

/// What vanishes at a codimension-2 point.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Condition<Margin> {
    /// A margin.
    Margin(Margin),
    /// The distance from a side of the window, counterclockwise from the lower one.
    Side(usize),
}

/// Three conditions for a place in the plane and a value of the third parameter.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Conditions<Margin> {
    /// All three vanish.
    Three([Condition<Margin>; 3]),
    /// Both vanish, and their gradients in the plane are parallel.
    Parallel([Condition<Margin>; 2]),
    /// A margin vanishes together with its gradient in the plane.
    Flat(Margin),
}

/// What happens at a value of the third parameter where the structure changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeetingKind {
    /// Three boundaries pass through one point.
    Crossing,
    /// Two boundaries touch.
    Touch,
    /// A boundary shrinks to a point, or two parts of it reconnect.
    Flat,
    /// Two boundaries cross on the edge of the window.
    Edge,
    /// A boundary touches the edge of the window.
    EdgeTouch,
    /// A boundary passes through a corner of the window.
    Corner,
}

/// A place in the plane and a value of the third parameter at which codimension-2 points meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting {
    /// What happens.
    pub kind: MeetingKind,
    /// The value of the third parameter.
    pub value: f64,
    /// The place in the plane.
    pub point: Point,
}

impl<Margin: Clone + PartialEq> Conditions<Margin> {
    /// The conditions for the ends of a stretch of the arrangement to meet: what vanishes along it,
    /// and what else vanishes at its ends.
    pub fn of(along: &Condition<Margin>, ends: [&Condition<Margin>; 2]) -> Self {
        let [first, second] = ends;
        if first == second {
            Self::Parallel([along.clone(), first.clone()])
        } else {
            Self::Three([along, first, second].map(Clone::clone))
        }
    }

    /// What happens where the conditions hold.
    pub fn kind(&self) -> MeetingKind {
        let sides = |conditions: &[Condition<Margin>]| {
            conditions.iter().filter(|one| matches!(one, Condition::Side(_))).count()
        };
        match self {
            Self::Three(conditions) => match sides(conditions) {
                0 => MeetingKind::Crossing,
                1 => MeetingKind::Edge,
                _ => MeetingKind::Corner,
            },
            Self::Parallel(conditions) if sides(conditions) == 0 => MeetingKind::Touch,
            Self::Parallel(_) => MeetingKind::EdgeTouch,
            Self::Flat(_) => MeetingKind::Flat,
        }
    }

    fn each_margin(&mut self, mut change: impl FnMut(&mut Margin)) {
        let mut all = |conditions: &mut [Condition<Margin>]| {
            for condition in conditions {
                if let Condition::Margin(margin) = condition {
                    change(margin);
                }
            }
        };
        match self {
            Self::Three(conditions) => all(conditions),
            Self::Parallel(conditions) => all(conditions),
            Self::Flat(margin) => change(margin),
        }
    }
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
}

/// A step of a difference of values, as a part of the box. If values have an error of 1e-14, the
/// slope is good to 1e-9.
const STEP: f64 = 1e-5;
/// A step of a difference of slopes.
const LONG_STEP: f64 = 1e-3;

/// The place and the value near a guess at which the conditions hold, by Newton's method in all
/// three unknowns; `None` if there is none in the box, or if a margin ceases to exist on the way.
pub(super) fn solve<F: Family>(
    family: &impl Fn(f64) -> F,
    mut conditions: Conditions<F::Margin>,
    guess: (Point, f64),
    within: &Box3,
) -> Option<Meeting> {
    /// Updates below this part of the box end the search: the next one would be its square.
    const SMALL: f64 = 1e-7;
    let kind = conditions.kind();
    let mut at = within.unknowns(&guess.0, guess.1);
    let mut update = Vector3::zeros();
    for _ in 0..30 {
        let Some(values) = residuals(family, &conditions, &at, within) else {
            // A margin does not exist here, as at the far side of the boundary where it ends.
            update *= 0.5;
            at += update;
            at.z = at.z.clamp(0.0, 1.0);
            if update.norm() < SMALL {
                return None;
            }
            continue;
        };
        let slopes = slopes(family, &conditions, &at, within)?;
        update = slopes.try_inverse()? * values;
        let size = update.norm();
        let finite = size.is_finite();
        if !finite {
            return None;
        }
        // A long step is only a direction.
        update *= (0.2 / size).min(1.0);
        at -= update;
        at.z = at.z.clamp(0.0, 1.0);
        let inside = at.xy().iter().all(|part| (-0.3..=1.3).contains(part));
        if !inside {
            return None;
        }
        if size < SMALL {
            let inside = at.xy().iter().all(|part| (-1e-6..=1.0 + 1e-6).contains(part))
                && at.z > 0.0
                && at.z < 1.0;
            // On the edge of the window, the place is beside it by rounding.
            at = at.map(|part| part.clamp(0.0, 1.0));
            let (value, point) = (within.value(&at), within.point(&at));
            return inside.then_some(Meeting { kind, value, point });
        }
        let here = family(within.value(&at));
        let point = within.point(&at);
        // Names of margins may tell minima apart by their places, which move along.
        conditions.each_margin(|margin| {
            if let Ok(moved) = here.moved(&point, margin) {
                *margin = moved;
            }
        });
    }
    None
}

/// The derivatives of the residuals, by differences.
fn slopes<F: Family>(
    family: &impl Fn(f64) -> F,
    conditions: &Conditions<F::Margin>,
    at: &Vector3<f64>,
    within: &Box3,
) -> Option<Matrix3<f64>> {
    let step = if matches!(conditions, Conditions::Three(_)) { STEP } else { LONG_STEP };
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

/// What has to vanish.
fn residuals<F: Family>(
    family: &impl Fn(f64) -> F,
    conditions: &Conditions<F::Margin>,
    at: &Vector3<f64>,
    within: &Box3,
) -> Option<Vector3<f64>> {
    let here = family(within.value(at));
    let value = |condition: &Condition<F::Margin>, at: &Vector3<f64>| match condition {
        Condition::Margin(margin) => {
            here.margin(&within.point(at), margin).ok().flatten().filter(|value| value.is_finite())
        }
        Condition::Side(0) => Some(at.y),
        Condition::Side(1) => Some(1.0 - at.x),
        Condition::Side(2) => Some(1.0 - at.y),
        Condition::Side(_) => Some(at.x),
    };
    let gradient = |condition: &Condition<F::Margin>| {
        let value =
            |at: &Vector3<f64>| value(condition, at).map(|value| Vector3::new(value, 0.0, 0.0));
        let slope = |axis| Some(difference(at, &Vector3::ith(axis, 1.0), STEP, false, value)?.x);
        Some(Point::new(slope(0)?, slope(1)?))
    };
    match conditions {
        Conditions::Three([one, two, three]) => {
            Some(Vector3::new(value(one, at)?, value(two, at)?, value(three, at)?))
        }
        Conditions::Parallel([one, two]) => {
            let sine = gradient(one)?.normalize().perp(&gradient(two)?.normalize());
            Some(Vector3::new(value(one, at)?, value(two, at)?, sine))
        }
        Conditions::Flat(margin) => {
            let margin = Condition::Margin(margin.clone());
            let gradient = gradient(&margin)?;
            Some(Vector3::new(value(&margin, at)?, gradient.x, gradient.y))
        }
    }
}
