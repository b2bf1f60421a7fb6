//! By how much rounding may move the place of an event, and hide what a guard is there.
//!
//! What follows at an instant is as uncertain as its time. Where a guard ends up near zero, the run
//! asks what it would be if the instant had come later by the rounding of its time: the state there
//! is moved along the flow, and everything acts on it that has acted. A guard that is no farther
//! from zero than this stands on its zero.

use crate::events::along_step::{rounding, scales};
use crate::events::arrival::HERE;
use crate::events::event::{Crossed, Event};
use crate::events::examination::Examination;
use crate::events::isolate::noise;
use crate::events::phase::{digit, near_zero};
use crate::hybrid::Statistics;
use crate::method::{StepOf, Store};
use crate::system::{Room, System};

/// A guard is zero at an event if its value there is below this part of its values before.
pub(crate) const TOGETHER: f64 = 1e-12;
/// The part of a step on which the noise of a guard is measured.
const CLOSE: f64 = 1e-6;
/// The part of that way on which a guard must change.
const STAIRS: f64 = 64.0;
/// The ratio of ways that have no measure in common.
const UNEVEN: f64 = 1.618;
/// The part of what surely exceeds noise that it may well be.
const PART: f64 = 0.25;
/// How much more than one step's rounding may have added up in the state, from step to step and
/// from event to event.
pub(crate) const ADDED: f64 = 2.0;
/// A guard has left what rounding hides if it has changed by so many times that much.
const LEAVES: f64 = 64.0;
/// The longest part of a usual step over which that is tried.
const FARTHEST: f64 = 1e-3;

impl<S: System> Examination<'_, S> {
    /// The error of the place of an event: how far rounding of time and state, and the value that
    /// is left of the guard, move its zero.
    pub(crate) fn error_of(&mut self, event: &Event<S>) -> f64 {
        let place = (&event.step, event.elapsed, &event.state);
        self.error_at((event.guard, event.own()), place, event.residual)
    }

    /// The error of the place where a guard has crossed zero up to a `residual`.
    pub(crate) fn error_at(
        &mut self,
        (guard, Crossed { slope, .. }): (usize, Crossed),
        place: (&StepOf<S::State>, f64, &S::State),
        residual: f64,
    ) -> f64 {
        let drift = self.drift(place.1);
        // What seems to be a jump may be a stair of rounding.
        if place.1 == 0.0 {
            return drift;
        }
        let hidden = self.hidden_at(guard, place);
        let slope = self.slope_beyond(guard, place, (hidden, slope));
        drift + error(hidden, residual, slope)
    }

    /// By how much rounding may have moved a time on the step.
    pub(crate) fn drift(&self, elapsed: f64) -> f64 {
        self.drift + 5.0 * f64::EPSILON * elapsed
    }

    /// By how much rounding may have moved a time on the step, of time and state.
    fn blur(&self, elapsed: f64) -> f64 {
        self.drift(elapsed) + digit(self.trial.y, self.trial.slope)
    }

    /// The time within which guards may belong to the instant of an event. Whether they do, their
    /// errors say.
    pub(crate) fn together(&self, elapsed: f64, h: f64) -> f64 {
        (TOGETHER * h).max(HERE * self.blur(elapsed))
    }

    /// The part of a guard's largest value below which it may be zero. In a phase that is hardly
    /// longer than rounding of time, it hides more.
    pub(crate) fn near_zero(&self, elapsed: f64) -> f64 {
        near_zero(self.blur(elapsed), elapsed)
    }

    /// What shows how far rounding hides a guard.
    fn doubt(&mut self, guard: usize) -> Doubt<'_, S> {
        let (system, at, usual) = (self.system, (self.phase.mode, guard), self.usual);
        Doubt { system, at, usual, statistics: self.statistics, room: self.room }
    }

    /// The slope of a guard where it leaves what rounding hides.
    pub(crate) fn slope_beyond(
        &mut self,
        guard: usize,
        (step, elapsed, y): (&StepOf<S::State>, f64, &S::State),
        (hidden, guess): (f64, f64),
    ) -> f64 {
        self.doubt(guard).slope_beyond((step.s + elapsed, y), elapsed, (hidden, guess))
    }

    /// The effect of rounding on a guard at a place of `step`: of time and state, and within the
    /// guard.
    pub(crate) fn hidden_at(
        &mut self,
        guard: usize,
        (step, elapsed, y): (&StepOf<S::State>, f64, &S::State),
    ) -> f64 {
        let (s, mut scale) = (step.s + elapsed, self.room.state());
        let s_scale = scales(step, s, y, &mut scale);
        let hidden = self.doubt(guard).hidden((s, y), (s_scale, &scale));
        self.room.give(scale);
        hidden
    }
}

