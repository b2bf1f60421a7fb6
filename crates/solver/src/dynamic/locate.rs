//! The place of a switch of a dynamic system, by steps of the method: what
//! [`crate::events::locate`] does, on buffers.

use crate::dynamic::curve::{Work, rounding};
use crate::dynamic::event::Event;
use crate::dynamic::examination::Examination;
use crate::dynamic::step::Step;
use crate::dynamic::system::{DynamicSystem, SignedGuard};
use crate::error::RunError;
use crate::events::aside::{Aside, resolution};
use crate::events::isolate::{Bracket, narrow};
use crate::events::locate::{AT_HOLE, BRIDGE, INSIDE, LEAST_REACH, NOWHERE, REACH, STEEP, room};
use crate::events::one_guard::Crossing;
use crate::method::Method;

/// A guard's value at a place, and its derivatives along the solution.
#[derive(Clone, Copy)]
struct Probe {
    value: f64,
    slope: f64,
    /// Half the second derivative.
    bend: f64,
}

impl Probe {
    /// The Newton step to the zero.
    fn shift(&self) -> f64 {
        if self.value == 0.0 { 0.0 } else { -self.value / self.slope }
    }

    /// The distance from the zero that remains after a Newton step.
    fn left_by(&self, shift: f64) -> f64 {
        if shift == 0.0 { 0.0 } else { (self.bend / self.slope).abs() * shift * shift }
    }
}

/// Where a guard is zero.
#[derive(Clone, Copy)]
struct Landing {
    elapsed: f64,
    /// The value that remains.
    residual: f64,
    slope: f64,
    jump: bool,
}

