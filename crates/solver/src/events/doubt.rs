//! By how much rounding may move the place of an event, and hide what a guard is there.

use crate::events::along_step::{rounding, scales};
use crate::events::arrival::HERE;
use crate::events::event::{Crossed, Event};
use crate::events::examination::Examination;
use crate::events::isolate::noise;
use crate::events::phase::near_zero;
use crate::method::{StepOf, Store};
use crate::system::System;

/// A guard is zero at an event if its value there is below this part of its values before.
pub(crate) const TOGETHER: f64 = 1e-12;
/// The part of a step on which the noise of a guard is measured.
const CLOSE: f64 = 1e-6;
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
        (guard, Crossed { slope, jump, .. }): (usize, Crossed),
        place: (&StepOf<S::State>, f64, &S::State),
        residual: f64,
    ) -> f64 {
        let drift = self.drift(place.1);
        if place.1 == 0.0 || jump {
            return drift;
        }
        let hidden = self.hidden_at(guard, place);
        let slope = self.slope_beyond(guard, place, (hidden, slope));
        let error = (ADDED * hidden + residual) / slope;
        drift + if error.is_finite() { error } else { 0.0 }
    }

    /// By how much rounding may have moved a time on the step.
    pub(crate) fn drift(&self, elapsed: f64) -> f64 {
        self.drift + 5.0 * f64::EPSILON * elapsed
    }

    /// The time within which guards may belong to the instant of an event. Whether they do, their
    /// errors say.
    pub(crate) fn together(&self, elapsed: f64, h: f64) -> f64 {
        (TOGETHER * h).max(HERE * self.drift(elapsed))
    }

    /// The part of a guard's largest value below which it may be zero. In a phase that is hardly
    /// longer than rounding of time, it hides more.
    pub(crate) fn near_zero(&self, elapsed: f64) -> f64 {
        near_zero(self.drift(elapsed), elapsed)
    }

    /// The slope of a guard where it leaves what rounding hides. Over a longer way, it may be quite
    /// another one, such as the one that is taken for a `guess`.
    pub(crate) fn slope_beyond(
        &mut self,
        guard: usize,
        (step, elapsed, y): (&StepOf<S::State>, f64, &S::State),
        (hidden, guess): (f64, f64),
    ) -> f64 {
        let (system, at, s) = (self.system, (self.phase.mode, guard), step.s + elapsed);
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

    /// The effect of rounding on a guard at a place of `step`: of time and state, and within the
    /// guard.
    pub(crate) fn hidden_at(
        &mut self,
        guard: usize,
        (step, elapsed, y): (&StepOf<S::State>, f64, &S::State),
    ) -> f64 {
        let (system, at, s) = (self.system, (self.phase.mode, guard), step.s + elapsed);
        let mut scale = self.room.state();
        let s_scale = scales(step, s, y, &mut scale);
        let (hidden, count) = rounding(system, at, (s, y), (s_scale, &scale), self.room);
        self.statistics.guards += count;
        let mut slope = self.room.state();
        system.field(at.0, s, y, &mut slope);
        self.statistics.field += 1;
        let (room, statistics, moved) = (&mut *self.room, &mut *self.statistics, &mut scale);
        let mut value = |ahead: f64| {
            S::State::shifted(moved, y, &slope, ahead);
            statistics.guards += 1;
            room.value(system, at, s + ahead, moved)
        };
        let reach = (CLOSE * self.usual).max(256.0 * f64::EPSILON * s.abs());
        let noise = PART * noise(&mut value, -reach, reach, [0.0]);
        self.room.give(scale);
        self.room.give(slope);
        hidden.max(noise)
    }
}
