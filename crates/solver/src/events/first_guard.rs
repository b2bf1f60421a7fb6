//! Which guard of a step fires first, if any.

use crate::error::RunError;
use crate::events::event::{Event, Found, bit};
use crate::events::examination::Examination;
use crate::events::isolate::Bracket;
use crate::events::one_guard::{Crossing, Status};
use crate::events::quick;
use crate::hybrid::{Direction, HybridSystem, Observer};
use crate::method::{Method, Step};

/// Guards whose zeros are closer together than this part of the step fire together.
const TOGETHER: f64 = 1e-12;

impl<S, O, const N: usize, const G: usize> Examination<'_, S, O, N, G>
where
    S: HybridSystem<N, G>,
    O: Observer<S::Mode, N>,
{
    /// Finds the first guard that fires on `step`, and writes it to `event`, which is empty.
    #[inline]
    pub(crate) fn look<M: Method>(
        &mut self,
        step: &mut Step<N>,
        event: &mut Option<Event<N>>,
    ) -> Result<Found<G>, RunError> {
        if G == 0 {
            return Ok(Found::Nothing(self.phase.values));
        }
        let values = self.values_on(step);
        if self.all_clearly_away(&values) {
            return Ok(Found::Nothing(values[5]));
        }
        let statuses = std::array::from_fn(|guard| self.glance::<M>(guard, &values));
        if statuses.iter().all(|&status| status == Status::Clear) {
            Ok(Found::Nothing(self.on_their_side::<M>(step, &values)))
        } else {
            self.decide::<M>(step, event, values, statuses)
        }
    }

    /// Whether all guards stay clearly on the side where they do not fire. This holds on most
    /// steps.
    #[inline(always)]
    fn all_clearly_away(&self, values: &[[f64; G]; 6]) -> bool {
        // The verdicts are collected in an array, so that the loop is unrolled and the values stay
        // in registers.
        let away: [bool; G] = std::array::from_fn(|guard| {
            let column = values.map(|at_node| at_node[guard]);
            match self.phase.guards[guard].direction() {
                Direction::Off => true,
                Direction::Below => column[0] > 0.0 && quick::clearly_away(column),
                _ => quick::clearly_away(column),
            }
        });
        !self.phase.at_zero && away == [true; G]
    }

    /// Decides which guard fires first if the quick look alone does not tell that none fires.
    fn decide<M: Method>(
        &mut self,
        step: &mut Step<N>,
        event: &mut Option<Event<N>>,
        mut values: [[f64; G]; 6],
        mut statuses: [Status; G],
    ) -> Result<Found<G>, RunError> {
        let end_values = self.on_their_side::<M>(step, &values);
        loop {
            let first = self.earliest(&statuses);
            let Some((guard, crossing)) = first else {
                let on = event.as_mut().map_or(&mut *step, |event| &mut event.step);
                let mut found_any = false;
                for guard in 0..G {
                    if statuses[guard] == Status::Unclear {
                        let column = values.map(|at_node| at_node[guard]);
                        let at_start = on.h <= TOGETHER * self.trial.h;
                        let status = match self.isolate::<M>(guard, on, &column)? {
                            Some(status) => status,
                            // Whether it fires together with the event shows after the event.
                            None if at_start => Status::Clear,
                            None => {
                                *event = None;
                                return Ok(Found::TooCoarse(guard));
                            }
                        };
                        found_any |= status != Status::Clear;
                        statuses[guard] = status;
                    }
                }
                if found_any {
                    continue;
                }
                let nothing = Found::Nothing(end_values);
                return Ok(if event.is_some() { Found::Event } else { nothing });
            };
            statuses[guard] = Status::Clear;
            let on = event.as_ref().map_or(&*step, |event| &event.step);
            let exact = O::WANTS_SEGMENTS
                || event.is_some()
                || statuses.iter().any(|&status| status != Status::Clear);
            let mut next = self.locate::<M>(on, guard, &crossing, exact)?;
            if next.elapsed == 0.0 {
                *event = Some(next);
                return Ok(Found::Event);
            }
            if let Some(event) = event.as_mut()
                && next.elapsed >= (1.0 - TOGETHER) * event.elapsed
            {
                if self.precedes(event.guard, guard) {
                    // Both fire at the end of the shortened step, and the event's guard precedes.
                    event.pass(guard);
                    continue;
                }
                next.passed = event.passed;
                next.pass(event.guard);
            }
            let mut at_nodes = self.values_on(&next.step);
            next.simultaneous = self.simultaneous(guard, &at_nodes);
            let on = event.as_mut().map_or(&mut *step, |event| &mut event.step);
            if let Some(preceding) = self.preceding::<M>(&next, on, &values, &statuses)? {
                // Of guards that fire together the one that precedes decides, even if rounding
                // puts another one earlier.
                next = preceding;
                statuses[next.guard] = Status::Clear;
                at_nodes = self.values_on(&next.step);
                next.simultaneous = self.simultaneous(next.guard, &at_nodes);
            }
            values = at_nodes;
            for (other, status) in statuses.iter_mut().enumerate() {
                if *status != Status::Clear {
                    *status = self.glance::<M>(other, &values);
                }
            }
            *event = Some(next);
        }
    }

    /// Whether guard `first` decides the transition if it fires together with guard `second`. The
    /// guard that does not yield decides; if both yield or neither does, the one listed first.
    fn precedes(&self, first: usize, second: usize) -> bool {
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
    /// `step` is the step before `event` shortens it; `values` and `statuses` belong to that step.
    fn preceding<M: Method>(
        &mut self,
        event: &Event<N>,
        step: &mut Step<N>,
        values: &[[f64; G]; 6],
        statuses: &[Status; G],
    ) -> Result<Option<Event<N>>, RunError> {
        for first in 0..G.min(32) {
            if event.simultaneous & bit(first) == 0 || !self.precedes(first, event.guard) {
                continue;
            }
            let mut status = statuses[first];
            if status == Status::Unclear {
                let column = values.map(|at_node| at_node[first]);
                status = self.isolate::<M>(first, step, &column)?.unwrap_or(Status::Unclear);
            }
            let Status::Fires(Crossing { sign, bracket }) = status else { continue };
            let guess = event.elapsed / step.h;
            let Bracket { low, high, .. } = bracket;
            if low <= (1.0 + TOGETHER) * guess && (1.0 - TOGETHER) * guess <= high {
                // If the guard starts from a known zero, a search that begins close to it would
                // find that zero again.
                let known = self.phase.sides[first] != 0.0;
                let guess = if known { bracket.guess } else { guess };
                let crossing = Crossing { sign, bracket: Bracket { guess, ..bracket } };
                let mut preceding = self.locate::<M>(step, first, &crossing, true)?;
                // A guard that only touches zero here may fire elsewhere.
                if (preceding.elapsed - event.elapsed).abs() <= TOGETHER * event.elapsed {
                    preceding.passed = event.passed;
                    preceding.pass(event.guard);
                    return Ok(Some(preceding));
                }
            }
        }
        Ok(None)
    }

    /// The guards other than `guard` that are zero where the step ends, one bit each.
    fn simultaneous(&self, guard: usize, values: &[[f64; G]; 6]) -> u32 {
        (0..G.min(32))
            .filter(|&other| {
                other != guard
                    && self.phase.guards[other].direction() != Direction::Off
                    && values[5][other].abs() <= TOGETHER * largest(other, values)
            })
            .fold(0, |bits, other| bits | 1 << other)
    }
}

/// The largest absolute value of a guard at the nodes of a step.
fn largest<const G: usize>(guard: usize, values: &[[f64; G]; 6]) -> f64 {
    values.iter().fold(0.0, |size, at_node| size.max(at_node[guard].abs()))
}
