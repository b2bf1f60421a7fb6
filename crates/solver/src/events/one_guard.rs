//! What one guard does on a step, by a quick look and by isolation.

use std::marker::PhantomData;

use smallvec::SmallVec;

use crate::error::RunError;
use crate::events::along_step::{
    AlongStep, EnclosedAlongStep, dense_output, first_side, repeated_step, rounding, start_rate,
};
use crate::events::arrival::SAME;
use crate::events::by_bounds::Sight;
use crate::events::examination::{Examination, column};
use crate::events::isolate::{
    Beginning, Bracket, Notice, Task, Verdict, first_crossing, first_enclosed_crossing,
    last_enclosed_sign, last_sign, noise, rests,
};
use crate::events::notices::{FEW, Noticed};
use crate::events::path::Path;
use crate::events::sidestep::resolution;
use crate::events::status::{Crossing, Status};
use crate::hybrid::Direction;
use crate::lists::{List, Shape};
use crate::method::{Method, StepOf, Store, TrialOf};
use crate::system::{PerGuard, System};
use stickslip_number::{Enclosure, Interval};

/// A guard that is zero throughout a step is examined on longer steps, each four times as long as
/// the one before, at most this often. The shortest step that moves the time grows to ordinary
/// length that way.
pub(crate) const LONGER: i32 = 26;

