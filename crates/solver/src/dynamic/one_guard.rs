//! What one guard of a dynamic system does on a step: what [`crate::events::one_guard`] does for
//! black boxes, on buffers.

use std::marker::PhantomData;

use smallvec::SmallVec;

use crate::dynamic::curve::{AlongStep, Work};
use crate::dynamic::examination::Examination;
use crate::dynamic::step::Step;
use crate::dynamic::system::DynamicSystem;
use crate::error::RunError;
use crate::events::aside::resolution;
use crate::events::isolate::{Beginning, Notice, Task, Verdict, first_crossing, last_sign};
use crate::events::notices::{FEW, Noticed};
use crate::events::one_guard::{Crossing, LONGER, Status, side_before};
use crate::events::quick::{self, BETWEEN, NODES, between};
use crate::hybrid::Direction;
use crate::method::Method;

impl<S: DynamicSystem> Examination<'_, S> {
    /// Evaluates the guards at the nodes of `step`.
    pub(crate) fn fill_nodes<M: Method>(&mut self, step: &mut Step) {
        let field = self.field();
        self.statistics.field += step.fill_interior::<M>(&field, self.origin);
        let count = self.phase.values.len();
        let nodes = &mut self.tables.nodes;
        nodes.clear();
        nodes.extend_from_slice(&self.phase.values);
        nodes.resize(NODES.len() * count, 0.0);
        let states = step.nodes(self.origin);
        for (node, state) in states.into_iter().enumerate().skip(1) {
            let s = self.origin.s + NODES[node] * step.h;
            let values = &mut nodes[node * count..(node + 1) * count];
            self.system.guard_values(self.phase.mode, s, state, values);
        }
        self.statistics.guards += NODES.len() - 1;
    }

    /// Whether all guards stay clearly on the side where they do not fire. This holds on most
    /// steps.
    pub(crate) fn all_clearly_away(&mut self, step: &Step) -> bool {
        let count = self.phase.values.len();
        let away = |guard: usize| {
            let column = self.tables.column(guard, count);
            match self.phase.guards[guard].direction() {
                Direction::Off => true,
                Direction::Below => column[0] > 0.0 && quick::clearly_away(column),
                _ => quick::clearly_away(column),
            }
        };
        if self.phase.at_zero || !(0..count).all(away) {
            return false;
        }
        self.confirm(step);
        self.tables.confirmed.iter().all(|&confirmed| confirmed)
    }

    /// Finds out for each guard whether its values between the nodes are those that the values at
    /// the nodes predict.
    pub(crate) fn confirm(&mut self, step: &Step) {
        let count = self.phase.values.len();
        let tables = &mut *self.tables;
        tables.confirmed.clear();
        tables.confirmed.resize(count, self.phase.smooth || step.h <= self.guard_scale);
        if self.phase.smooth || step.h > self.guard_scale {
            return;
        }
        self.statistics.guards += BETWEEN.len();
        let states = step.nodes(self.origin);
        for (place, theta) in BETWEEN.into_iter().enumerate() {
            let Work { state, values, .. } = &mut *self.work;
            for (i, component) in state.iter_mut().enumerate() {
                *component = between(place, &states.map(|state| state[i]));
            }
            let s = self.origin.s + theta * step.h;
            self.system.guard_values(self.phase.mode, s, state, values);
            for (guard, &found) in values.iter().enumerate() {
                let column = tables.column(guard, count);
                let expected = between(place, &column);
                let size = column.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
                // NaN is not confirmed.
                let off = (found - expected).abs();
                let sure = self.phase.guards[guard].needs_no_look();
                tables.confirmed[guard] &= sure || off <= (0.5 * expected.abs()).max(0.01 * size);
            }
        }
    }

    /// What the six values of a guard tell about it, if they are confirmed.
    pub(crate) fn glance<M: Method>(&self, guard: usize) -> Status {
        let direction = self.phase.guards[guard].direction();
        if direction == Direction::Off {
            return Status::Clear;
        }
        if !self.tables.confirmed[guard] {
            return Status::Unclear;
        }
        let column = self.tables.column(guard, self.phase.values.len());
        let order = self.phase.zero_orders[guard];
        Status::from_values(&column, direction, order, M::QUICK_ERROR)
    }

    /// Decides about a guard by isolation, from its beginning on. The result is `None` if the step
    /// is too coarse for that.
    pub(crate) fn isolate<M: Method>(
        &mut self,
        guard: usize,
        step: &mut Step,
    ) -> Result<Option<Status>, RunError> {
        let beginning = self.tables.beginnings[guard];
        let found = self.isolate_from::<M>(guard, step, beginning)?;
        if found.is_none() && self.phase.forgiven[guard] && beginning.zero_order > 0 {
            // It is not a zero that can be divided out, so its sign counts.
            let beginning = Beginning { zero_order: 0, ..beginning };
            return self.isolate_from::<M>(guard, step, beginning);
        }
        Ok(found)
    }

    /// Decides about a guard whose zero at the start is certain, if it is said to have one.
    fn isolate_from<M: Method>(
        &mut self,
        guard: usize,
        step: &mut Step,
        beginning: Beginning,
    ) -> Result<Option<Status>, RunError> {
        let column = self.tables.column(guard, self.phase.values.len());
        // A tiny value at the start may stand for the side from which the guard came.
        if column[0].abs() <= f64::MIN_POSITIVE && column[1..].iter().all(|&value| value == 0.0) {
            let identically = RunError::GuardIdenticallyZero { guard, s: self.origin.s };
            let leaves = self.leaves_zero::<M>(guard, step.h);
            return leaves.then_some(Some(Status::Clear)).ok_or(identically);
        }
        if column[0].is_nan() {
            return Err(RunError::GuardNotANumber { guard, s: self.origin.s });
        }
        self.statistics.isolations += 1;
        self.extend::<M>(step);
        let direction = self.phase.guards[guard].direction();
        let mut found = Status::Clear;
        for &sign in direction.signs() {
            let mut noticed = SmallVec::<[Notice; FEW]>::new();
            let mut notice = |found: Notice| noticed.push(found);
            let task = Task {
                beginning: Beginning { value: sign * beginning.value, ..beginning },
                both: false,
                domain: direction == Direction::Below,
                end: sign * column[5],
                resolution: resolution(self.origin.s, step.h),
                widest: self.guard_scale / step.h,
            };
            let verdict =
                first_crossing(&mut self.along::<M>(guard, sign, step), &task, &mut notice)?;
            self.collect(guard, sign, step.h, &noticed);
            let crossing = match verdict {
                Verdict::None => continue,
                Verdict::TooCoarse => return Ok(None),
                Verdict::Flat => {
                    return Err(RunError::GuardIdenticallyZero { guard, s: self.origin.s });
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
        Ok(Some(found))
    }

    /// A guard along `step`, whose dense output is known.
    fn along<'b, M: Method>(
        &'b mut self,
        guard: usize,
        sign: f64,
        step: &'b Step,
    ) -> AlongStep<'b, S, M> {
        AlongStep {
            at: self.signed(guard, sign),
            origin: self.origin,
            dense: step.dense::<M>(self.origin.s),
            work: self.work,
            statistics: self.statistics,
            method: PhantomData,
        }
    }

    /// Whether a guard that is zero throughout a step becomes nonzero on a longer step that meets
    /// the tolerance. Then it is zero only because the step is short.
    fn leaves_zero<M: Method>(&mut self, guard: usize, h: f64) -> bool {
        let field = self.field();
        let at = self.signed(guard, 1.0);
        for k in 1..=LONGER {
            let h = h * 4_f64.powi(k);
            let Work { restep, values, .. } = &mut *self.work;
            restep.take::<M>(&field, self.origin, h, self.tolerances);
            let further = restep.fill_interior::<M>(&field, self.origin);
            self.statistics.resteps += 1;
            self.statistics.field += M::STAGES - 1 + usize::from(M::ERROR_USES_END) + further;
            // Written so that NaN ends the search.
            let good = restep.error < 1.0;
            if !good {
                return false;
            }
            self.statistics.guards += NODES.len() - 1;
            let states = restep.nodes(self.origin);
            let leaves = (1..NODES.len()).any(|node| {
                let value = at.value(self.origin.s + NODES[node] * h, states[node], values);
                value != 0.0 && !value.is_nan()
            });
            if leaves {
                return true;
            }
        }
        false
    }

    /// Collects what isolation noticed of a guard.
    fn collect(&mut self, guard: usize, sign: f64, h: f64, noticed: &[Notice]) {
        for &notice in noticed {
            let found = Noticed::of(notice, (guard, sign), self.phase.mode, (self.origin.s, h));
            self.notices.add(found, h);
        }
    }

    /// Writes the values of the guards at the end of `step` to `tables.ends`. A value that is
    /// exactly zero is replaced by the smallest number with the sign that the guard had before.
    pub(crate) fn fill_ends<M: Method>(&mut self, step: &mut Step) {
        let count = self.phase.values.len();
        self.tables.ends.clear();
        for guard in 0..count {
            let column = self.tables.column(guard, count);
            let off = self.phase.guards[guard].direction() == Direction::Off;
            let end = if column[5] == 0.0 && !off {
                self.last_side::<M>(guard, step, &column)
            } else {
                column[5]
            };
            self.tables.ends.push(end);
        }
    }

    /// The smallest number with the sign that a guard had last, if it is zero where the step ends.
    /// The result is 0 if the guard shows no sign.
    fn last_side<M: Method>(&mut self, guard: usize, step: &mut Step, column: &[f64; 6]) -> f64 {
        self.extend::<M>(step);
        let resolution = resolution(self.origin.s, step.h);
        match last_sign(&mut self.along::<M>(guard, 1.0, step), resolution) {
            Ok(Some(last)) if last != 0.0 => f64::MIN_POSITIVE.copysign(last),
            // Otherwise the last nonzero value at the nodes decides.
            _ => side_before(column),
        }
    }
}
