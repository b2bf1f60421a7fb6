//! One step and its guards: which of them fires first, if any.

use crate::along_step::AlongStep;
use crate::error::RunError;
use crate::guard::Direction;
use crate::hybrid::{Grazing, HybridSystem, Observer, Statistics};
use crate::isolate::{Bracket, Touch, Verdict, first_crossing};
use crate::method::{Method, State, Step, Trial};
use crate::phase::Phase;
use crate::quick::{self, Quick};

/// Guards closer to a switch than this part of the step fire together with it.
const TOGETHER: f64 = 1e-12;

/// A guard that is zero throughout a step is looked at on longer ones, each four times as long as the one before, at most
/// this often: a step of the least length that moves the time becomes one of ordinary length.
const LONGER: i32 = 26;

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

/// What is known of a guard on the step at hand.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Status {
    Clear,
    Unclear,
    Fires(Crossing),
}

/// A crossing of `sign`·guard from ≥ 0 to < 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Crossing {
    pub(crate) sign: f64,
    pub(crate) bracket: Bracket,
}

impl Crossing {
    const fn at_start(sign: f64) -> Self {
        Self { sign, bracket: Bracket { low: 0.0, high: 0.0, guess: 0.0 } }
    }
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
            Ok(Found::Nothing(self.on_their_side(&values)))
        } else {
            self.decide::<M>(step, event, values, statuses)
        }
    }

    /// Whether all guards stay clearly on the side where they do not fire: true of most steps.
    #[inline(always)]
    fn all_clearly_away(&self, values: &[[f64; G]; 6]) -> bool {
        // An array of verdicts first, so that the loop is unrolled and the values stay in registers.
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
        let end_values = self.on_their_side(&values);
        loop {
            let first = self.earliest(&statuses);
            let Some((guard, crossing)) = first else {
                let on = event.as_mut().map_or(&mut *step, |event| &mut event.step);
                let mut found_any = false;
                for guard in 0..G {
                    if statuses[guard] == Status::Unclear {
                        let column = values.map(|at_node| at_node[guard]);
                        let Some(status) = self.isolate::<M>(guard, on, &column)? else {
                            *event = None;
                            return Ok(Found::TooCoarse(guard));
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
                // Of guards that fire together the one that precedes decides, wherever rounding puts the others.
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

    /// Whether guard `first` decides if it fires together with guard `second`: of both, the one that does not give way, and else
    /// the one listed first.
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

    /// The first of the guards that precede that of `event` and fire with it, where `step` is the one that `event` shortens, with its
    /// `values` and `statuses`.
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

    /// Values at a step's end; one that is exactly zero keeps the side from which it came, and so does one that has not yet come
    /// away from its zero.
    fn on_their_side(&self, values: &[[f64; G]; 6]) -> [f64; G] {
        std::array::from_fn(|guard| {
            let end = values[5][guard];
            if self.stays(guard, &values.map(|at_node| at_node[guard])) {
                return f64::MIN_POSITIVE.copysign(self.phase.sides[guard]);
            }
            if end != 0.0 {
                return end;
            }
            let mut before = values[..5].iter().rev().map(|at_node| at_node[guard]);
            let before = before.find(|&value| value != 0.0);
            before.map_or(end, |value| f64::MIN_POSITIVE.copysign(value))
        })
    }

    /// Whether a guard that starts from a known zero, and leaves it to a known side, has not yet come away from it.
    fn stays(&self, guard: usize, values: &[f64; 6]) -> bool {
        let hidden = self.phase.hidden[guard];
        self.phase.sides[guard] != 0.0 && values.iter().all(|value| value.abs() <= hidden)
    }

    /// Guards at [`quick::NODES`] of a step.
    #[inline(always)]
    fn values_on(&mut self, step: &Step<N>) -> [[f64; G]; 6] {
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

    /// What six values tell about a guard.
    fn glance<M: Method>(&self, guard: usize, values: &[[f64; G]; 6]) -> Status {
        let direction = self.phase.guards[guard].direction();
        if direction == Direction::Off {
            return Status::Clear;
        }
        if self.phase.due[guard] {
            return Status::Fires(Crossing::at_start(self.phase.sides[guard]));
        }
        let sign = if direction == Direction::Rising { -1.0 } else { 1.0 };
        let (order, side) = (self.phase.zero_orders[guard], sign * self.phase.sides[guard]);
        let column = values.map(|at_node| sign * at_node[guard]);
        let falls = |sign: f64, theta: f64| {
            Status::Fires(Crossing { sign, bracket: Bracket { low: 0.0, high: 1.0, guess: theta } })
        };
        let look = |sign: f64| {
            let look = quick::look(&column.map(|value| sign * value), order, M::QUICK_ERROR);
            // Against the side to which the guard is known to go rounding stands, or a crossing at once.
            match look {
                Quick::Positive | Quick::Falls { .. } if sign * side < 0.0 => Quick::Unclear,
                Quick::Negative if sign * side > 0.0 => Quick::Unclear,
                look => look,
            }
        };
        match look(1.0) {
            Quick::Negative if direction == Direction::Below => {
                Status::Fires(Crossing::at_start(sign))
            }
            Quick::Positive | Quick::Negative => Status::Clear,
            Quick::Falls { theta } => falls(sign, theta),
            Quick::Unclear if direction == Direction::Either => match look(-1.0) {
                Quick::Falls { theta } => falls(-1.0, theta),
                _ => Status::Unclear,
            },
            Quick::Unclear => Status::Unclear,
        }
    }

    /// Whether a guard that is zero throughout a step is so only because the step is short, and not throughout the longest step
    /// that meets the tolerance.
    fn leaves_zero<M: Method>(&mut self, guard: usize, step: &Step<N>) -> bool {
        let (system, mode) = (self.system, self.phase.mode);
        let mut longer = Step::blank();
        for k in 1..=LONGER {
            let h = step.h * 4_f64.powi(k);
            system.step::<M>(mode, &Trial { h, ..*self.trial }, &mut longer);
            self.statistics.resteps += 1;
            self.statistics.field += M::STAGES - 1 + usize::from(M::ERROR_USES_END);
            // Written so that NaN ends it.
            let good = longer.error < 1.0;
            if !good {
                return false;
            }
            let values = self.values_on(&longer).map(|at_node| at_node[guard]);
            if values[1..].iter().any(|&value| value != 0.0 && !value.is_nan()) {
                return true;
            }
        }
        false
    }

    /// Decides by isolation; `None` if the step is too coarse for that.
    fn isolate<M: Method>(
        &mut self,
        guard: usize,
        step: &mut Step<N>,
        values: &[f64; 6],
    ) -> Result<Option<Status>, RunError> {
        // At the start it may stand for the side from which the guard came.
        if values[0].abs() <= f64::MIN_POSITIVE && values[1..].iter().all(|&value| value == 0.0) {
            if step.h < self.trial.h {
                // It is asked on a longer step what becomes of it.
                return Ok(Some(Status::Clear));
            }
            let identically = RunError::GuardIdenticallyZero { guard, s: step.s };
            let leaves = self.leaves_zero::<M>(guard, step);
            return leaves.then_some(Some(Status::Clear)).ok_or(identically);
        }
        self.statistics.isolations += 1;
        let (system, mode) = (self.system, self.phase.mode);
        let dense = step.dense::<M>(&mut |s, y| system.field(mode, s, y));
        self.statistics.field += M::DENSE_STAGES - 1;
        let order = self.phase.zero_orders[guard];
        let signs: &[f64] = match self.phase.guards[guard].direction() {
            Direction::Rising => &[-1.0],
            Direction::Either => &[1.0, -1.0],
            _ => &[1.0],
        };
        let below = self.phase.guards[guard].direction() == Direction::Below;
        let end = if self.stays(guard, values) { 0.0 } else { values[5] };
        let mut found = Status::Clear;
        for &sign in signs {
            let mut curve = AlongStep::<'_, S, M, N, G> {
                system,
                mode,
                guard,
                sign,
                step,
                dense: &dense,
                statistics: &mut *self.statistics,
                method: std::marker::PhantomData,
            };
            let mut touches = [None; 8];
            let mut count = 0;
            let verdict = first_crossing(
                &mut curve,
                (order, sign * self.phase.sides[guard], self.phase.hidden[guard]),
                below,
                (sign * values[0], sign * end),
                |touch: Touch| {
                    if let Some(place) = touches.get_mut(count) {
                        *place = Some(touch);
                    }
                    count += 1;
                },
            )?;
            for touch in touches.into_iter().flatten() {
                self.statistics.grazings += 1;
                let s = step.s + touch.theta * step.h;
                self.observer.on_grazing(&Grazing { s, mode, guard, margin: sign * touch.margin });
            }
            let crossing = match verdict {
                Verdict::None => continue,
                Verdict::TooCoarse => return Ok(None),
                Verdict::StartsBelow => Crossing::at_start(sign),
                Verdict::Crossing(bracket) => Crossing { sign, bracket },
            };
            found = match found {
                Status::Fires(other) if other.bracket.low <= crossing.bracket.low => found,
                _ => Status::Fires(crossing),
            };
        }
        Ok(Some(found))
    }
}

/// Largest absolute value of a guard at the nodes of a step.
fn largest<const G: usize>(guard: usize, values: &[[f64; G]; 6]) -> f64 {
    values.iter().fold(0.0, |size, at_node| size.max(at_node[guard].abs()))
}
