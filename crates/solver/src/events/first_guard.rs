//! Which guard of a step fires first, if any.

use crate::error::RunError;
use crate::events::event::{Event, Found, bit};
use crate::events::examination::{Examination, column, confirmed};
use crate::events::isolate::{Beginning, Bracket};
use crate::events::one_guard::{Crossing, Status};
use crate::events::phase::Phase;
use crate::events::quick;
use crate::hybrid::{Direction, Statistics};
use crate::method::{Method, StepOf, Store};
use crate::system::{List, Note, PerGuard, Room, System};

/// Guards whose zeros are closer together than this part of the step fire together.
pub(crate) const TOGETHER: f64 = 1e-12;

impl<S: System> Examination<'_, S> {
    /// Finds the first guard that fires on `step` and changes something, and writes it to `event`,
    /// which is empty. Guards that fire before it and change nothing are noted. `values` are those
    /// of the guards at the nodes of the step, and if all are `away` from zero, none fires.
    #[inline(never)]
    pub(crate) fn look<M: Method>(
        &mut self,
        step: &mut StepOf<S::State>,
        event: &mut Option<Event<S::State>>,
        values: &[PerGuard<S, f64>; 6],
        away: bool,
    ) -> Result<Found<S>, RunError> {
        if away {
            let mut ends = self.room.row();
            ends.set(&values[5]);
            return Ok(Found::Nothing(ends));
        }
        let statuses = self.glances::<M>(step, values);
        if statuses.parts().iter().all(|&status| status == Status::Clear) {
            self.room.give_statuses(statuses);
            Ok(Found::Nothing(self.on_their_side::<M>(step, values)))
        } else {
            self.decide::<M>(step, event, values, statuses)
        }
    }

    /// Decides which guard fires first if the quick look alone does not tell that none fires.
    fn decide<M: Method>(
        &mut self,
        step: &mut StepOf<S::State>,
        event: &mut Option<Event<S::State>>,
        values: &[PerGuard<S, f64>; 6],
        mut statuses: PerGuard<S, Status>,
    ) -> Result<Found<S>, RunError> {
        let end_values = self.on_their_side::<M>(step, values);
        // Where the part of the step begins that is still to be examined, for each guard.
        let mut beginnings: PerGuard<S, Beginning> = self.room.beginnings();
        for guard in 0..self.phase.count() {
            let (value, zero_order) = (self.phase.values[guard], self.phase.zero_orders[guard]);
            beginnings[guard] = Beginning { theta: 0.0, value, zero_order };
        }
        let mut last: Option<f64> = None;
        loop {
            *event = None;
            let coarse = self.first::<M>(step, event, values, &mut statuses, &beginnings)?;
            if let Some(guard) = coarse {
                *event = None;
                return Ok(Found::TooCoarse(guard));
            }
            let Some(next) = event.as_mut() else {
                self.room.give_beginnings(beginnings);
                self.room.give_statuses(statuses);
                return Ok(Found::Nothing(end_values));
            };
            let guard = next.guard;
            if !self.is_noted(next) {
                return Ok(Found::Event);
            }
            // Rounding must not put it before the one before.
            next.elapsed = next.elapsed.max(last.unwrap_or(0.0));
            let elapsed = next.elapsed;
            self.note(next, last.is_some_and(|last| elapsed - last <= TOGETHER * step.h));
            last = Some(elapsed);
            // Whether the guard crosses again is not known beyond the bracket of this crossing.
            let theta = next.beyond / step.h;
            beginnings[guard] = Beginning { theta, value: -next.sign, zero_order: 0 };
            statuses[guard] = if theta < 1.0 { Status::Unclear } else { Status::Clear };
        }
    }

    /// Whether an event only reports a crossing: mode and state go on unchanged.
    pub(crate) fn is_noted(&self, event: &Event<S::State>) -> bool {
        let about = self.phase.guards[event.guard];
        let before = self.notes_of(event.guard).count();
        if about.direction() == Direction::Below
            || before + 1 == about.fires_until_end() as usize
            || !event.state.parts().iter().all(|value| value.is_finite())
        {
            return false;
        }
        let s = self.trial.s + event.elapsed;
        let mut after = event.state.clone();
        self.system.transition(self.phase.mode, event.guard, s, &mut after) == self.phase.mode
            && after == event.state
    }

    /// The notes of a guard on this step.
    pub(crate) fn notes_of(&self, guard: usize) -> impl Iterator<Item = &Note<S>> {
        self.notes
            .iter()
            .filter(move |note| note.guard == guard || note.simultaneous & bit(guard) != 0)
    }

    /// Notes an event that changes nothing. If it is `together` with the one before, both are one.
    pub(crate) fn note(&mut self, event: &Event<S::State>, together: bool) {
        if together
            && bit(event.guard) != 0
            && let Some(last) = self.notes.last_mut()
            && last.guard != event.guard
            && last.simultaneous & bit(event.guard) == 0
        {
            last.simultaneous |= bit(event.guard);
            return;
        }
        let largest = self.phase.largest[event.guard];
        self.notes.push(Note {
            s: self.trial.s + event.elapsed,
            guard: event.guard,
            simultaneous: 0,
            flatness: if largest == 0.0 { 0.0 } else { largest / event.slope },
            jump: event.jump,
            from: self.phase.mode,
            to: self.phase.mode,
            before: event.state.clone(),
            after: event.state.clone(),
        });
    }

    /// Finds the first guard that fires, whether or not it changes something, and writes it to
    /// `event`. Returns the guard for which the step is too coarse, if there is one. What isolation
    /// finds on the `full` step is kept.
    fn first<M: Method>(
        &mut self,
        step: &mut StepOf<S::State>,
        event: &mut Option<Event<S::State>>,
        full_values: &[PerGuard<S, f64>; 6],
        full: &mut PerGuard<S, Status>,
        beginnings: &PerGuard<S, Beginning>,
    ) -> Result<Option<usize>, RunError> {
        let mut values = [(); 6].map(|()| self.room.row());
        for (values, full) in values.iter_mut().zip(full_values) {
            values.set(full);
        }
        let mut statuses = self.room.statuses();
        statuses.set(full);
        loop {
            let first = self.earliest(&statuses);
            let starts = first.is_some_and(|(_, crossing)| crossing.bracket.high == 0.0);
            if (first.is_none() || starts) && statuses.parts().contains(&Status::Unclear) {
                let shortened = event.is_some();
                let on = event.as_mut().map_or(&mut *step, |event| &mut event.step);
                // Whether a guard fires together with an event at the start shows after the event.
                let may_wait = starts || on.h <= TOGETHER * self.trial.h;
                for guard in 0..self.phase.count() {
                    if statuses[guard] == Status::Unclear {
                        let status = match self.isolate_rest::<M>(guard, on, &values, beginnings)? {
                            Some(status) => status,
                            None if may_wait => Status::Clear,
                            None => return Ok(Some(guard)),
                        };
                        statuses[guard] = status;
                        if !shortened {
                            full[guard] = status;
                        }
                    }
                }
                continue;
            }
            let Some((guard, crossing)) = first else {
                values.map(|values| self.room.give_row(values));
                self.room.give_statuses(statuses);
                return Ok(None);
            };
            statuses[guard] = Status::Clear;
            let on = event.as_ref().map_or(&*step, |event| &event.step);
            let exact = self.wants_segments
                || event.is_some()
                || statuses.parts().iter().any(|&status| status != Status::Clear);
            let Some(mut next) = self.locate::<M>(on, guard, &crossing, exact)? else {
                return Ok(Some(guard));
            };
            if next.elapsed == 0.0 {
                let at_start = |status: Status| match status {
                    Status::Fires(crossing) => crossing.bracket.high == 0.0,
                    _ => false,
                };
                next.simultaneous = mask(statuses.parts().iter().map(|&status| at_start(status)));
                *event = Some(next);
                return Ok(None);
            }
            if let Some(event) = event.as_mut()
                && next.elapsed >= (1.0 - TOGETHER) * event.elapsed
                && self.precedes(event.guard, guard)
            {
                // Both fire at the end of the shortened step, and the event's guard precedes.
                continue;
            }
            let mut at_nodes = values.clone();
            self.values_on(&next.step, &mut at_nodes);
            let mut together = self.together(&next, &at_nodes);
            let on = event.as_mut().map_or(&mut *step, |event| &mut event.step);
            let others = (&together, &statuses);
            if let Some(preceding) = self.preceding::<M>(&next, on, &values, others, beginnings)? {
                // Of guards that fire together the one that precedes decides, even if rounding
                // puts another one earlier.
                next = preceding;
                statuses[next.guard] = Status::Clear;
                self.values_on(&next.step, &mut at_nodes);
                together = self.together(&next, &at_nodes);
            }
            next.simultaneous = mask(together.parts().iter().copied());
            values = at_nodes;
            for (other, status) in statuses.parts_mut().iter_mut().enumerate() {
                if *status == Status::Clear {
                    continue;
                }
                // A quick look would find again what a guard has already been noted for.
                *status = if self.notes_of(other).next().is_some() {
                    Status::Unclear
                } else {
                    self.glance_at::<M>(other, &next.step, &values, &mut None)
                };
            }
            *event = Some(next);
        }
    }

    /// Isolates a guard on a shortened step, from its beginning on the full step on.
    fn isolate_rest<M: Method>(
        &mut self,
        guard: usize,
        step: &mut StepOf<S::State>,
        values: &[PerGuard<S, f64>; 6],
        beginnings: &PerGuard<S, Beginning>,
    ) -> Result<Option<Status>, RunError> {
        let mut beginning = beginnings[guard];
        beginning.theta *= self.trial.h / step.h;
        if beginning.theta >= 1.0 {
            return Ok(Some(Status::Clear));
        }
        self.isolate::<M>(guard, step, &column::<S>(values, guard), beginning)
    }

    /// Whether guard `first` decides the transition if it fires together with guard `second`. The
    /// guard that does not yield decides; if both yield or neither does, the one listed first.
    pub(crate) fn precedes(&self, first: usize, second: usize) -> bool {
        let rank = |guard: usize| (self.phase.guards[guard].yields(), guard);
        rank(first) < rank(second)
    }

    /// The crossing with the smallest step fraction, and its guard. If two fractions are equal, the
    /// guard that precedes is taken.
    fn earliest(&self, statuses: &PerGuard<S, Status>) -> Option<(usize, Crossing)> {
        let mut first: Option<(usize, Crossing)> = None;
        for (guard, status) in statuses.parts().iter().enumerate() {
            let Status::Fires(crossing) = *status else { continue };
            let before = |(other, at): (usize, Crossing)| {
                let (here, there) = (crossing.bracket.guess, at.bracket.guess);
                here < there || (here == there && self.precedes(guard, other))
            };
            if first.is_none_or(before) {
                first = Some((guard, crossing));
            }
        }
        first
    }

    /// The event of the first guard that fires together with the guard of `event` and precedes it.
    /// `step` is the step before `event` shortens it; `values` and the statuses of the guards
    /// belong to that step. Which guards are zero at the event is known.
    fn preceding<M: Method>(
        &mut self,
        event: &Event<S::State>,
        step: &mut StepOf<S::State>,
        values: &[PerGuard<S, f64>; 6],
        (zero, statuses): (&PerGuard<S, bool>, &PerGuard<S, Status>),
        beginnings: &PerGuard<S, Beginning>,
    ) -> Result<Option<Event<S::State>>, RunError> {
        for (first, &status) in statuses.parts().iter().enumerate() {
            if !zero[first] || !self.precedes(first, event.guard) {
                continue;
            }
            let status = match status {
                Status::Unclear => self.isolate_rest::<M>(first, step, values, beginnings)?,
                known => Some(known),
            };
            let Some(Status::Fires(Crossing { sign, bracket })) = status else { continue };
            let guess = event.elapsed / step.h;
            let Bracket { low, high, .. } = bracket;
            if low <= (1.0 + TOGETHER) * guess && (1.0 - TOGETHER) * guess <= high {
                let crossing = Crossing { sign, bracket: Bracket { guess, ..bracket } };
                let preceding = self.locate::<M>(step, first, &crossing, true)?;
                // A guard that only touches zero here may fire elsewhere.
                if let Some(preceding) = preceding
                    && (preceding.elapsed - event.elapsed).abs() <= TOGETHER * event.elapsed
                {
                    return Ok(Some(preceding));
                }
            }
        }
        Ok(None)
    }

    /// Which guards other than that of `event` are zero there. `values` are those at the nodes of
    /// the event's step, which may end beside the event.
    fn together(
        &mut self,
        event: &Event<S::State>,
        values: &[PerGuard<S, f64>; 6],
    ) -> PerGuard<S, bool> {
        let mut there = self.room.row();
        if self.phase.count() == 1 {
            there.set(&values[5]);
        } else {
            self.statistics.guards += 1;
            let s = self.trial.s + event.elapsed;
            self.system.guard_values(self.phase.mode, s, &event.state, &mut there);
        }
        List::made(self.phase.count(), |other| {
            other != event.guard
                && self.phase.guards[other].direction() != Direction::Off
                && there[other].abs() <= TOGETHER * largest::<S>(other, values)
        })
    }
}