impl<S: DynamicSystem> Examination<'_, S> {
    /// Finds where `guard` crosses zero inside the bracket. The result is `None` if steps of the
    /// method do not find the signs that the bracket claims.
    pub(crate) fn locate<M: Method>(
        &mut self,
        step: &Step,
        guard: usize,
        crossing: &Crossing,
    ) -> Result<Option<Event>, RunError> {
        let at = self.signed(guard, crossing.sign);
        let Bracket { mut low, mut high, guess: mut theta } = crossing.bracket;
        let (mut seen_low, mut seen_high) = (false, false);
        let s0 = self.origin.s;
        let beyond = crossing.bracket.high * step.h;
        let event = |landing: Landing, state: &[f64]| Event {
            guard,
            simultaneous: Vec::new(),
            slope: landing.slope.abs(),
            elapsed: landing.elapsed,
            state: state.to_vec(),
            residual: landing.residual.abs(),
            sign: crossing.sign,
            beyond,
            jump: landing.jump,
        };
        let (start, y0) = (self.phase.values[guard], self.origin.y);
        let at_start = |residual: f64, slope: f64| {
            let landing = Landing { elapsed: 0.0, residual, slope, jump: false };
            Ok(Some(event(landing, y0)))
        };
        if high == 0.0 {
            return at_start(0.0, f64::INFINITY);
        }
        if low == 0.0
            && let Some(slope) = self.falls_from_start(&at, s0, REACH * step.h)
        {
            return at_start(start, slope);
        }
        theta = if theta > low && theta < high { theta } else { 0.5 * (low + high) };
        let width = room((low, high), theta) * step.h;
        let mut last_value = f64::INFINITY;
        let resolution = resolution(s0, step.h);
        let mut aside = Aside::new(guard, s0, resolution);
        loop {
            let h = self.restep::<M>(theta * step.h);
            let reach = (REACH * h).min((INSIDE * width).max(LEAST_REACH * h));
            let end = self.probe(&at, s0 + h, reach);
            self.work.end_slope.copy_from_slice(&self.work.slope);
            if end.value.is_nan() {
                if high - low <= AT_HOLE * resolution {
                    let landing = self.landing_at_hole(&at, s0, (h, reach), resolution * step.h);
                    return Ok(Some(event(landing, &self.work.restep.y1)));
                }
                theta = aside.of(theta)?;
                continue;
            }
            if end.value < 0.0 {
                (high, seen_high) = (theta, true);
            } else {
                (low, seen_low) = (theta, true);
            }
            let here = Landing { elapsed: h, residual: end.value, slope: end.slope, jump: false };
            if low >= high {
                // Within rounding, either sign may be true.
                let hidden = self.rounding_at_trial(&at, s0 + h);
                let landed = end.value.abs() <= 16.0 * hidden;
                return Ok(landed.then(|| event(here, &self.work.restep.y1)));
            }
            let next = theta + end.shift() / step.h;
            let close = (end.shift() / step.h).abs() <= BRIDGE * theta;
            let by_newton = if close && next >= low && next <= high {
                self.bridge(&at, s0, reach, end)
            } else {
                None
            };
            let landing = match by_newton {
                None if high - low > 4.0 * f64::EPSILON * high => {
                    self.search_nearby(&at, step, (low, high))
                }
                landing => landing,
            };
            if let Some(mut landing) = landing {
                if landing.elapsed > step.h {
                    // The other guards have been examined only up to the end of the step.
                    self.restep::<M>(step.h);
                    let Work { restep, values, state, .. } = &mut *self.work;
                    state.copy_from_slice(&restep.y1);
                    landing.residual = at.value(s0 + step.h, state, values);
                    landing.elapsed = step.h;
                }
                return Ok(Some(event(landing, &self.work.state)));
            }
            if high * step.h <= NOWHERE * (s0.abs() + step.h) {
                return at_start(start, end.slope);
            }
            if high - low <= 4.0 * f64::EPSILON * high {
                // The zero is too flat for Newton's method, and the step ends just beyond it. Both
                // signs must have been seen.
                if !seen_low && low > 0.0 {
                    theta = low;
                } else if theta < high || !seen_high {
                    theta = high;
                } else {
                    return Ok(Some(event(here, &self.work.restep.y1)));
                }
                continue;
            }
            // Newton's method if it makes progress, and bisection if the guard is too flat for it.
            let progress = end.value.abs() <= 0.1 * last_value;
            last_value = end.value.abs();
            theta = if progress && next > low && next < high { next } else { 0.5 * (low + high) };
        }
    }

    /// Takes a step of size `h` to `work.restep`, and copies the state at its end to `work.state`.
    pub(crate) fn restep<M: Method>(&mut self, h: f64) -> f64 {
        self.statistics.resteps += 1;
        self.statistics.field += M::STAGES - 1;
        let field = self.field();
        let Work { restep, state, .. } = &mut *self.work;
        restep.take_end::<M>(&field, self.origin, h);
        state.copy_from_slice(&restep.y1);
        h
    }

    /// The effect of rounding on the guard at the end of the trial step, at `s`.
    fn rounding_at_trial(&mut self, at: &SignedGuard<'_, S>, s: f64) -> f64 {
        let Work { restep, moved, values, .. } = &mut *self.work;
        let y = &restep.y1;
        let (effect, count) = rounding(at, (s, y), (s, y), moved, values);
        self.statistics.guards += count;
        effect
    }

    /// The effect of rounding on the guard at (`s`, `work.state`).
    fn rounding_here(&mut self, at: &SignedGuard<'_, S>, s: f64) -> f64 {
        let Work { state, moved, values, .. } = &mut *self.work;
        let (effect, count) = rounding(at, (s, state), (s, state), moved, values);
        self.statistics.guards += count;
        effect
    }

    /// Looks at a guard at (`s`, `work.state`) and at the distance `reach` on both sides. The slope
    /// of the state is written to `work.slope`.
    fn probe(&mut self, at: &SignedGuard<'_, S>, s: f64, reach: f64) -> Probe {
        let Work { state, moved, slope, values, .. } = &mut *self.work;
        at.system.field(at.mode, s, state, slope);
        self.statistics.field += 1;
        self.statistics.guards += 3;
        shifted(moved, state, slope, reach);
        let ahead = at.value(s + reach, moved, values);
        shifted(moved, state, slope, -reach);
        let behind = at.value(s - reach, moved, values);
        let value = at.value(s, state, values);
        let bend = (0.5 * (ahead + behind) - value) / (reach * reach);
        Probe { value, slope: (ahead - behind) / (2.0 * reach), bend }
    }

    /// The slope of a guard that is zero at the start of the step and falls from there.
    fn falls_from_start(&mut self, at: &SignedGuard<'_, S>, s0: f64, reach: f64) -> Option<f64> {
        let from_zero = self.phase.values[at.guard].abs() <= f64::MIN_POSITIVE
            && self.phase.zero_orders[at.guard] == 0;
        if !from_zero || self.notes_of(at.guard).next().is_some() {
            return None;
        }
        self.work.state.copy_from_slice(self.origin.y);
        let probe = self.probe(at, s0, reach);
        let falls = probe.slope < 0.0 && probe.bend.abs() * reach < 0.1 * probe.slope.abs();
        falls.then_some(probe.slope)
    }

    /// A zero at the end of the trial step, of size `h`, where the guard has no value, but close
    /// behind it.
    fn landing_at_hole(
        &mut self,
        at: &SignedGuard<'_, S>,
        s0: f64,
        (h, reach): (f64, f64),
        least: f64,
    ) -> Landing {
        let Work { restep, moved, end_slope, values, .. } = &mut *self.work;
        let mut behind = |by: f64| {
            shifted(moved, &restep.y1, end_slope, by);
            at.value(s0 + h + by, moved, values)
        };
        let jump = behind(AT_HOLE * least) < 0.1 * behind(reach.max(1e4 * least));
        Landing { elapsed: h, residual: 0.0, slope: f64::INFINITY, jump }
    }

    /// The guard's value at (`s`, `work.state`).
    fn value_here(&mut self, at: &SignedGuard<'_, S>, s: f64) -> f64 {
        self.statistics.guards += 1;
        at.value(s, &self.work.state, &mut self.work.values)
    }

    /// Moves `work.state` from the end of the trial step to the zero of the guard. The result is
    /// `None` if Newton's method does not converge as it does near a simple zero.
    fn bridge(
        &mut self,
        guard: &SignedGuard<'_, S>,
        s0: f64,
        reach: f64,
        mut at: Probe,
    ) -> Option<Landing> {
        let h = self.work.restep.h;
        let (s, mut moved) = (s0 + h, 0.0);
        for _ in 0..4 {
            let shift = at.shift();
            if shift.abs() <= 1e-9 * h && at.left_by(shift) <= f64::EPSILON * h {
                moved += shift;
                advance(&mut self.work.state, &self.work.slope, shift);
                let mut residual = self.value_here(guard, s + moved);
                // A large value means that the slope changes within the reach of its difference.
                if residual.abs() > 0.01 * at.value.abs()
                    && residual.abs() > 2.0 * self.rounding_here(guard, s + moved)
                {
                    return None;
                }
                let rest = -residual / at.slope;
                if residual != 0.0 && rest.abs() > f64::EPSILON * h {
                    moved += rest;
                    advance(&mut self.work.state, &self.work.slope, rest);
                    let before = residual.abs();
                    residual = self.value_here(guard, s + moved);
                    let far = residual.abs() > 0.01 * before;
                    if far && residual.abs() > 2.0 * self.rounding_here(guard, s + moved) {
                        return None;
                    }
                }
                return Some(Landing {
                    elapsed: h + moved,
                    residual,
                    slope: at.slope,
                    jump: false,
                });
            }
            let Work { state, moved: middle, slope, .. } = &mut *self.work;
            shifted(middle, state, slope, 0.5 * shift);
            guard.system.field(guard.mode, s + moved + 0.5 * shift, middle, slope);
            self.statistics.field += 1;
            advance(state, slope, shift);
            moved += shift;
            let before = at.value.abs();
            at = self.probe(guard, s + moved, reach);
            if at.value.abs() > 0.1 * before {
                break;
            }
        }
        None
    }

    /// Searches for the zero of a steep guard near the end of the trial step, where the state is
    /// known by its second derivative. The zero lies between the step fractions `low` and `high`.
    /// The result is `None` if it is farther away, or the guard is not steep. The state at the zero
    /// is written to `work.state`.
    fn search_nearby(
        &mut self,
        guard: &SignedGuard<'_, S>,
        step: &Step,
        (low, high): (f64, f64),
    ) -> Option<Landing> {
        let h = self.work.restep.h;
        let (s, reach) = (self.origin.s + h, BRIDGE * h);
        let low = (low * step.h - h).max(-reach);
        let high = (high * step.h - h).min(reach);
        let Work { restep, state, moved, slope, end_slope, bend, values, .. } = &mut *self.work;
        let y = &restep.y1;
        shifted(moved, y, end_slope, reach);
        guard.system.field(guard.mode, s + reach, moved, bend);
        shifted(moved, y, end_slope, -reach);
        guard.system.field(guard.mode, s - reach, moved, slope);
        for (ahead, behind) in bend.iter_mut().zip(&*slope) {
            *ahead = (*ahead - behind) / (4.0 * reach);
        }
        self.statistics.field += 2;
        let mut curved = |by: f64| {
            for (i, state) in state.iter_mut().enumerate() {
                *state = y[i] + (end_slope[i] + bend[i] * by) * by;
            }
            self.statistics.guards += 1;
            guard.value(s + by, state, values)
        };
        let (before, after) = (curved(low), curved(high));
        // The state is known to rounding only, which a flat guard would magnify.
        let largest = self.phase.largest[guard.guard].max(self.tables.end_of(guard.guard).abs());
        let steep = before - after > STEEP * largest;
        let found = (before >= 0.0 && after < 0.0 && steep)
            .then(|| narrow(&mut curved, (low, before), (high, after), f64::EPSILON * h));
        let (left, right) = found?;
        // Without a value in between, it jumps too.
        let crosses = left.1 - right.1 <= 0.1 * (before - after);
        let jump = !crosses;
        let (by, residual) = if left.1 < -right.1 && !jump { left } else { right };
        // The state at the place that was chosen.
        curved(by);
        let slope = (right.1 - left.1) / (right.0 - left.0);
        Some(Landing { elapsed: h + by, residual, slope, jump })
    }
}

/// y + slope·by.
fn shifted(moved: &mut [f64], y: &[f64], slope: &[f64], by: f64) {
    for ((moved, y), slope) in moved.iter_mut().zip(y).zip(slope) {
        *moved = y + slope * by;
    }
}

fn advance(y: &mut [f64], slope: &[f64], by: f64) {
    for (y, slope) in y.iter_mut().zip(slope) {
        *y += slope * by;
    }
}
