//! Guards that are zero at the end of a step where the run must not miss them: at the end of the
//! span, at the time of a clock, and at an event of another guard.

use crate::events::event::{Crossed, Event};
use crate::events::examination::Examination;
use crate::events::quick::NODES;
use crate::method::{StepOf, Store};
use crate::system::System;

/// The part of the step over which a guard is differenced, on both sides of the end.
const REACH: f64 = 1e-3;
/// The number of roundings within which a guard counts as zero there. Roundings add up from event
/// to event.
const ARRIVES: f64 = 16.0;
/// The errors of time within which a guard shows nothing.
pub(crate) const SHOWS: f64 = 16.0;
/// The roundings of time that may hide what a guard does.
const HIDES: f64 = 65536.0;
/// A guard that acts is not examined again within this many roundings of time.
pub(crate) const HERE: f64 = 64.0;
/// An event this close to the end of its step is the one at the end.
pub(crate) const SAME: f64 = 1e-6;

impl<S: System> Examination<'_, S> {
    /// Finds guards that are zero at the end of `step`, to within rounding, and cross there in
    /// their direction. Such a guard fires, since no other step will find it.
    pub(crate) fn arrive(&mut self, step: &StepOf<S::State>, event: &mut Option<Event<S>>) {
        for guard in 0..self.phase.count() {
            let s = step.s + step.h;
            // It has acted within rounding of this place.
            let here = self.age + step.h <= HERE * self.drift;
            if here && self.phase.zero_by_rounding[guard] {
                continue;
            }
            let same = (SAME * step.h).max(HERE * self.drift(step.h));
            if self.notes_of(guard).any(|note| note.s >= s - same) {
                continue;
            }
            let arrival = self.arrival(guard, (step, step.h, &step.y1), ARRIVES, None);
            let Some(crossed) = arrival else { continue };
            let found = self.at_end(guard, crossed, step);
            if self.is_noted(&found) {
                let together = self.notes.last().is_some_and(|last| last.s == s);
                self.note(&found, together);
                continue;
            }
            *event = Some(match event.take() {
                None => found,
                Some(first) => self.merged(first, found),
            });
        }
    }

    /// Adds the clocks that are `due`, after the time `left`, to the event on `step`, unless that
    /// comes before. If there is no event, they are due at the end of the step.
    pub(crate) fn tick(
        &mut self,
        step: &StepOf<S::State>,
        (due, left): (f64, f64),
        event: &mut Option<Event<S>>,
    ) {
        if let Some(first) = event {
            let rounding = 4.0 * f64::EPSILON * due.abs().max(step.s.abs());
            let latest = first.latest.unwrap_or_else(|| first.elapsed + self.error_of(first));
            if left > latest + rounding {
                return;
            }
            // The clock knows the time of the instant exactly.
            first.elapsed = left;
        }
        let mode = self.phase.mode;
        for guard in (0..self.phase.count()).filter(|&guard| self.phase.is_clock(guard)) {
            if self.system.next_time(mode, guard, due.next_down()) > due {
                continue;
            }
            let crossed = Crossed { slope: 1.0, jump: false, sign: 1.0 };
            let tick = Event { elapsed: left, ..self.at_end(guard, crossed, step) };
            *event = Some(match event.take() {
                None => tick,
                Some(first) => self.merged(first, tick),
            });
        }
    }

    /// Two events of one instant as one, of the guard that precedes.
    pub(crate) fn merged(&self, one: Event<S>, other: Event<S>) -> Event<S> {
        let precedes = self.precedes(one.guard, other.guard);
        let (mut first, second) = if precedes { (one, other) } else { (other, one) };
        first.take_in(&second.crossed);
        first.simultaneous[first.guard] = false;
        first
    }

    /// How a guard crosses zero at a place of a step, if it crosses in its direction and is zero
    /// within some roundings and the error of an `event` there.
    pub(crate) fn arrival(
        &mut self,
        guard: usize,
        (step, elapsed, y): (&StepOf<S::State>, f64, &S::State),
        roundings: f64,
        event: Option<&Event<S>>,
    ) -> Option<Crossed> {
        let direction = self.phase.guards[guard].direction();
        if !direction.has_values() {
            return None;
        }
        let (system, mode, s) = (self.system, self.phase.mode, step.s + elapsed);
        let there = self.room.value(system, (mode, guard), s, y);
        self.statistics.guards += 1;
        let (largest, near) = (self.phase.largest[guard], self.near_zero(elapsed));
        if largest > 0.0 && there.abs() > near * largest {
            // The phase may have begun at a zero.
            let (s, y) = (step.s + NODES[2] * step.h, &step.interior[1]);
            self.statistics.guards += 1;
            if there.abs() > near * self.room.value(system, (mode, guard), s, y).abs() {
                return None;
            }
        }
        let hidden = self.hidden_at(guard, (step, elapsed, y));
        let shortest = SHOWS * self.drift(elapsed);
        let room = &mut *self.room;
        let (mut slope, mut moved) = (room.state(), room.state());
        system.field(mode, s, y, &mut slope);
        self.statistics.field += 1;
        // On a step that was cut very short, rounding hides what the guard does.
        let mut reach = (REACH * elapsed.max(f64::EPSILON * self.usual)).max(shortest);
        let longest = self.usual.max(HIDES * f64::EPSILON * s.abs());
        let (behind, ahead, shows) = loop {
            S::State::shifted(&mut moved, y, &slope, -reach);
            let behind = room.value(system, (mode, guard), s - reach, &moved);
            S::State::shifted(&mut moved, y, &slope, reach);
            let ahead = room.value(system, (mode, guard), s + reach, &moved);
            self.statistics.guards += 2;
            let shows = behind.abs().min(ahead.abs()) > 4.0 * roundings * hidden;
            if shows || 16.0 * reach > longest {
                break (behind, ahead, shows);
            }
            reach *= 16.0;
        };
        room.give(slope);
        room.give(moved);
        let crosses = shows && (behind < 0.0) != (ahead < 0.0);
        let slope = ((ahead - behind) / (2.0 * reach)).abs();
        if !crosses || !direction.fires_from(behind) {
            return None;
        }
        let slope = self.slope_beyond(guard, (step, elapsed, y), (hidden, slope));
        let error = event.map_or(0.0, |event| self.error_of(event));
        let hidden = roundings * (hidden + slope * self.drift(elapsed)) + slope * error;
        (there.abs() <= hidden).then_some(Crossed { slope, jump: false, sign: behind.signum() })
    }

    /// The event of a guard at the end of `step`.
    pub(crate) fn at_end(
        &self,
        guard: usize,
        crossed: Crossed,
        step: &StepOf<S::State>,
    ) -> Event<S> {
        let (of, at) = ((guard, self.phase.count()), (step.h, step.y1.clone()));
        let beyond = (1.0 + REACH) * step.h;
        Event { beyond, ..Event::alone(of, crossed, at, step.clone()) }
    }
}