/// What shows how far rounding hides a guard of a mode.
pub(crate) struct Doubt<'a, S: System> {
    pub(crate) system: &'a S,
    /// The mode and the guard.
    pub(crate) at: (S::Mode, usize),
    /// The size of a step that nothing cuts.
    pub(crate) usual: f64,
    pub(crate) statistics: &'a mut Statistics,
    pub(crate) room: &'a mut Room<S>,
}

impl<S: System> Doubt<'_, S> {
    /// The slope of the guard where it leaves what rounding hides. Over a longer way, it may be
    /// quite another one, such as the one that is taken for a `guess`.
    fn slope_beyond(
        &mut self,
        (s, y): (f64, &S::State),
        elapsed: f64,
        (hidden, guess): (f64, f64),
    ) -> f64 {
        let (system, at) = (self.system, self.at);
        let (mut moved, mut rate) = (self.room.state(), self.room.state());
        system.field(at.0, s, y, &mut rate);
        self.statistics.field += 1;
        let mut difference = |reach: f64| {
            let mut value = |ahead: f64| {
                S::State::shifted(&mut moved, y, &rate, ahead);
                self.statistics.guards += 1;
                self.room.value(system, at, s + ahead, &moved)
            };
            ((value(reach) - value(-reach)) / (2.0 * reach)).abs()
        };
        let (mut slope, longest) = (guess.abs(), FARTHEST * self.usual);
        // Where rounding has hidden all change on the way of the guess, a longer one shows it.
        let mut reach = elapsed;
        while slope == 0.0 && reach > 0.0 {
            let (seen, last) = (difference(reach), 16.0 * reach > self.usual);
            slope = if last || seen * reach > LEAVES * hidden { seen } else { 0.0 };
            reach *= if last { 0.0 } else { 16.0 };
        }
        reach = LEAVES * hidden / slope;
        while reach > 0.0 && reach <= longest {
            let seen = difference(reach);
            // NaN ends the search.
            if seen.is_nan() || seen >= 0.5 * slope {
                break;
            }
            slope = seen.max(slope / LEAVES);
            reach = LEAVES * hidden / slope;
        }
        self.room.give(moved);
        self.room.give(rate);
        slope
    }

    /// The error of a place where the guard has crossed zero with this `slope`, beyond that of
    /// time.
    pub(crate) fn error(&mut self, (s, y): (f64, &S::State), slope: f64) -> f64 {
        let hidden = self.hidden((s, y), (s.abs(), y));
        let residual = self.room.value(self.system, self.at, s, y).abs();
        let slope = self.slope_beyond((s, y), self.usual, (hidden, slope));
        self.statistics.guards += 1;
        error(hidden, residual, slope)
    }

    /// The effect of rounding on the guard: of time and state, whose sizes are given, and within
    /// the guard.
    fn hidden(&mut self, (s, y): (f64, &S::State), (s_scale, scale): (f64, &S::State)) -> f64 {
        let (system, at) = (self.system, self.at);
        let (hidden, count) = rounding(system, at, (s, y), (s_scale, scale), self.room);
        self.statistics.guards += count;
        let (mut slope, mut moved) = (self.room.state(), self.room.state());
        system.field(at.0, s, y, &mut slope);
        self.statistics.field += 1;
        let (room, statistics) = (&mut *self.room, &mut *self.statistics);
        let mut value = |ahead: f64| {
            S::State::shifted(&mut moved, y, &slope, ahead);
            statistics.guards += 1;
            room.value(system, at, s + ahead, &moved)
        };
        let mut reach = (CLOSE * self.usual).max(256.0 * f64::EPSILON * s.abs());
        // Rounding makes stairs of a guard. On one of them it seems to be without noise.
        let (here, mut stair) = (value(0.0), 0.0);
        while reach < self.usual {
            let ends = [value(reach / STAIRS), value(-reach / STAIRS)];
            if !ends.contains(&here) {
                break;
            }
            stair = 0.5 * (ends[0] - ends[1]).abs();
            reach *= 2.0;
        }
        // Places that are whole numbers of stairs apart show none.
        let ways = [1.0, UNEVEN, UNEVEN * UNEVEN].map(|factor| factor * reach);
        let noises = ways.map(|way| PART * noise(&mut value, -way, way, [0.0]));
        self.room.give(moved);
        self.room.give(slope);
        noises.into_iter().fold(hidden.max(stair), f64::max)
    }
}

/// The error of a zero where rounding hides so much of a guard, and so much is left of it.
fn error(hidden: f64, residual: f64, slope: f64) -> f64 {
    let error = (ADDED * hidden + residual) / slope;
    if error.is_finite() { error } else { 0.0 }
}
