//! A guard as a function along a step, and the effect of rounding on it.

use std::marker::PhantomData;

use crate::error::RunError;
use crate::events::isolate::{Curve, Enclosed};
use crate::events::path::Path;
use crate::events::sidestep::{Sidestep, resolution};
use crate::hybrid::Statistics;
use crate::lists::{List, Shape};
use crate::method::{DenseOf, Field, Method, StepOf, Store, TrialOf};
use crate::system::{PerComponent, Room, System};
use stickslip_number::{Enclosure, Interval};

/// The relative change of state and time with which a guard's sensitivity to them is measured.
pub(crate) const SLIGHT: f64 = 1e-12;

/// Values beyond this one are taken for it, so that sums and products of them stay finite.
const LARGEST: f64 = 1e300;

/// The number of patterns of signs by which large states are moved.
const PATTERNS: usize = 8;

/// The change of a guard's value at (`s`, `y`) if time and state change by some units in the last
/// place of `s_scale` and `y_scale`, and the evaluations.
///
/// It is zero if the guard has no value nearby, since nothing is known about it beyond its domain.
pub(crate) fn rounding<S: System>(
    system: &S,
    at: (S::Mode, usize),
    (s, y): (f64, &S::State),
    (s_scale, y_scale): (f64, &S::State),
    room: &mut Room<S>,
) -> (f64, usize) {
    let here = room.value(system, at, s, y);
    let mut change = (room.value(system, at, s + SLIGHT * s_scale.abs(), y) - here).abs();
    let (n, mut count) = (y.size(), 2);
    let mut moved = room.state();
    moved.set(y);
    if n <= S::State::FEW {
        for i in 0..n {
            moved[i] += SLIGHT * y_scale[i].abs();
            change += (room.value(system, at, s, &moved) - here).abs();
            moved[i] = y[i];
            count += 1;
        }
    } else {
        let mut most = 0.0;
        for pattern in 0..PATTERNS {
            for i in 0..n {
                let change = SLIGHT * y_scale[i].abs();
                let down = pattern > 0 && crate::dynamic::scramble(i) >> pattern & 1 == 1;
                moved[i] = y[i] + if down { -change } else { change };
            }
            let change = (room.value(system, at, s, &moved) - here).abs();
            // NaN stays.
            most = if change <= most { most } else { change };
            count += 1;
        }
        change += most;
    }
    room.give(moved);
    (if change.is_finite() { 4.0 * f64::EPSILON / SLIGHT * change } else { 0.0 }, count)
}

/// The sign of a guard's rate at the start of `step`, by the field, or 0 if rounding hides it.
pub(crate) fn start_rate<S: System>(
    system: &S,
    (mode, guard): (S::Mode, usize),
    step: &StepOf<S::State>,
    statistics: &mut Statistics,
    room: &mut Room<S>,
) -> f64 {
    let (s, y) = (step.s, &step.y0);
    let (hidden, count) = rounding(system, (mode, guard), (s, y), (s, y), room);
    let (mut slope, mut moved) = (room.state(), room.state());
    system.field(mode, s, y, &mut slope);
    let start = room.value(system, (mode, guard), s, y);
    statistics.field += 1;
    statistics.guards += count + 1;
    let mut change = |ahead: f64| {
        S::State::shifted(&mut moved, y, &slope, ahead);
        statistics.guards += 1;
        room.value(system, (mode, guard), s + ahead, &moved) - start
    };
    let mut reach = step.h;
    let rate = loop {
        let (far, near) = (change(reach), change(0.5 * reach));
        // NaN is hidden too.
        let shows = near.abs() > 4.0 * hidden;
        if !shows {
            break 0.0;
        }
        if (far - 2.0 * near).abs() <= 0.1 * far.abs() {
            break near.signum();
        }
        reach *= 0.125;
    };
    room.give(slope);
    room.give(moved);
    rate
}

/// The side of its value at the start of `step` on which a guard first shows beyond rounding, or 0
/// if it does not on the step. The flow is followed to the second order.
pub(crate) fn first_side<S: System>(
    system: &S,
    (mode, guard): (S::Mode, usize),
    step: &StepOf<S::State>,
    statistics: &mut Statistics,
    room: &mut Room<S>,
) -> f64 {
    let (s, y) = (step.s, &step.y0);
    let (hidden, count) = rounding(system, (mode, guard), (s, y), (s, y), room);
    let (mut slope, mut ahead, mut moved) = (room.state(), room.state(), room.state());
    system.field(mode, s, y, &mut slope);
    let start = room.value(system, (mode, guard), s, y);
    statistics.field += 1;
    statistics.guards += count + 1;
    let mut reach = f64::EPSILON * s.abs().max(step.h);
    let mut side = 0.0;
    while reach <= step.h && side == 0.0 {
        flow::<S>((system, mode), (s, y, &slope), reach, (&mut moved, &mut ahead));
        let change = room.value(system, (mode, guard), s + reach, &moved) - start;
        statistics.field += 1;
        statistics.guards += 1;
        if change.abs() > 4.0 * hidden {
            side = change.signum();
        }
        reach *= 4.0;
    }
    room.give(slope);
    room.give(ahead);
    room.give(moved);
    side
}