impl<S: System> Examination<'_, S> {
    /// Whether bounds decide about a guard of a readable system. In conditions, `S::READABLE` comes
    /// first: it is a constant, so that black boxes are compiled without the code for bounds.
    #[inline(always)]
    fn has_bounds(&self, guard: usize) -> bool {
        !self.phase.guards[guard].is_smooth()
    }

    /// What a quick look at a step shows about each guard.
    pub(crate) fn glances<M: Method>(
        &mut self,
        step: &StepOf<S::State>,
        values: &[PerGuard<S, f64>; 6],
    ) -> PerGuard<S, Status> {
        let mut confirmed = self.room.bools();
        self.confirmed(step, values, &mut confirmed);
        let mut sight = None;
        let mut statuses = self.room.statuses();
        for guard in 0..self.phase.count() {
            statuses[guard] = if confirmed[guard] {
                self.glance_at::<M>(guard, step, values, &mut sight)
            } else if !self.phase.guards[guard].direction().has_values() {
                Status::Clear
            } else {
                Status::Unclear
            };
        }
        self.room.give_bools(confirmed);
        statuses
    }

    /// What a quick look at a step shows about a guard. `sight` along the step is made if it is
    /// needed.
    pub(crate) fn glance_at<M: Method>(
        &mut self,
        guard: usize,
        step: &StepOf<S::State>,
        values: &[PerGuard<S, f64>; 6],
        sight: &mut Option<Sight<S>>,
    ) -> Status {
        let column = column::<S>(values, guard);
        if !self.phase.guards[guard].direction().has_values() {
            Status::Clear
        } else if S::READABLE && self.has_bounds(guard) {
            let sight = sight.get_or_insert_with(|| {
                let reads = self.system.reads(self.phase.mode);
                Sight::along(Path::quick(step, M::QUICK_ERROR, reads))
            });
            self.glance_at_bounds::<M>(guard, &column, sight)
        } else {
            self.glance::<M>(guard, &column)
        }
    }

    /// What the six values of a guard show about it.
    fn glance<M: Method>(&self, guard: usize, column: &[f64; 6]) -> Status {
        let (direction, order) =
            (self.phase.guards[guard].direction(), self.phase.zero_orders[guard]);
        Status::from_values(column, direction, order, M::QUICK_ERROR)
    }

    /// Whether a guard that is zero throughout `step` becomes nonzero on a longer step that meets
    /// the tolerance. Then it is zero only because `step` is short.
    fn leaves_zero<M: Method>(&mut self, guard: usize, step: &StepOf<S::State>) -> bool {
        let (system, mode) = (self.system, self.phase.mode);
        let mut values = [(); 6].map(|()| self.room.row());
        for k in 1..=LONGER {
            let longer = TrialOf { h: step.h * 4_f64.powi(k), ..*self.trial };
            let longer = repeated_step::<S, M>(system, mode, &longer, self.statistics, self.room);
            // Written so that NaN ends the search.
            let good = longer.error < 1.0;
            if !good {
                return false;
            }
            self.values_on(&longer, &mut values);
            let values = column::<S>(&values, guard);
            if values[1..].iter().any(|&value| value != 0.0 && !value.is_nan()) {
                return true;
            }
        }
        false
    }

    /// Whether a guard of a readable system rests on zero from a step fraction on, and is not zero
    /// whatever the state is.
    fn rests<M: Method>(&mut self, guard: usize, step: &mut StepOf<S::State>, first: f64) -> bool {
        let (system, mode) = (self.system, self.phase.mode);
        let read = system.reads(mode);
        let any = List::made(S::Components::count(&read, step.y0.size()), |_| Enclosure::ENTIRE);
        self.statistics.enclosures += 1;
        if system.enclose(mode, Enclosure::ENTIRE, &any)[guard].value == Interval::ZERO {
            return false;
        }
        let mut dense = self.room.dense();
        dense_output::<_, M>(system, mode, step, &mut dense);
        self.statistics.field += M::DENSE_STAGES - 1;
        let (sign, path) = (1.0, Path::dense(&dense, read));
        let (statistics, room) = (&mut *self.statistics, &mut *self.room);
        let (dense_output, method) = (&dense, PhantomData::<M>);
        let along = AlongStep {
            system,
            mode,
            guard,
            sign,
            step,
            dense: dense_output,
            statistics,
            room,
            method,
        };
        let mut enclosed = EnclosedAlongStep { along, path, local: None };
        let rests = rests(&mut enclosed, first, resolution(step.s, step.h));
        self.room.give_dense(dense);
        rests
    }

    /// Decides about a guard by isolation, from `beginning` on. The result is `None` if the step is
    /// too coarse for that.
    pub(crate) fn isolate<M: Method>(
        &mut self,
        guard: usize,
        step: &mut StepOf<S::State>,
        values: &[f64; 6],
        beginning: Beginning,
    ) -> Result<Option<Status>, RunError> {
        let found = self.isolate_from::<M>(guard, step, values, beginning)?;
        let at_start = beginning.theta == 0.0;
        let forgiven = at_start && self.phase.zero_by_rounding[guard] && beginning.zero_order > 0;
        if found.is_some() || !at_start || beginning.zero_order > 0 && !forgiven {
            return Ok(found);
        }
        let at = (self.phase.mode, guard);
        let rate = if forgiven {
            start_rate(self.system, at, step, self.statistics, self.room)
        } else {
            let (s, y) = (step.s, &step.y0);
            let (hidden, count) = rounding(self.system, at, (s, y), (s, y), self.room);
            self.statistics.guards += count;
            if values[0].abs() > hidden {
                return Ok(None);
            }
            values[0].signum()
        };
        // It shows first beyond zero, and has not been seen to start in that direction: rounding
        // hides how it comes back.
        let side = first_side(self.system, at, step, self.statistics, self.room);
        let direction = self.phase.guards[guard].direction();
        if side != 0.0 && direction.fires_from(-side) && rate != side {
            let bracket = Bracket { low: 0.0, high: 1.0, guess: 0.0, rests: false };
            return Ok(Some(Status::Fires(Crossing { sign: -side, bracket })));
        }
        if rate == 0.0 {
            // It is not a zero that can be divided out, so its sign counts.
            let beginning = Beginning { zero_order: 0, ..beginning };
            return self.isolate_from::<M>(guard, step, values, beginning);
        }
        Ok(None)
    }

    /// Decides about a guard whose zero at the start is certain, if it is said to have one.
    fn isolate_from<M: Method>(
        &mut self,
        guard: usize,
        step: &mut StepOf<S::State>,
        values: &[f64; 6],
        beginning: Beginning,
    ) -> Result<Option<Status>, RunError> {
        // A tiny value at the start may stand for the side from which the guard came.
        let is_zero =
            values[0].abs() <= f64::MIN_POSITIVE && values[1..].iter().all(|&value| value == 0.0);
        // Zeros of higher order have no bounds.
        let bounded = S::READABLE && self.has_bounds(guard) && beginning.zero_order <= 2;
        if is_zero && !(bounded && self.rests::<M>(guard, step, beginning.theta)) {
            if step.h < self.trial.h {
                // A longer step will decide.
                return Ok(Some(Status::Clear));
            }
            let identically = RunError::GuardIdenticallyZero { guard, s: step.s };
            let leaves = self.leaves_zero::<M>(guard, step);
            return leaves.then_some(Some(Status::Clear)).ok_or(identically);
        }
        if values[0].is_nan() {
            return Err(RunError::GuardNotANumber { guard, s: step.s });
        }
        if S::READABLE && values.iter().any(|value| value.is_nan()) {
            // Bounds decide nothing where a guard has no value.
            return Ok(None);
        }
        self.statistics.isolations += 1;
        let (system, mode) = (self.system, self.phase.mode);
        let mut dense = self.room.dense();
        dense_output::<_, M>(system, mode, step, &mut dense);
        self.statistics.field += M::DENSE_STAGES - 1;
        let direction = self.phase.guards[guard].direction();
        let resolution = resolution(step.s, step.h);
        let mut found = Status::Clear;
        // One search by bounds finds both directions. A second one would resolve all poles of the
        // step again after each event.
        let both = bounded && direction == Direction::Either;
        let signs = if both { &[1.0] } else { direction.signs() };
        for &sign in signs {
            let (statistics, method) = (&mut *self.statistics, PhantomData::<M>);
            let (dense, room) = (&dense, &mut *self.room);
            let mut along =
                AlongStep { system, mode, guard, sign, step, dense, statistics, room, method };
            let mut noticed = SmallVec::<[Notice; FEW]>::new();
            let mut notice = |found: Notice| noticed.push(found);
            let task = Task {
                beginning: Beginning { value: sign * beginning.value, ..beginning },
                domain: direction == Direction::Below,
                both,
                end: sign * values[5],
                resolution,
                widest: self.guard_scale / step.h,
            };
            let verdict = if bounded {
                let mut enclosed = EnclosedAlongStep {
                    along,
                    path: Path::dense(dense, system.reads(mode)),
                    local: None,
                };
                first_enclosed_crossing(&mut enclosed, &task, &mut notice)?
            } else {
                first_crossing(&mut along, &task, &mut notice)?
            };
            self.collect(guard, sign, step, &noticed);
            let crossing = match verdict {
                Verdict::None => continue,
                Verdict::TooCoarse => return Ok(None),
                // Rounding hides how it leaves its zero on a step as short as this.
                Verdict::Flat if step.h < self.trial.h => {
                    match values.iter().map(|value| sign * value).find(|&value| value != 0.0) {
                        Some(value) if value < 0.0 => Crossing::at_start(sign),
                        _ => continue,
                    }
                }
                Verdict::Flat => {
                    return Err(RunError::GuardIdenticallyZero { guard, s: step.s });
                }
                Verdict::StartsBelow => Crossing::at_start(sign),
                Verdict::Crossing(bracket) => Crossing { sign, bracket },
                Verdict::Rise(bracket) => Crossing { sign: -sign, bracket },
            };
            found = match found {
                Status::Fires(other) if other.bracket.low <= crossing.bracket.low => found,
                _ => Status::Fires(crossing),
            };
        }
        self.room.give_dense(dense);
        Ok(Some(found))
    }

    /// Collects what isolation noticed of a guard.
    fn collect(&mut self, guard: usize, sign: f64, step: &StepOf<S::State>, noticed: &[Notice]) {
        for &notice in noticed {
            let found = Noticed::of(notice, (guard, sign), self.phase.mode, (step.s, step.h));
            self.notices.add(found, step.h);
        }
    }

    /// The values of the guards at the end of a step. A value that is exactly zero is replaced by
    /// the smallest number with the sign that the guard had before.
    pub(crate) fn on_their_side<M: Method>(
        &mut self,
        step: &mut StepOf<S::State>,
        values: &[PerGuard<S, f64>; 6],
    ) -> PerGuard<S, f64> {
        let mut ends = self.room.row();
        ends.set(&values[5]);
        for guard in 0..self.phase.count() {
            if ends[guard] == 0.0 && self.phase.guards[guard].direction().has_values() {
                let column = column::<S>(values, guard);
                ends[guard] = self.last_side::<M>(guard, step, &column);
            }
        }
        ends
    }

    /// Where on `step` a guard that crosses zero at `place`, and surely before `theta`, has left
    /// the noise of its values: at `theta`, if the two are not very close, or behind it. The result
    /// is 1 if that does not happen.
    pub(crate) fn past_noise<M: Method>(
        &mut self,
        guard: usize,
        step: &mut StepOf<S::State>,
        (place, mut theta): (f64, f64),
        end: f64,
    ) -> f64 {
        let is_near = theta - place <= SAME || theta >= 1.0 - SAME;
        if !is_near || theta >= 1.0 {
            return theta;
        }
        let (system, mode) = (self.system, self.phase.mode);
        let mut dense = self.room.dense();
        dense_output::<_, M>(system, mode, step, &mut dense);
        self.statistics.field += M::DENSE_STAGES - 1;
        let mut y = self.room.state();
        let mut value = |theta: f64| {
            dense.write(theta, &mut y);
            self.statistics.guards += 1;
            self.room.value(system, (mode, guard), step.s + theta * step.h, &y)
        };
        let mut reach = SAME;
        let left = loop {
            let at_end = theta >= 1.0 - SAME;
            let low = if at_end { 1.0 - SAME } else { theta };
            let noise = noise(&mut value, low, low + SAME, [0.0, 1.0 / 3.0, 2.0 / 3.0]);
            let there = if at_end { end } else { value(theta) };
            if there.abs() > noise {
                break theta;
            }
            if at_end {
                break 1.0;
            }
            theta = (theta + reach).min(1.0 - SAME);
            reach *= 2.0;
        };
        self.room.give(y);
        self.room.give_dense(dense);
        left
    }

    /// The smallest number with the sign that a guard had last, if it is zero where the step ends.
    /// The result is 0 if the guard shows no sign.
    fn last_side<M: Method>(
        &mut self,
        guard: usize,
        step: &mut StepOf<S::State>,
        values: &[f64; 6],
    ) -> f64 {
        let bounded = self.has_bounds(guard);
        let (system, mode) = (self.system, self.phase.mode);
        let mut dense = self.room.dense();
        dense_output::<_, M>(system, mode, step, &mut dense);
        self.statistics.field += M::DENSE_STAGES - 1;
        let (sign, resolution) = (1.0, resolution(step.s, step.h));
        let (statistics, method) = (&mut *self.statistics, PhantomData::<M>);
        let mut along = AlongStep {
            system,
            mode,
            guard,
            sign,
            step,
            dense: &dense,
            statistics,
            room: &mut *self.room,
            method,
        };
        let last = if S::READABLE && bounded {
            let mut enclosed = EnclosedAlongStep {
                along,
                path: Path::dense(&dense, system.reads(mode)),
                local: None,
            };
            last_enclosed_sign(&mut enclosed, values[0], resolution).map(Some)
        } else {
            last_sign(&mut along, resolution)
        };
        self.room.give_dense(dense);
        match last {
            Ok(Some(last)) if last != 0.0 => f64::MIN_POSITIVE.copysign(last),
            // Otherwise the last nonzero value at the nodes decides.
            _ => side_before(values),
        }
    }
}

/// The side on which a guard that is zero or has no value where a step ends has been, by its values
/// at the other nodes.
pub(crate) fn side_before(values: &[f64; 6]) -> f64 {
    let last = values[..5].iter().rev().find(|value| value.abs() > 0.0);
    last.map_or(0.0, |value| f64::MIN_POSITIVE.copysign(*value))
}
