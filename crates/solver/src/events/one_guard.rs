//! What one guard does on a step, by a quick look and by isolation.

use std::marker::PhantomData;

use crate::error::RunError;
use crate::events::along_step::{AlongStep, dense_output};
use crate::events::examination::Examination;
use crate::events::isolate::{Bracket, Touch, Verdict, first_crossing, sides};
use crate::events::quick::{self, Quick};
use crate::hybrid::{Direction, Grazing, HybridSystem, Observer};
use crate::method::{Method, Step, Trial};

/// A guard that is zero throughout a step is examined on longer steps, each four times as long as
/// the one before, at most this often. The shortest step that moves the time grows to ordinary
/// length that way.
const LONGER: i32 = 26;

/// What is known about a guard on the step at hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Status {
    /// The guard does not fire.
    Clear,
    /// The quick look could not decide.
    Unclear,
    /// The guard fires at this crossing.
    Fires(Crossing),
}

/// A crossing of `sign`·guard from ≥ 0 to < 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Crossing {
    pub(crate) sign: f64,
    pub(crate) bracket: Bracket,
}

impl Crossing {
    /// A crossing at the start of the step.
    pub(crate) const fn at_start(sign: f64) -> Self {
        Self { sign, bracket: Bracket { low: 0.0, high: 0.0, guess: 0.0 } }
    }
}

impl<S, O, const N: usize, const G: usize> Examination<'_, S, O, N, G>
where
    S: HybridSystem<N, G>,
    O: Observer<S::Mode, N>,
{
    /// What the six values of a guard tell about it.
    pub(crate) fn glance<M: Method>(&self, guard: usize, values: &[[f64; G]; 6]) -> Status {
        let direction = self.phase.guards[guard].direction();
        if direction == Direction::Off {
            return Status::Clear;
        }
        if self.phase.due[guard] {
            return Status::Fires(Crossing::at_start(self.phase.sides[guard]));
        }
        if self.stays(guard, &values.map(|at_node| at_node[guard])) {
            return Status::Clear;
        }
        let sign = if direction == Direction::Rising { -1.0 } else { 1.0 };
        let (order, side) = (self.phase.zero_orders[guard], sign * self.phase.sides[guard]);
        let column = values.map(|at_node| sign * at_node[guard]);
        let falls = |sign: f64, theta: f64| {
            Status::Fires(Crossing { sign, bracket: Bracket { low: 0.0, high: 1.0, guess: theta } })
        };
        let look = |sign: f64| {
            let look = quick::look(&column.map(|value| sign * value), order, M::QUICK_ERROR);
            // If the values contradict the side to which the guard is known to go, the reason is
            // rounding, or a crossing right after the start.
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

    /// Whether a guard that is zero throughout `step` becomes nonzero on a longer step that meets
    /// the tolerance. Then it is zero only because `step` is short.
    fn leaves_zero<M: Method>(&mut self, guard: usize, step: &Step<N>) -> bool {
        let (system, mode) = (self.system, self.phase.mode);
        let mut longer = Step::blank();
        for k in 1..=LONGER {
            let h = step.h * 4_f64.powi(k);
            system.step::<M>(mode, &Trial { h, ..*self.trial }, &mut longer);
            self.statistics.resteps += 1;
            self.statistics.field += M::STAGES - 1 + usize::from(M::ERROR_USES_END);
            // Written so that NaN ends the search.
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

    /// Decides about a guard by isolation. The result is `None` if the step is too coarse for that.
    pub(crate) fn isolate<M: Method>(
        &mut self,
        guard: usize,
        step: &mut Step<N>,
        values: &[f64; 6],
    ) -> Result<Option<Status>, RunError> {
        // A tiny value at the start may stand for the side from which the guard came.
        if values[0].abs() <= f64::MIN_POSITIVE && values[1..].iter().all(|&value| value == 0.0) {
            if step.h < self.trial.h {
                // A longer step will tell.
                return Ok(Some(Status::Clear));
            }
            let identically = RunError::GuardIdenticallyZero { guard, s: step.s };
            let leaves = self.leaves_zero::<M>(guard, step);
            return leaves.then_some(Some(Status::Clear)).ok_or(identically);
        }
        self.statistics.isolations += 1;
        let (system, mode) = (self.system, self.phase.mode);
        let dense = dense_output::<_, M, N, G>(system, mode, step);
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
                method: PhantomData,
            };
            let mut touches = [None; 8];
            let mut count = 0;
            let verdict = first_crossing(
                &mut curve,
                (order, sign * self.phase.sides[guard], self.phase.hidden[guard]),
                below,
                (sign * values[0], sign * end),
                &mut |touch: Touch| {
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

    /// The values of the guards at the end of a step. A value is replaced by the smallest number of
    /// the right sign in two cases: it is exactly zero, and the guard keeps the sign that it had
    /// before; or the guard is still at its known zero, and keeps the sign with which it leaves it.
    pub(crate) fn on_their_side<M: Method>(
        &mut self,
        step: &mut Step<N>,
        values: &[[f64; G]; 6],
    ) -> [f64; G] {
        let mut ends = values[5];
        for (guard, end) in ends.iter_mut().enumerate() {
            let column = values.map(|at_node| at_node[guard]);
            if self.stays(guard, &column) {
                *end = f64::MIN_POSITIVE.copysign(self.phase.sides[guard]);
            } else if *end == 0.0 && self.phase.guards[guard].direction() != Direction::Off {
                *end = self.last_side::<M>(guard, step, &column);
            }
        }
        ends
    }

    /// The smallest number with the sign that a guard had last, if it is zero where the step ends.
    /// The result is 0 if the guard shows no sign.
    fn last_side<M: Method>(&mut self, guard: usize, step: &mut Step<N>, values: &[f64; 6]) -> f64 {
        let (system, mode) = (self.system, self.phase.mode);
        let dense = dense_output::<_, M, N, G>(system, mode, step);
        self.statistics.field += M::DENSE_STAGES - 1;
        let statistics = &mut *self.statistics;
        let (sign, method) = (1.0, PhantomData);
        let mut curve: AlongStep<'_, S, M, N, G> =
            AlongStep { system, mode, guard, sign, step, dense: &dense, statistics, method };
        match sides(&mut curve, 0.0, 0.0) {
            Ok(Some([_, last])) if last != 0.0 => f64::MIN_POSITIVE.copysign(last),
            // Otherwise the last nonzero value at the nodes decides.
            _ => values[..5]
                .iter()
                .rev()
                .find(|&&value| value != 0.0)
                .map_or(0.0, |value| f64::MIN_POSITIVE.copysign(*value)),
        }
    }

    /// Whether a guard is still at the known zero from which it started, if its side after this
    /// zero is known.
    fn stays(&self, guard: usize, values: &[f64; 6]) -> bool {
        let hidden = self.phase.hidden[guard];
        self.phase.sides[guard] != 0.0 && values.iter().all(|value| value.abs() <= hidden)
    }
}