/// Follows the flow from (`s`, `y`), where it has this `slope`, over a time to the second order. It
/// writes the state to `moved` and leaves its slope in `ahead`.
pub(crate) fn flow<S: System>(
    (system, mode): (&S, S::Mode),
    (s, y, slope): (f64, &S::State, &S::State),
    by: f64,
    (moved, ahead): (&mut S::State, &mut S::State),
) {
    S::State::shifted(moved, y, slope, by);
    system.field(mode, s + by, moved, ahead);
    moved.shift(ahead, 0.5 * by);
    moved.shift(slope, -0.5 * by);
}

/// The sizes of time and state whose rounding counts at a place (`s`, `y`) of `step`: the largest
/// on the step, since sums of such terms lead there.
pub(crate) fn scales<V: Store>(step: &StepOf<V>, s: f64, y: &V, scale: &mut V) -> f64 {
    let [a, b, c, d] = &step.interior;
    V::each(scale, [y, &step.y0, a, b, c, d], |_, values| {
        values.into_iter().fold(0.0, |most: f64, value| most.max(value.abs()))
    });
    s.abs().max(step.s.abs())
}

/// Writes the dense output over a step taken in `mode`.
///
/// All callers share this one function, because what it compiles to is large.
#[inline(never)]
pub(crate) fn dense_output<S: System, M: Method>(
    system: &S,
    mode: S::Mode,
    step: &mut StepOf<S::State>,
    dense: &mut DenseOf<S::State>,
) {
    // Dispatched at run time, so that it is compiled once for each method and dimension.
    let mut field: &mut Field<'_, S::State> = &mut |s, y, slope| system.field(mode, s, y, slope);
    step.dense_in_place::<M>(&mut field, dense);
}

/// The step `trial` in `mode`, taken again to look at the solution more closely.
///
/// All callers share this one function, apart from the step of the run itself, because what it
/// compiles to is large.
#[inline(never)]
pub(crate) fn repeated_step<S: System, M: Method>(
    system: &S,
    mode: S::Mode,
    trial: &TrialOf<'_, S::State>,
    statistics: &mut Statistics,
    room: &mut Room<S>,
) -> StepOf<S::State> {
    statistics.resteps += 1;
    statistics.field += M::STAGES - 1 + usize::from(M::ERROR_USES_END);
    let mut step = room.step();
    system.step::<M>(mode, trial, &mut step);
    step
}

/// A guard as a function along a step, for isolation.
pub(crate) struct AlongStep<'a, S: System, M> {
    pub(crate) system: &'a S,
    pub(crate) mode: S::Mode,
    pub(crate) guard: usize,
    pub(crate) sign: f64,
    pub(crate) step: &'a StepOf<S::State>,
    pub(crate) dense: &'a DenseOf<S::State>,
    pub(crate) statistics: &'a mut Statistics,
    pub(crate) room: &'a mut Room<S>,
    pub(crate) method: PhantomData<M>,
}

impl<S: System, M: Method> AlongStep<'_, S, M> {
    fn value(&mut self, theta: f64, y: &S::State) -> f64 {
        self.statistics.guards += 1;
        let s = self.step.s + theta * self.step.h;
        let value = self.room.value(self.system, (self.mode, self.guard), s, y);
        self.sign * value.clamp(-LARGEST, LARGEST)
    }

    /// Bounds of the guard from bounds of time and state.
    fn enclose(&mut self, (s, y): (Enclosure, PerComponent<S, Enclosure>)) -> Enclosure {
        self.statistics.enclosures += 1;
        let bounds = self.system.enclose(self.mode, s, &y)[self.guard];
        if self.sign < 0.0 { -bounds } else { bounds }
    }

    /// The state by a step of the method to `theta`.
    fn state_at(&mut self, theta: f64) -> StepOf<S::State> {
        let shorter = self.step.shortened(theta * self.step.h);
        repeated_step::<S, M>(self.system, self.mode, &shorter, self.statistics, self.room)
    }

    /// `theta`, or a place beside it if the guard has no value there, with the state by a step of
    /// the method and the guard's value.
    fn step_to(&mut self, theta: f64) -> Result<(f64, StepOf<S::State>, f64), RunError> {
        let step = self.step;
        let mut sidestep = Sidestep::new(self.guard, step.s, resolution(step.s, step.h));
        let mut place = theta;
        loop {
            let state = self.state_at(place);
            let value = self.value(place, &state.y1);
            if !value.is_nan() {
                return Ok((place, state, value));
            }
            self.room.give_step(state);
            place = sidestep.of(theta)?;
        }
    }
}

