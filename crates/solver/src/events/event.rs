//! One step and its guards: which of them fires first, if any.

use crate::error::RunError;
use crate::events::isolate::Bracket;
use crate::events::one_guard::{Crossing, Status};
use crate::events::phase::Phase;
use crate::events::quick;
use crate::hybrid::guard::Direction;
use crate::hybrid::{HybridSystem, Observer, Statistics};
use crate::method::{Method, State, Step, Trial};

/// Guards closer to a switch than this part of the step fire together with it.
const TOGETHER: f64 = 1e-12;

/// A guard fires on a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Event<const N: usize> {
    pub(crate) guard: usize,
    pub(crate) simultaneous: u32,
    /// Guards that crossed as well, at the same place or a hair before, and gave way to this one.
    pub(crate) passed: u32,
    /// Absolute slope of the guard there.
    pub(crate) slope: f64,
    /// From the start of the step.
    pub(crate) elapsed: f64,
    /// The state on the guard.
    pub(crate) state: State<N>,
    /// What is left of the guard's value there.
    pub(crate) residual: f64,
    /// The sign of the guard before it fired.
    pub(crate) sign: f64,
    /// The step that ends there.
    pub(crate) step: Step<N>,
}

impl<const N: usize> Event<N> {
    fn pass(&mut self, guard: usize) {
        self.passed |= bit(guard);
    }

    pub(crate) fn has_passed(&self, guard: usize) -> bool {
        self.passed & bit(guard) != 0
    }
}

/// 0 for guards that are too many to be told apart.
pub(crate) fn bit(guard: usize) -> u32 {
    if guard < 32 { 1 << guard } else { 0 }
}

/// The result of examining a step.
pub(crate) enum Found<const G: usize> {
    /// No guard fires; their values at the step's end.
    Nothing([f64; G]),
    /// A guard fires; the event is in its place.
    Event,
    /// This guard is not resolved: a shorter step is needed.
    TooCoarse(usize),
}

/// All that the examination of a step needs.
pub(crate) struct Examination<'a, S: HybridSystem<N, G>, O, const N: usize, const G: usize> {
    pub(crate) system: &'a S,
    pub(crate) phase: &'a Phase<S::Mode, G>,
    /// The step that was asked for.
    pub(crate) trial: &'a Trial<'a, N>,
    pub(crate) statistics: &'a mut Statistics,
    pub(crate) observer: &'a mut O,
}

impl<S, O, const N: usize, const G: usize> Examination<'_, S, O, N, G>
where
    S: HybridSystem<N, G>,
    O: Observer<S::Mode, N>,
{
    /// Finds the first guard that fires on `step`, and puts it into `event`, which is empty.
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

    /// Whether all guards stay clearly on the side where they do not fire: true of most steps.
    #[inline(always)]
    fn all_clearly_away(&self, values: &[[f64; G]; 6]) -> bool {
        // An array of verdicts first, so that the loop is unrolled and the values stay in
        // registers.
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
                            // It fires together with the event, or not: that shows behind it.
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
                    // Both fire at the end of the shortened step: the one that precedes stands.
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
                // Of guards that fire together the one that precedes decides, wherever rounding
                // puts the others.
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

    /// Whether guard `first` decides if it fires together with guard `second`: of both, the one
    /// that does not give way, and else the one listed first.
    fn precedes(&self, first: usize, second: usize) -> bool {
        let rank = |guard: usize| (self.phase.guards[guard].gives_way(), guard);
        rank(first) < rank(second)
    }

    /// The crossing with the least step fraction; of equal ones that of the guard that precedes.
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

    /// The first of the guards that precede that of `event` and fire with it, where `step` is the
    /// one that `event` shortens, with its `values` and `statuses`.
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
                // From close to a zero that is known the search would find that one.
                let known = self.phase.sides[first] != 0.0;
                let guess = if known { bracket.guess } else { guess };
                let crossing = Crossing { sign, bracket: Bracket { guess, ..bracket } };
                let mut preceding = self.locate::<M>(step, first, &crossing, true)?;
                // One that touches zero here may fire elsewhere.
                if (preceding.elapsed - event.elapsed).abs() <= TOGETHER * event.elapsed {
                    preceding.passed = event.passed;
                    preceding.pass(event.guard);
                    return Ok(Some(preceding));
                }
            }
        }
        Ok(None)
    }

    /// Guards other than `guard` that are at zero where the step ends.
    fn simultaneous(&self, guard: usize, values: &[[f64; G]; 6]) -> u32 {
        (0..G.min(32))
            .filter(|&other| {
                other != guard
                    && self.phase.guards[other].direction() != Direction::Off
                    && values[5][other].abs() <= TOGETHER * largest(other, values)
            })
            .fold(0, |bits, other| bits | 1 << other)
    }

    /// Guards at [`quick::NODES`] of a step.
    #[inline(always)]
    pub(crate) fn values_on(&mut self, step: &Step<N>) -> [[f64; G]; 6] {
        let at = |theta: f64, y: &State<N>| {
            self.system.guard_values(self.phase.mode, step.s + theta * step.h, y)
        };
        self.statistics.guards += 5;
        [
            self.phase.values,
            at(quick::NODES[1], &step.interior[0]),
            at(quick::NODES[2], &step.interior[1]),
            at(quick::NODES[3], &step.interior[2]),
            at(quick::NODES[4], &step.interior[3]),
            at(1.0, &step.y1),
        ]
    }
}

/// Largest absolute value of a guard at the nodes of a step.
fn largest<const G: usize>(guard: usize, values: &[[f64; G]; 6]) -> f64 {
    values.iter().fold(0.0, |size, at_node| size.max(at_node[guard].abs()))
}