/// The guards of a set, one bit each.
fn mask(guards: impl Iterator<Item = bool>) -> u64 {
    guards.enumerate().fold(0, |bits, (guard, one)| bits | if one { bit(guard) } else { 0 })
}

/// Whether all guards stay clearly on the side where they do not fire. This holds on most steps.
#[inline(always)]
pub(crate) fn all_clearly_away<S: System>(
    system: &S,
    phase: &Phase<S>,
    guard_scale: f64,
    step: &StepOf<S::State>,
    values: &[PerGuard<S, f64>; 6],
    statistics: &mut Statistics,
    room: &mut Room<S>,
    sure: &mut PerGuard<S, bool>,
) -> bool {
    // The verdicts are collected, so that the loop is unrolled and the values stay in registers.
    for guard in 0..phase.count() {
        let column = column::<S>(values, guard);
        sure[guard] = match phase.guards[guard].direction() {
            Direction::Off => true,
            Direction::Below => column[0] > 0.0 && quick::clearly_away(column),
            _ => quick::clearly_away(column),
        };
    }
    let read = S::READABLE && !phase.smooth;
    let away = sure.parts().iter().all(|away| *away);
    !phase.at_zero && !read && away && {
        confirmed(system, phase, guard_scale, step, values, sure, statistics, room);
        sure.parts().iter().all(|sure| *sure)
    }
}

/// The largest absolute value of a guard at the nodes of a step.
fn largest<S: System>(guard: usize, values: &[PerGuard<S, f64>; 6]) -> f64 {
    column::<S>(values, guard).iter().fold(0.0, |size, value| size.max(value.abs()))
}
