//! Which guard of a dynamic system fires first on a step, if any.
//!
//! Every guard that a quick look does not settle is isolated on the whole step. Of those that fire,
//! all that may be the first are located by steps of the method, and the first place counts. An
//! event that changes nothing is noted, and the search goes on behind it, as in
//! [`crate::events::first_guard`].

use crate::dynamic::event::{Event, Found};
use crate::dynamic::examination::Examination;
use crate::dynamic::step::Step;
use crate::dynamic::system::DynamicSystem;
use crate::error::RunError;
use crate::events::first_guard::TOGETHER;
use crate::events::isolate::Beginning;
use crate::events::one_guard::{Crossing, Status};
use crate::hybrid::Direction;
use crate::method::Method;
use crate::runs::finite::is_finite;

impl<S: DynamicSystem> Examination<'_, S> {
    /// Finds the first guard that fires on `step` and changes something. Guards that fire before it
    /// and change nothing are noted.
    pub(crate) fn look<M: Method>(&mut self, step: &mut Step) -> Result<Found, RunError> {
        let count = self.phase.values.len();
        if count == 0 {
            self.tables.ends.clear();
            return Ok(Found::Nothing);
        }
        self.work.values.resize(count, 0.0);
        self.fill_nodes::<M>(step);
        if self.all_clearly_away(step) {
            let end = self.tables.nodes.len() - count;
            self.tables.ends.clear();
            self.tables.ends.extend_from_slice(&self.tables.nodes[end..]);
            return Ok(Found::Nothing);
        }
        self.confirm(step);
        self.tables.statuses.clear();
        self.tables.beginnings.clear();
        for guard in 0..count {
            let status = self.glance::<M>(guard);
            self.tables.statuses.push(Some(status));
            let (value, zero_order) = (self.phase.values[guard], self.phase.zero_orders[guard]);
            self.tables.beginnings.push(Beginning { theta: 0.0, value, zero_order });
        }
        self.fill_ends::<M>(step);
        self.decide::<M>(step)
    }

    /// Decides which guard fires first after the quick look.
    fn decide<M: Method>(&mut self, step: &mut Step) -> Result<Found, RunError> {
        // The first event of each guard behind its beginning, as far as it is located.
        let mut located: Vec<Event> = Vec::new();
        let mut last: Option<f64> = None;
        loop {
            for guard in 0..self.phase.values.len() {
                if self.tables.statuses[guard] == Some(Status::Unclear) {
                    self.tables.statuses[guard] = self.isolate::<M>(guard, step)?;
                }
            }
            if let Some(guard) = self.locate_first::<M>(step, &mut located)? {
                return Ok(Found::TooCoarse(guard, None));
            }
            let first = self.first_of(&located);
            let coarse = self.tables.statuses.iter().position(Option::is_none);
            if let Some(guard) = coarse {
                match first.map(|first| located[first].elapsed) {
                    // What the other guard does behind the start does not matter.
                    Some(0.0) => {}
                    elapsed => return Ok(Found::TooCoarse(guard, elapsed)),
                }
            }
            let Some(first) = first else {
                return Ok(Found::Nothing);
            };
            let mut event = located.swap_remove(first);
            let guard = event.guard;
            if !self.is_noted(&event) {
                if event.elapsed > 0.0 {
                    event.simultaneous = self.simultaneous(&event, step);
                }
                return Ok(Found::Event(event));
            }
            // Whether the guard crosses again is not known beyond the bracket of this crossing.
            let theta = event.beyond / step.h;
            self.tables.beginnings[guard] = Beginning { theta, value: -event.sign, zero_order: 0 };
            self.tables.statuses[guard] =
                Some(if theta < 1.0 { Status::Unclear } else { Status::Clear });
            event.elapsed = event.elapsed.max(last.unwrap_or(0.0));
            let elapsed = event.elapsed;
            self.note(event, last.is_some_and(|last| elapsed - last <= TOGETHER * step.h));
            last = Some(elapsed);
        }
    }

    /// Locates every guard that may be the first to fire. Returns the guard for which the step is
    /// too coarse, if there is one.
    fn locate_first<M: Method>(
        &mut self,
        step: &Step,
        located: &mut Vec<Event>,
    ) -> Result<Option<usize>, RunError> {
        loop {
            let until = located.iter().fold(f64::INFINITY, |least, event| least.min(event.elapsed));
            let mut next: Option<(usize, Crossing)> = None;
            for (guard, status) in self.tables.statuses.iter().enumerate() {
                let &Some(Status::Fires(crossing)) = status else { continue };
                let may_be_first = crossing.bracket.low * step.h <= (1.0 + TOGETHER) * until;
                let before = next.is_none_or(|(_, at)| crossing.bracket.guess < at.bracket.guess);
                if may_be_first && before && located.iter().all(|event| event.guard != guard) {
                    next = Some((guard, crossing));
                }
            }
            let Some((guard, crossing)) = next else {
                return Ok(None);
            };
            match self.locate::<M>(step, guard, &crossing)? {
                Some(event) => located.push(event),
                None => return Ok(Some(guard)),
            }
        }
    }

    /// The index of the first event. Of those that are together, the one whose guard precedes.
    fn first_of(&self, located: &[Event]) -> Option<usize> {
        let least = located.iter().fold(f64::INFINITY, |least, event| least.min(event.elapsed));
        let together = |event: &Event| (1.0 - TOGETHER) * event.elapsed <= least;
        (0..located.len())
            .filter(|&index| together(&located[index]))
            .min_by_key(|&index| self.rank(located[index].guard))
    }

    /// Of guards that fire together the one with the lowest rank decides.
    pub(crate) fn rank(&self, guard: usize) -> (bool, usize) {
        (self.phase.guards[guard].yields(), guard)
    }

    /// Whether an event only reports a crossing: mode and state go on unchanged.
    pub(crate) fn is_noted(&mut self, event: &Event) -> bool {
        let about = self.phase.guards[event.guard];
        let before = self.notes_of(event.guard).count();
        if about.direction() == Direction::Below
            || before + 1 == about.fires_until_end() as usize
            || !is_finite(&event.state)
        {
            return false;
        }
        let s = self.origin.s + event.elapsed;
        let after = &mut self.work.moved;
        after.copy_from_slice(&event.state);
        let mode = self.system.transition(self.phase.mode, event.guard, s, after);
        mode == self.phase.mode && *after == event.state
    }

    /// Notes an event that changes nothing. If it is `together` with the one before, both are one.
    pub(crate) fn note(&mut self, event: Event, together: bool) {
        if together
            && let Some(last) = self.notes.last_mut()
            && last.guard != event.guard
            && let Err(place) = last.simultaneous.binary_search(&event.guard)
        {
            last.simultaneous.insert(place, event.guard);
            return;
        }
        self.notes.push(event);
    }

    /// The guards other than that of `event` that are zero there, in ascending order.
    fn simultaneous(&mut self, event: &Event, step: &Step) -> Vec<usize> {
        let count = self.phase.values.len();
        if count == 1 {
            return Vec::new();
        }
        let s = self.origin.s + event.elapsed;
        self.statistics.guards += 1;
        self.system.guard_values(self.phase.mode, s, &event.state, &mut self.work.values);
        let until = event.elapsed / step.h;
        (0..count)
            .filter(|&other| {
                let column = self.tables.column(other, count);
                // The largest value up to the event.
                let before = column.iter().zip(crate::events::quick::NODES);
                let largest = before
                    .filter(|&(_, node)| node <= until)
                    .fold(0.0_f64, |size, (value, _)| size.max(value.abs()));
                other != event.guard
                    && self.phase.guards[other].direction() != Direction::Off
                    && self.work.values[other].abs() <= TOGETHER * largest
            })
            .collect()
    }
}
