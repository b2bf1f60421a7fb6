//! Which guard of a step fires first, if any.

use smallvec::SmallVec;

use crate::error::RunError;
use crate::events::along_step::first_side;
use crate::events::arrival::SAME;
use crate::events::by_bounds::Sight;
use crate::events::doubt::{ADDED, TOGETHER};
use crate::events::event::{Crossed, Event, Found};
use crate::events::examination::{Examination, column, confirmed};
use crate::events::isolate::{Beginning, Bracket};
use crate::events::phase::Phase;
use crate::events::quick::{self, NODES};
use crate::events::sidestep::resolution;
use crate::events::status::{Crossing, Status};
use crate::hybrid::{Direction, Statistics};
use crate::lists::List;
use crate::method::{Method, StepOf, Store};
use crate::system::{PerGuard, Room, System};

/// A step shows nothing about guards if it is shorter than this many units of rounding of time.
pub(crate) const UNSEEN: f64 = 16.0;
/// A guard that starts from a zero needs at most this many roundings of time to cross it, or a part
/// of the step that hides much of its place.
const FORGETS: f64 = 256.0;

impl<S: System> Examination<'_, S> {
    /// Finds the first guard that fires on `step` and changes something, and writes it to `event`,
    /// which is empty. Guards that fire before it and change nothing are noted. `values` are the
    /// values of the guards at the nodes of the step. If all are `away` from zero, no guard fires.
    #[inline(never)]
    pub(crate) fn look<M: Method>(
        &mut self,
        step: &mut StepOf<S::State>,
        event: &mut Option<Event<S>>,
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

    /// Decides which guard fires first if the quick look alone does not exclude all guards.
    fn decide<M: Method>(
        &mut self,
        step: &mut StepOf<S::State>,
        event: &mut Option<Event<S>>,
        values: &[PerGuard<S, f64>; 6],
        mut statuses: PerGuard<S, Status>,
    ) -> Result<Found<S>, RunError> {
        let mut end_values = self.on_their_side::<M>(step, values);
        // Where the part of the step begins that is still to be examined, for each guard.
        let mut beginnings: PerGuard<S, Beginning> = self.room.beginnings();
        for guard in 0..self.phase.count() {
            let (value, zero_order) = (self.phase.values[guard], self.phase.zero_orders[guard]);
            beginnings[guard] = Beginning { theta: 0.0, value, zero_order };
            let bounds = self.phase.guards[guard].direction() == Direction::Below;
            if bounds && value < 0.0 && zero_order == 0 {
                // Whatever it does on the step, it is beyond its zero already.
                statuses[guard] = Status::Fires(Crossing::at_start(1.0));
            }
        }
        self.pass_forgiven(step, &mut beginnings, &mut statuses, &mut end_values);
        // The event before that changed nothing.
        let mut last: Option<Event<S>> = None;
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
            let together = last.as_ref().is_some_and(|last| last.crossed[guard].is_some());
            next.elapsed = next.elapsed.max(last.as_ref().map_or(0.0, |last| last.elapsed));
            self.note(next, together);
            // Whether the guard crosses again is not known beyond the bracket of this crossing.
            let (place, sign) = (next.elapsed / step.h, next.own().sign);
            let (beyond, end) = (next.beyond / step.h, end_values[guard]);
            let theta = self.past_noise::<M>(guard, step, (place, beyond), end);
            beginnings[guard] = Beginning { theta, value: -sign, zero_order: 0 };
            statuses[guard] = if theta < 1.0 { Status::Unclear } else { Status::Clear };
            if theta >= 1.0 && end * sign >= 0.0 {
                // It has crossed within rounding of the end of the step.
                end_values[guard] = -f64::MIN_POSITIVE.copysign(sign);
            }
            last = event.take();
        }
    }

    /// Lets guards that rounding has moved away from the zero from which they start, and that are
    /// still on their way across it, begin behind it.
    fn pass_forgiven(
        &mut self,
        step: &StepOf<S::State>,
        beginnings: &mut PerGuard<S, Beginning>,
        statuses: &mut PerGuard<S, Status>,
        end_values: &mut PerGuard<S, f64>,
    ) {
        for guard in 0..self.phase.count() {
            let value = self.phase.values[guard];
            if !self.phase.zero_by_rounding[guard] || value == 0.0 {
                continue;
            }
            let (system, mode, s) = (self.system, self.phase.mode, self.trial.s);
            let mut ahead = self.room.state();
            let most = (FORGETS * self.drift).max(SAME * step.h);
            let mut reach = self.drift;
            let passes = loop {
                S::State::shifted(&mut ahead, self.trial.y, self.trial.slope, reach);
                self.statistics.guards += 1;
                if self.room.value(system, (mode, guard), s + reach, &ahead) * value < 0.0 {
                    break true;
                }
                reach *= 2.0;
                // At time 0, rounding moves no time.
                if reach > most || reach == 0.0 {
                    break false;
                }
            };
            self.room.give(ahead);
            // Where rounding hides what the state does, the time alone seems to bring it back.
            let passes = passes && {
                let at = (mode, guard);
                first_side(system, at, step, self.statistics, self.room) * value <= 0.0
            };
            // Closer to the start, signs are rounding.
            let theta = 2.0 * (reach / step.h + resolution(step.s, step.h));
            if passes && theta < 1.0 {
                beginnings[guard] = Beginning { theta, value: -value, zero_order: 0 };
                statuses[guard] = Status::Unclear;
            } else if passes {
                statuses[guard] = Status::Clear;
                end_values[guard] = -f64::MIN_POSITIVE.copysign(value);
            }
        }
    }

    /// Finds the first guard that fires, whether or not it changes something, with all guards that
    /// fire at the same instant, and writes it to `event`. Returns the guard for which the step is
    /// too coarse, if there is one. What isolation finds on the full step is kept in `statuses`.
    ///
    /// Only guards that may be the first are located: the others are on their side of zero where
    /// the first one fires.
    fn first<M: Method>(
        &mut self,
        step: &mut StepOf<S::State>,
        event: &mut Option<Event<S>>,
        values: &[PerGuard<S, f64>; 6],
        statuses: &mut PerGuard<S, Status>,
        beginnings: &PerGuard<S, Beginning>,
    ) -> Result<Option<usize>, RunError> {
        let mut search = Search::<S> {
            open: self.room.bools(),
            there: self.room.row(),
            nodes: [(); 6].map(|()| self.room.row()),
            nodes_known: false,
            sight: None,
            located: SmallVec::new(),
        };
        for (open, status) in search.open.parts_mut().iter_mut().zip(statuses.parts()) {
            *open = *status != Status::Clear;
        }
        let mut coarse: Option<usize> = None;
        while coarse.is_none() {
            let candidate = self.candidate(statuses, &mut search, event.as_ref(), (step.h, values));
            let open = search.open.parts().iter().zip(statuses.parts());
            let unclear =
                open.enumerate().find(|(_, (open, status))| **open && **status == Status::Unclear);
            let unclear = unclear.map(|(guard, _)| guard);
            // Whether a guard fires together with an event at the start is decided on the whole
            // step.
            let at_start = |guard| {
                event.as_ref().is_some_and(|it| it.elapsed == 0.0)
                    && self.phase.values[guard] == 0.0
            };
            let starts = candidate.is_some_and(|(_, crossing)| crossing.bracket.high == 0.0)
                || unclear.is_some_and(at_start);
            let next = match (candidate, unclear, event.as_mut()) {
                (None, None, _) => break,
                (_, Some(guard), found) if starts || found.is_none() && candidate.is_none() => {
                    match self.isolate_rest::<M>(guard, step, values, beginnings)? {
                        Some(status) => statuses[guard] = status,
                        None if starts => search.open[guard] = false,
                        None => coarse = Some(guard),
                    }
                    search.open[guard] &= statuses[guard] != Status::Clear;
                    None
                }
                (Some((guard, crossing)), ..) => {
                    search.open[guard] = false;
                    let exact = self.wants_segments || unclear.is_some();
                    let next = self.locate::<M>(step, guard, &crossing, exact)?;
                    coarse = next.is_none().then_some(guard);
                    next
                }
                // Behind an event it does not matter what an unclear guard does. Without one, the
                // second arm has taken this case.
                (None, Some(guard), found) => {
                    search.open[guard] = false;
                    let Some(found) = found else { continue };
                    let next = self.until::<M>(guard, found, &mut search, beginnings)?;
                    coarse = next.is_err().then_some(guard);
                    next.ok().flatten()
                }
            };
            if let Some(next) = next {
                self.take(next, event, &mut search);
            }
        }
        if let Some(event) = event {
            // Places whose errors overlap, from one to the next, are one instant.
            let mut reached: SmallVec<[Located; 2]> =
                search.located.iter().filter(|it| it.guard == event.guard).copied().collect();
            while let Some(one) = reached.pop() {
                let latest = one.elapsed + one.error;
                event.latest = Some(event.latest.map_or(latest, |known| known.max(latest)));
                for &other in search.located.iter().filter(|other| one.is_together_with(other)) {
                    if event.crossed[other.guard].is_none() {
                        event.crossed[other.guard] = Some(other.crossed);
                        reached.push(other);
                    }
                    if self.precedes(other.guard, event.guard) {
                        event.led_by(other.guard, other.residual);
                    }
                }
            }
            self.arrive_with(event, &search.there, values, step.h);
            self.name_simultaneous(event, &search.there, values, step.h);
        }
        let Search { open, there, nodes, .. } = search;
        self.room.give_bools(open);
        for row in nodes.into_iter().chain([there]) {
            self.room.give_row(row);
        }
        Ok(coarse)
    }

    /// The guard that seems to fire first, of those that may fire no later than the event, if one
    /// is known. Guards that fire later are closed.
    fn candidate(
        &self,
        statuses: &PerGuard<S, Status>,
        search: &mut Search<S>,
        event: Option<&Event<S>>,
        (h, values): (f64, &[PerGuard<S, f64>; 6]),
    ) -> Option<(usize, Crossing)> {
        let mut first: Option<(usize, Crossing)> = None;
        let near = event.map_or(0.0, |event| self.near_zero(event.elapsed));
        for (guard, status) in statuses.parts().iter().enumerate() {
            let Status::Fires(crossing) = *status else { continue };
            if !search.open[guard] {
                continue;
            }
            if let Some(event) = event {
                let (theta, Bracket { low, high, .. }) = (event.elapsed / h, crossing.bracket);
                // In the bracket it crosses zero once, so that its sign shows on which side it is.
                let before = crossing.sign * search.there[guard];
                let later = (low - theta) * h > self.together(event.elapsed, event.elapsed)
                    || high >= theta && before > near * largest::<S>(guard, values);
                if later {
                    search.open[guard] = false;
                    continue;
                }
            }
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

    /// The event of a guard that is unclear, if it fires no later than the event that was `found`.
    fn until<M: Method>(
        &mut self,
        guard: usize,
        found: &mut Event<S>,
        search: &mut Search<S>,
        beginnings: &PerGuard<S, Beginning>,
    ) -> Result<Result<Option<Event<S>>, Unresolved>, RunError> {
        if beginnings[guard].theta > 0.0 && beginnings[guard].theta * self.trial.h >= found.elapsed
        {
            // It has fired already.
            return Ok(Ok(None));
        }
        if !search.nodes_known {
            search.sight = None;
            self.values_on(&found.step, &mut search.nodes);
            search.nodes_known = true;
        }
        // Whether it fires together with an event at the start shows after the event.
        let may_wait = found.step.h <= TOGETHER * self.trial.h;
        // On a step that time hardly resolves, signs are rounding.
        let unseen = found.step.h <= UNSEEN * f64::EPSILON * found.step.s.abs();
        // A quick look would find again what a guard has already been noted for.
        let mut status = if unseen {
            Status::Clear
        } else if self.notes_of(guard).next().is_some() {
            Status::Unclear
        } else {
            self.glance_at::<M>(guard, &found.step, &search.nodes, &mut search.sight)
        };
        if status == Status::Unclear {
            let step = &mut found.step;
            status = match self.isolate_rest::<M>(guard, step, &search.nodes, beginnings)? {
                Some(status) => status,
                None if may_wait => Status::Clear,
                None => return Ok(Err(Unresolved)),
            };
        }
        Ok(match status {
            Status::Fires(crossing) => {
                self.locate::<M>(&found.step, guard, &crossing, true)?.map(Some).ok_or(Unresolved)
            }
            _ if self.notes_of(guard).next().is_none() => {
                let place = (&found.step, found.elapsed, &found.state);
                // At the start of the step, it may have been noted on the step before.
                let crossed = self.arrival(guard, place, ADDED, Some(found)).filter(|crossed| {
                    !may_wait
                        || self.phase.zero_orders[guard] == 0
                            && crossed.sign * self.phase.values[guard] > 0.0
                });
                Ok(crossed.map(|crossed| self.at_end(guard, crossed, &found.step)))
            }
            _ => Ok(None),
        })
    }

    /// Takes the event `next` if it is the first one so far, or precedes at the same instant.
    fn take(&mut self, next: Event<S>, event: &mut Option<Event<S>>, search: &mut Search<S>) {
        if let Some(found) = event {
            if search.located.is_empty() {
                let found = self.located(found);
                search.located.push(found);
            }
            let (one, other) = (self.located(&next), self.located(found));
            search.located.push(one);
            let before = if one.is_together_with(&other) {
                self.precedes(next.guard, found.guard)
            } else {
                next.elapsed < found.elapsed
            };
            if !before {
                return;
            }
        }
        if self.phase.count() > 1 {
            let s = self.trial.s + next.elapsed;
            self.statistics.guards += 1;
            self.system.guard_values(self.phase.mode, s, &next.state, &mut search.there);
        }
        search.nodes_known = false;
        *event = Some(next);
    }

    fn located(&mut self, event: &Event<S>) -> Located {
        let error = self.error_of(event);
        let &Event { guard, elapsed, residual, .. } = event;
        Located { guard, elapsed, error, residual, crossed: event.own() }
    }

    /// Adds the guards that cross zero behind the end of a step of size `h`, but within rounding of
    /// an event there.
    fn arrive_with(
        &mut self,
        event: &mut Event<S>,
        there: &PerGuard<S, f64>,
        values: &[PerGuard<S, f64>; 6],
        h: f64,
    ) {
        if self.phase.count() == 1 || h - event.elapsed > self.together(event.elapsed, h) {
            return;
        }
        let part = self.near_zero(event.elapsed);
        for guard in 0..self.phase.count() {
            let near = part * largest::<S>(guard, values);
            let near = there[guard].abs() <= near;
            if near
                && event.crossed[guard].is_none()
                && self.notes_of(guard).next().is_none()
                && let place = (&event.step, event.elapsed, &event.state)
                && let Some(crossed) = self.arrival(guard, place, ADDED, Some(event))
            {
                if event.latest.is_none() {
                    event.latest = Some(event.elapsed + self.error_of(event));
                }
                event.crossed[guard] = Some(crossed);
                if self.precedes(guard, event.guard) {
                    event.led_by(guard, there[guard].abs());
                }
            }
        }
    }

    /// Names the guards that are zero at an event, besides its own.
    fn name_simultaneous(
        &mut self,
        event: &mut Event<S>,
        there: &PerGuard<S, f64>,
        values: &[PerGuard<S, f64>; 6],
        h: f64,
    ) {
        for other in 0..self.phase.count() {
            // The largest value up to the event.
            let until = |node: usize| NODES[node] <= event.elapsed / h;
            let column = column::<S>(values, other);
            let sizes = (0..NODES.len()).filter(|&node| until(node)).map(|node| column[node].abs());
            // One that rests on zero all the time crosses nothing.
            let zero = event.elapsed > 0.0
                && column.iter().any(|value| *value != 0.0)
                && self.phase.guards[other].direction().has_values()
                && there[other].abs() <= TOGETHER * sizes.fold(0.0, f64::max);
            event.simultaneous[other] =
                other != event.guard && (zero || event.crossed[other].is_some());
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

    /// Whether guard `first` acts before guard `second` at one instant: it has the higher priority,
    /// or is listed first.
    pub(crate) fn precedes(&self, first: usize, second: usize) -> bool {
        self.phase.precedes(first, second)
    }
}

/// The search for the first event on a step.
struct Search<S: System> {
    /// Whether a guard may still fire no later than the event.
    open: PerGuard<S, bool>,
    /// The values of the guards at the event.
    there: PerGuard<S, f64>,
    /// The values at the nodes of the event's step, if they are known.
    nodes: [PerGuard<S, f64>; 6],
    nodes_known: bool,
    /// What was bounded along the event's step.
    sight: Option<Sight<S>>,
    /// The crossings that were located, if there are several.
    located: SmallVec<[Located; 2]>,
}

/// A crossing whose place is known, and how accurately.
#[derive(Clone, Copy)]
struct Located {
    guard: usize,
    elapsed: f64,
    error: f64,
    /// What the guard is at that place instead of zero, in size.
    residual: f64,
    crossed: Crossed,
}

impl Located {
    /// Whether the errors of the places of two crossings overlap, so that they are one instant.
    fn is_together_with(&self, other: &Self) -> bool {
        (self.elapsed - other.elapsed).abs() <= self.error + other.error
    }
}

/// A guard is not resolved on a step.
struct Unresolved;

/// Whether all guards stay clearly on the side where they do not fire. This holds on most steps.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "in a struct, the compiler keeps them in memory")]
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
            Direction::Off | Direction::Clock => true,
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
