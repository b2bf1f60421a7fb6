//! Which guard of a step fires first, if any.

use crate::error::RunError;
use crate::events::event::{Event, Found, bit};
use crate::events::examination::{Examination, column, confirmed};
use crate::events::isolate::{Beginning, Bracket};
use crate::events::one_guard::{Crossing, Status};
use crate::events::phase::Phase;
use crate::events::quick;
use crate::hybrid::{Direction, HybridSystem, Statistics, SwitchEvent};
use crate::method::{Method, Step};

/// Guards whose zeros are closer together than this part of the step fire together.
pub(crate) const TOGETHER: f64 = 1e-12;

impl<S, const N: usize, const G: usize> Examination<'_, S, N, G>
where
    S: HybridSystem<N, G>,
{
    /// Finds the first guard that fires on `step` and changes something, and writes it to `event`,
    /// which is empty. Guards that fire before it and change nothing are noted. `values` are those
    /// of the guards at the nodes of the step, and if all are `away` from zero, none fires.
    #[inline(never)]
    pub(crate) fn look<M: Method>(
        &mut self,
        step: &mut Step<N>,
        event: &mut Option<Event<N>>,
        values: &[[f64; G]; 6],
        away: bool,
    ) -> Result<Found<G>, RunError> {
        if away {
            return Ok(Found::Nothing(values[5]));
        }
        let statuses = self.glances::<M>(step, values);
        if statuses.iter().all(|&status| status == Status::Clear) {
            Ok(Found::Nothing(self.on_their_side::<M>(step, values)))
        } else {
            self.decide::<M>(step, event, values, statuses)
        }
    }

    /// Decides which guard fires first if the quick look alone does not tell that none fires.
    fn decide<M: Method>(
        &mut self,
        step: &mut Step<N>,
        event: &mut Option<Event<N>>,
        values: &[[f64; G]; 6],
        mut statuses: [Status; G],
    ) -> Result<Found<G>, RunError> {
        let end_values = self.on_their_side::<M>(step, values);
        // Where the part of the step begins that is still to be examined, for each guard.
        let mut beginnings: [Beginning; G] = std::array::from_fn(|guard| Beginning {
            theta: 0.0,
            value: self.phase.values[guard],
            zero_order: self.phase.zero_orders[guard],
        });
        let mut last: Option<f64> = None;
        loop {
            *event = None;
            let coarse = self.first::<M>(step, event, values, &mut statuses, &beginnings)?;
            if let Some(guard) = coarse {
                *event = None;
                return Ok(Found::TooCoarse(guard));
            }
            let Some(next) = event.as_mut() else {
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
    pub(crate) fn is_noted(&self, event: &Event<N>) -> bool {
        let about = self.phase.guards[event.guard];
        let before = self.notes_of(event.guard).count();
        if about.direction() == Direction::Below
            || before + 1 == about.fires_until_end() as usize
            || !event.state.iter().all(|value| value.is_finite())
        {
            return false;
        }
        let s = self.trial.s + event.elapsed;
        self.system.transition(self.phase.mode, event.guard, s, &event.state)
            == (self.phase.mode, event.state)
    }

    /// The notes of a guard on this step.
    pub(crate) fn notes_of(&self, guard: usize) -> impl Iterator<Item = &SwitchEvent<S::Mode, N>> {
        self.notes
            .iter()
            .filter(move |note| note.guard == guard || note.simultaneous & bit(guard) != 0)
    }

    /// Notes an event that changes nothing. If it is `together` with the one before, both are one.
    pub(crate) fn note(&mut self, event: &Event<N>, together: bool) {
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
        self.notes.push(SwitchEvent {
            s: self.trial.s + event.elapsed,
            guard: event.guard,
            simultaneous: 0,
            flatness: if largest == 0.0 { 0.0 } else { largest / event.slope },
            jump: event.jump,
            from: self.phase.mode,
            to: self.phase.mode,
            before: event.state,
            after: event.state,
        });
    }

    /// Finds the first guard that fires, whether or not it changes something, and writes it to
    /// `event`. Returns the guard for which the step is too coarse, if there is one. What isolation
    /// finds on the `full` step is kept.
    fn first<M: Method>(
        &mut self,
        step: &mut Step<N>,
        event: &mut Option<Event<N>>,
        full_values: &[[f64; G]; 6],
        full: &mut [Status; G],
        beginnings: &[Beginning; G],
    ) -> Result<Option<usize>, RunError> {
        let (mut values, mut statuses) = (*full_values, *full);
        loop {
            let first = self.earliest(&statuses);
            let starts = first.is_some_and(|(_, crossing)| crossing.bracket.high == 0.0);
            if (first.is_none() || starts) && statuses.contains(&Status::Unclear) {
                let shortened = event.is_some();
                let on = event.as_mut().map_or(&mut *step, |event| &mut event.step);
                // Whether a guard fires together with an event at the start shows after the event.
                let may_wait = starts || on.h <= TOGETHER * self.trial.h;
                for guard in 0..G {
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
                return Ok(None);
            };
            statuses[guard] = Status::Clear;
            let on = event.as_ref().map_or(&*step, |event| &event.step);
            let exact = self.wants_segments
                || event.is_some()
                || statuses.iter().any(|&status| status != Status::Clear);
            let Some(mut next) = self.locate::<M>(on, guard, &crossing, exact)? else {
                return Ok(Some(guard));
            };
            if next.elapsed == 0.0 {
                let at_start = |status: Status| match status {
                    Status::Fires(crossing) => crossing.bracket.high == 0.0,
                    _ => false,
                };
                next.simultaneous = mask(&statuses.map(at_start));
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
            let mut at_nodes = self.values_on(&next.step);
            let mut together = self.together(&next, &at_nodes);
            let on = event.as_mut().map_or(&mut *step, |event| &mut event.step);
            let others = (&together, &statuses);
            if let Some(preceding) = self.preceding::<M>(&next, on, &values, others, beginnings)? {
                // Of guards that fire together the one that precedes decides, even if rounding
                // puts another one earlier.
                next = preceding;
                statuses[next.guard] = Status::Clear;
                at_nodes = self.values_on(&next.step);
                together = self.together(&next, &at_nodes);
            }
            next.simultaneous = mask(&together);
            values = at_nodes;
            for (other, status) in statuses.iter_mut().enumerate() {
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
        step: &mut Step<N>,
        values: &[[f64; G]; 6],
        beginnings: &[Beginning; G],
    ) -> Result<Option<Status>, RunError> {
        let mut beginning = beginnings[guard];
        beginning.theta *= self.trial.h / step.h;
        if beginning.theta >= 1.0 {
            return Ok(Some(Status::Clear));
        }
        self.isolate::<M>(guard, step, &column(values, guard), beginning)
    }

    /// Whether guard `first` decides the transition if it fires together with guard `second`. The
    /// guard that does not yield decides; if both yield or neither does, the one listed first.
    pub(crate) fn precedes(&self, first: usize, second: usize) -> bool {
        let rank = |guard: usize| (self.phase.guards[guard].yields(), guard);
        rank(first) < rank(second)
    }

    /// The crossing with the smallest step fraction, and its guard. If two fractions are equal, the
    /// guard that precedes is taken.
    fn earliest(&self, statuses: &[Status; G]) -> Option<(usize, Crossing)> {
        let mut first: Option<(usize, Crossing)> = None;
        for (guard, status) in statuses.iter().enumerate() {
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
        event: &Event<N>,
        step: &mut Step<N>,
        values: &[[f64; G]; 6],
        (zero, statuses): (&[bool; G], &[Status; G]),
        beginnings: &[Beginning; G],
    ) -> Result<Option<Event<N>>, RunError> {
        for (first, &status) in statuses.iter().enumerate() {
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
    fn together(&mut self, event: &Event<N>, values: &[[f64; G]; 6]) -> [bool; G] {
        let there = if G == 1 {
            values[5]
        } else {
            self.statistics.guards += 1;
            let s = self.trial.s + event.elapsed;
            self.system.guard_values(self.phase.mode, s, &event.state)
        };
        std::array::from_fn(|other| {
            other != event.guard
                && self.phase.guards[other].direction() != Direction::Off
                && there[other].abs() <= TOGETHER * largest(other, values)
        })
    }
}

/// The guards of a set, one bit each.
fn mask<const G: usize>(guards: &[bool; G]) -> u64 {
    guards.iter().enumerate().fold(0, |bits, (guard, &one)| bits | if one { bit(guard) } else { 0 })
}

/// Whether all guards stay clearly on the side where they do not fire. This holds on most steps.
#[inline(always)]
pub(crate) fn all_clearly_away<S: HybridSystem<N, G>, const N: usize, const G: usize>(
    system: &S,
    phase: &Phase<S::Mode, G>,
    guard_scale: f64,
    step: &Step<N>,
    values: &[[f64; G]; 6],
    statistics: &mut Statistics,
) -> bool {
    // The verdicts are collected in an array, so that the loop is unrolled and the values stay in
    // registers.
    let away: [bool; G] = std::array::from_fn(|guard| {
        let column = column(values, guard);
        match phase.guards[guard].direction() {
            Direction::Off => true,
            Direction::Below => column[0] > 0.0 && quick::clearly_away(column),
            _ => quick::clearly_away(column),
        }
    });
    let read = S::READABLE && !phase.smooth;
    !phase.at_zero
        && !read
        && away == [true; G]
        && confirmed(system, phase, guard_scale, step, values, statistics) == [true; G]
}

/// The largest absolute value of a guard at the nodes of a step.
fn largest<const G: usize>(guard: usize, values: &[[f64; G]; 6]) -> f64 {
    column(values, guard).iter().fold(0.0, |size, value| size.max(value.abs()))
}
