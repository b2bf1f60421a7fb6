//! Guards that are zero where the span of a run ends.

use crate::events::along_step::rounding;
use crate::events::event::{Event, bit};
use crate::events::examination::Examination;
use crate::hybrid::Direction;
use crate::method::{StepOf, Store};
use crate::system::System;

/// The part of the step over which a guard is differenced, on both sides of the end.
pub(crate) const REACH: f64 = 1e-3;
/// An event this close to the end of its step is the one at the end.
pub(crate) const SAME: f64 = 1e-6;

impl<S: System> Examination<'_, S> {
    /// Finds guards that are zero at the end of `step`, to within rounding, and cross there in
    /// their direction. Such a guard fires, since no other step will find it.
    pub(crate) fn arrive(&mut self, step: &StepOf<S::State>, event: &mut Option<Event<S::State>>) {
        let (system, mode) = (self.system, self.phase.mode);
        let (s, y) = (step.s + step.h, &step.y1);
        let mut values = self.room.row();
        system.guard_values(mode, s, y, &mut values);
        self.statistics.guards += 1;
        let s_scale = s.abs().max(step.s.abs());
        let mut y_scale = self.room.state();
        S::State::each(&mut y_scale, [y, &step.y0], |_, [a, b]| a.abs().max(b.abs()));
        for guard in 0..self.phase.count() {
            let at_end = values[guard];
            let direction = self.phase.guards[guard].direction();
            let far =
                self.phase.largest[guard] > 0.0 && at_end.abs() > 1e-6 * self.phase.largest[guard];
            if direction == Direction::Off
                || far
                || self.notes_of(guard).any(|note| note.s >= s - SAME * step.h)
            {
                continue;
            }
            let room = &mut *self.room;
            let (hidden, count) =
                rounding(system, (mode, guard), (s, y), (s_scale, &y_scale), room);
            self.statistics.guards += count + 2;
            self.statistics.field += 1;
            let reach = REACH * step.h;
            let (mut slope, mut moved) = (room.state(), room.state());
            system.field(mode, s, y, &mut slope);
            S::State::shifted(&mut moved, y, &slope, -reach);
            let behind = room.value(system, (mode, guard), s - reach, &moved);
            S::State::shifted(&mut moved, y, &slope, reach);
            let ahead = room.value(system, (mode, guard), s + reach, &moved);
            room.give(slope);
            room.give(moved);
            let shows = behind.abs() > 4.0 * hidden && ahead.abs() > 4.0 * hidden;
            let crosses = shows && (behind < 0.0) != (ahead < 0.0);
            if at_end.abs() > hidden || !crosses || !direction.fires_from(behind) {
                continue;
            }
            let found = Event {
                guard,
                simultaneous: 0,
                slope: ((ahead - behind) / (2.0 * reach)).abs(),
                elapsed: step.h,
                state: step.y1.clone(),
                residual: at_end.abs(),
                sign: behind.signum(),
                beyond: step.h,
                jump: false,
                step: step.clone(),
            };
            if self.is_noted(&found) {
                let together = self.notes.last().is_some_and(|last| last.s == s);
                self.note(&found, together);
                continue;
            }
            // Of guards that fire together the one that precedes decides, and names the others.
            *event = Some(match event.take() {
                None => found,
                Some(first) if self.precedes(guard, first.guard) => {
                    Event { simultaneous: first.simultaneous | bit(first.guard), ..found }
                }
                Some(first) => Event { simultaneous: first.simultaneous | bit(guard), ..first },
            });
        }
    }
}