impl<S: System, M: Method> Curve for AlongStep<'_, S, M> {
    fn dense(&mut self, theta: f64) -> f64 {
        let mut y = self.room.state();
        self.dense.write(theta, &mut y);
        let value = self.value(theta, &y);
        self.room.give(y);
        value
    }

    fn coarse(&mut self, theta: f64) -> f64 {
        let mut y = self.room.state();
        self.dense.write_coarse(theta, &mut y);
        let value = self.value(theta, &y);
        self.room.give(y);
        value
    }

    fn rounding(&mut self) -> (f64, f64) {
        let [start, middle, end] = [0.0, 0.5, 1.0].map(|theta| {
            let s = self.step.s + theta * self.step.h;
            let mut y = self.room.state();
            self.dense.write(theta, &mut y);
            let at = (self.mode, self.guard);
            let (effect, count) = rounding(self.system, at, (s, &y), (s, &y), self.room);
            self.statistics.guards += count;
            self.room.give(y);
            effect
        });
        (start, start.max(middle).max(end))
    }

    fn start_rate(&mut self) -> f64 {
        let at = (self.mode, self.guard);
        self.sign * start_rate(self.system, at, self.step, self.statistics, self.room)
    }

    fn truth(&mut self, theta: f64) -> Result<f64, RunError> {
        let (_, step, value) = self.step_to(theta)?;
        self.room.give_step(step);
        Ok(value)
    }
}

/// A guard of a readable system along a step.
pub(crate) struct EnclosedAlongStep<'a, S: System, M> {
    pub(crate) along: AlongStep<'a, S, M>,
    /// The path along the dense output.
    pub(crate) path: Path<S::Components>,
    /// The path on the part of the step that is looked at more closely.
    pub(crate) local: Option<Path<S::Components>>,
}

impl<S: System, M: Method> Enclosed for EnclosedAlongStep<'_, S, M> {
    fn over(&mut self, low: f64, high: f64) -> Enclosure {
        let path = self.local.as_ref().unwrap_or(&self.path);
        self.along.enclose(path.part(low, high).whole(path))
    }

    fn bounds(&mut self, low: f64, high: f64) -> (Enclosure, Enclosure) {
        let path = self.local.as_ref().unwrap_or(&self.path);
        let part = path.part(low, high);
        let plain = self.along.enclose(part.whole(path));
        if plain.value.sign() != 0.0 {
            return (plain, plain);
        }
        let centre = self.along.enclose(part.centre(path));
        if !plain.slope.is_bounded() {
            return (plain, centre);
        }
        (plain.about(&centre, 0.5 * (high - low)), centre)
    }

    fn truth(&mut self, theta: f64) -> Result<(f64, Interval), RunError> {
        let (theta, y, value) = self.along.step_to(theta)?;
        let AlongStep { system, mode, guard, sign, step, .. } = self.along;
        let s = Enclosure::from(step.s + theta * step.h);
        let read = system.reads(mode);
        let n = S::Components::count(&read, y.y1.size());
        let state = List::made(n, |i| Enclosure::from(y.y1[S::Components::place(&read, i)]));
        let bounds = system.enclose(mode, s, &state)[guard].value;
        self.along.room.give_step(y);
        Ok((value, if sign < 0.0 { bounds.negated() } else { bounds }))
    }

    fn at(&mut self, theta: f64) -> f64 {
        self.along.dense(theta)
    }

    fn refine(&mut self, low: f64, high: f64) -> Result<Option<bool>, RunError> {
        let AlongStep { system, mode, step, .. } = self.along;
        let (middle, reach) = (0.5 * (low + high), 0.5 * (high - low) * step.h);
        let end = self.along.state_at(middle);
        let y = &end.y1;
        let s = step.s + middle * step.h;
        let room = &mut *self.along.room;
        let (mut slope, mut moved) = (room.state(), room.state());
        let (mut ahead, mut bend) = (room.state(), room.state());
        system.field(mode, s, y, &mut slope);
        S::State::shifted(&mut moved, y, &slope, reach);
        system.field(mode, s + reach, &moved, &mut ahead);
        S::State::shifted(&mut moved, y, &slope, -reach);
        system.field(mode, s - reach, &moved, &mut bend);
        S::State::each(&mut bend, [&ahead], |behind, [ahead]| (ahead - behind) / (2.0 * reach));
        self.along.statistics.field += 3;
        let local = self.path.local((low, high), [y, &slope, &bend].map(Store::parts));
        let room = &mut *self.along.room;
        for state in [slope, moved, ahead, bend] {
            room.give(state);
        }
        room.give_step(end);
        Ok(local.map(|(local, exact)| {
            self.local = Some(local);
            exact
        }))
    }

    fn widen(&mut self) {
        self.local = None;
    }
}
