//! The place of a switch, located by steps of the method.
//!
//! The dense output only gives the place to begin. Each iteration takes a step from the same start
//! to a trial place. So a switch is as accurate as any other point of the run. As soon as the rest
//! is below 1e-5 of the step, Newton's method along the flow, with the midpoint rule, bridges it.
//! The error is the cube of this part, which is below rounding.
//!
//! The error of a place (`doubt`) is the rounding of time and state, twice that of one step since
//! it adds up, or the noise of the guard's own values if that is larger, over the slope of the
//! guard, and four roundings of the time since the phase began. The slope is taken where the guard
//! leaves what rounding hides: over a thousandth of a step, exp(y) − 1 may have another one.

mod rise;

use crate::error::RunError;
use crate::events::along_step::{repeated_step, rounding};
use crate::events::event::{Crossed, Event};
use crate::events::examination::Examination;
use crate::events::isolate::{Bracket, narrow};
use crate::events::sidestep::{Sidestep, resolution};
use crate::events::status::Crossing;
use crate::method::{Method, StepOf, Store};
use crate::system::{Room, System};

/// The largest distance from the end of a repeated step to the switch, as a part of the step, that
/// the midpoint rule bridges. Its error is the cube of this part, which is below rounding.
pub(crate) const BRIDGE: f64 = 1e-5;
/// A switch whose distance from the start of its step is below this part of the time counts as a
/// switch at the start.
pub(crate) const NOWHERE: f64 = 1e-20;
/// The part of a step over which a guard is differenced to find its slope. The guard is known to
/// change on the scale of the step, so that cancellation cannot spoil the slope, however short the
/// step is.
pub(crate) const REACH: f64 = 1e-3;
/// A place without a value is the place of the switch if it is in a bracket of this width, in units
/// of the narrowest resolved part of the step.
pub(crate) const AT_HOLE: f64 = 16.0;

/// A guard is steep if it changes by this part of its largest value within [`BRIDGE`].
pub(crate) const STEEP: f64 = 1e-6;
/// The part of the distance to the ends of the bracket over which it is differenced at most.
pub(crate) const INSIDE: f64 = 0.1;
/// The least part of a step over which a guard is differenced, so that rounding cannot spoil the
/// slope.
pub(crate) const LEAST_REACH: f64 = 1e-5;

impl<S: System> Examination<'_, S> {
    /// Ends `step` where `guard` crosses zero inside the bracket. If `exact`, the event's step ends
    /// exactly at the crossing; otherwise it ends within a small part of itself. The result is
    /// `None` if steps of the method do not find the signs that the bracket claims.
    pub(crate) fn locate<M: Method>(
        &mut self,
        step: &StepOf<S::State>,
        guard: usize,
        crossing: &Crossing,
        exact: bool,
    ) -> Result<Option<Event<S>>, RunError> {
        let (system, mode) = (self.system, self.phase.mode);
        let Bracket { mut low, mut high, guess: mut theta, rests } = crossing.bracket;
        let (mut seen_low, mut seen_high) = (false, false);
        let beyond = crossing.bracket.high * step.h;
        let (count, sign) = (self.phase.count(), crossing.sign);
        let event = |at: Landing<S::State>, step: StepOf<S::State>| {
            let crossed = Crossed { slope: at.slope.abs(), jump: at.jump, sign };
            let alone = Event::alone((guard, count), crossed, (at.elapsed, at.state), step);
            Event { residual: at.residual.abs(), beyond, ..alone }
        };
        let start = self.phase.values[guard];
        let at_start = |residual: f64, slope: f64| {
            let (elapsed, state, jump) = (0.0, step.y0.clone(), false);
            let landing = Landing { elapsed, state, residual, slope, jump };
            Ok(Some(event(landing, step.shrunk_to_start())))
        };
        if high == 0.0 {
            // The guard is negative there: it has not been located, and hides nothing.
            return at_start(0.0, f64::INFINITY);
        }
        if low == 0.0
            && !rests
            && let Some(slope) = self.falls_from_start(step, guard, crossing.sign)
        {
            return at_start(start, slope);
        }
        let Some(shown) = self.rise_before::<M>(step, guard, crossing) else {
            return Ok(Some(self.unseen::<M>(step, (guard, sign), beyond)));
        };
        low = low.max(shown);
        theta = if theta > low && theta < high { theta } else { 0.5 * (low + high) };
        let width = room((low, high), theta) * step.h;
        let (mut last_value, resolution) = (f64::INFINITY, resolution(step.s, step.h));
        let mut sidestep = Sidestep::new(guard, step.s, resolution);
        loop {
            let mut trial = self.restep::<M>(step, theta * step.h);
            let reach = (REACH * trial.h).min((INSIDE * width).max(LEAST_REACH * trial.h));
            let near = Near { system, mode, guard, sign: crossing.sign, reach };
            let end = near.probe(trial.s + trial.h, &trial.y1, self.room);
            self.count_probe();
            if end.value.is_nan() {
                if high - low <= AT_HOLE * resolution {
                    let landing =
                        near.landing_at_hole(&trial, &end, resolution * step.h, self.room);
                    return Ok(Some(event(landing, trial)));
                }
                theta = sidestep.of(theta)?;
                continue;
            }
            if end.value < 0.0 {
                (high, seen_high) = (theta, true);
            } else {
                (low, seen_low) = (theta, true);
            }
            if low >= high {
                // Within rounding, either sign may be true.
                if end.value.abs() > 16.0 * near.rounding(trial.s + trial.h, &trial.y1, self.room) {
                    return Ok(None);
                }
                return Ok(Some(event(Landing::at_end(&trial, &end), trial)));
            }
            let shift = end.shift() / step.h;
            let next = theta + shift;
            let close = shift.abs() <= BRIDGE * theta && next >= low && next <= high;
            // Where it rests, every place is a zero.
            let by_newton = if close && !rests { self.bridge(&near, &trial, &end) } else { None };
            let landing = match by_newton {
                None if !rests && high - low > 4.0 * f64::EPSILON * high => {
                    self.search_nearby(&near, step, &trial, &end, (low, high))
                }
                landing => landing,
            };
            if let Some(mut at) = landing {
                if at.elapsed > step.h {
                    // The other guards have been examined only up to the end of the step.
                    trial = self.restep::<M>(step, step.h);
                    at.residual = near.value(step.s + step.h, &trial.y1, self.room);
                    at.elapsed = step.h;
                    at.state.set(&trial.y1);
                } else if exact && at.elapsed != trial.h {
                    trial = self.restep::<M>(step, at.elapsed);
                }
                return Ok(Some(event(at, trial)));
            }
            if high * step.h <= NOWHERE * (step.s.abs() + step.h) {
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
                    return Ok(Some(event(Landing::at_end(&trial, &end), trial)));
                }
                continue;
            }
            // Newton's method if it makes progress, and bisection if the guard is too flat for it.
            let progress = !rests && end.value.abs() <= 0.1 * last_value;
            last_value = end.value.abs();
            theta = if progress && next > low && next < high { next } else { 0.5 * (low + high) };
        }
    }

    /// The slope of a guard that is zero at the start of `step` and falls from there.
    fn falls_from_start(
        &mut self,
        step: &StepOf<S::State>,
        guard: usize,
        sign: f64,
    ) -> Option<f64> {
        let from_zero = self.phase.values[guard].abs() <= f64::MIN_POSITIVE
            && self.phase.zero_orders[guard] == 0;
        if !from_zero || self.notes_of(guard).next().is_some() {
            return None;
        }
        let (system, mode, reach) = (self.system, self.phase.mode, REACH * step.h);
        let near = Near { system, mode, guard, sign, reach };
        let probe = near.probe(step.s, &step.y0, self.room);
        self.count_probe();
        let falls = probe.slope < 0.0 && probe.bend.abs() * reach < 0.1 * probe.slope.abs();
        falls.then_some(probe.slope)
    }

    /// A step of size `h` from the start of `step`.
    fn restep<M: Method>(&mut self, step: &StepOf<S::State>, h: f64) -> StepOf<S::State> {
        let shorter = step.shortened(h);
        repeated_step::<S, M>(self.system, self.phase.mode, &shorter, self.statistics, self.room)
    }

    /// Moves from the end of `trial` to the zero of the guard. The result is `None` if Newton's
    /// method does not converge as it does near a simple zero.
    fn bridge(
        &mut self,
        near: &Near<'_, S>,
        trial: &StepOf<S::State>,
        at: &Probe<S::State>,
    ) -> Option<Landing<S::State>> {
        let (mut moved, mut y) = (0.0, trial.y1.clone());
        let mut at = at.clone();
        let s = trial.s + trial.h;
        for _ in 0..4 {
            let shift = at.shift();
            if shift.abs() <= 1e-9 * trial.h && at.left_by(shift) <= f64::EPSILON * trial.h {
                moved += shift;
                y.shift(&at.slope_of_state, shift);
                let mut residual = near.value(s + moved, &y, self.room);
                self.statistics.guards += 1;
                // A large value means that the slope changes within the reach of its difference.
                if residual.abs() > 0.01 * at.value.abs()
                    && residual.abs() > 2.0 * near.rounding(s + moved, &y, self.room)
                {
                    return None;
                }
                let rest = -residual / at.slope;
                if residual != 0.0 && rest.abs() > f64::EPSILON * trial.h {
                    moved += rest;
                    y.shift(&at.slope_of_state, rest);
                    let before = residual.abs();
                    residual = near.value(s + moved, &y, self.room);
                    self.statistics.guards += 1;
                    let far = residual.abs() > 0.01 * before;
                    if far && residual.abs() > 2.0 * near.rounding(s + moved, &y, self.room) {
                        return None;
                    }
                }
                let elapsed = trial.h + moved;
                return Some(Landing { elapsed, state: y, residual, slope: at.slope, jump: false });
            }
            let (mut middle, mut slope) = (self.room.state(), self.room.state());
            S::State::shifted(&mut middle, &y, &at.slope_of_state, 0.5 * shift);
            self.system.field(near.mode, s + moved + 0.5 * shift, &middle, &mut slope);
            y.shift(&slope, shift);
            self.room.give(middle);
            self.room.give(slope);
            moved += shift;
            let before = at.value.abs();
            at = near.probe(s + moved, &y, self.room);
            self.statistics.field += 1;
            self.count_probe();
            if at.value.abs() > 0.1 * before {
                break;
            }
        }
        None
    }

    /// Searches for the zero of a steep guard near the end of `trial`, where the state is known by
    /// its second derivative. The zero lies between the step fractions `low` and `high`. The result
    /// is `None` if it is farther away, or the guard is not steep.
    fn search_nearby(
        &mut self,
        near: &Near<'_, S>,
        step: &StepOf<S::State>,
        trial: &StepOf<S::State>,
        at: &Probe<S::State>,
        (low, high): (f64, f64),
    ) -> Option<Landing<S::State>> {
        let (s, y, reach) = (trial.s + trial.h, &trial.y1, BRIDGE * trial.h);
        let low = (low * step.h - trial.h).max(-reach);
        let high = (high * step.h - trial.h).min(reach);
        let slope = &at.slope_of_state;
        let room = &mut *self.room;
        let (mut moved, mut bend, mut behind) = (room.state(), room.state(), room.state());
        S::State::shifted(&mut moved, y, slope, reach);
        self.system.field(near.mode, s + reach, &moved, &mut bend);
        S::State::shifted(&mut moved, y, slope, -reach);
        self.system.field(near.mode, s - reach, &moved, &mut behind);
        S::State::each(&mut bend, [&behind], |ahead, [behind]| (ahead - behind) / (4.0 * reach));
        self.statistics.field += 2;
        let mut state = behind;
        // The state is known to rounding only, which a flat guard would magnify.
        let end = near.value(step.s + step.h, &step.y1, room).abs();
        let mut count = 0;
        let mut value = |moved: f64| {
            count += 1;
            let of = [y, slope, &bend];
            S::State::each(&mut state, of, |_, [y, slope, bend]| {
                y + (slope + bend * moved) * moved
            });
            near.value(s + moved, &state, room)
        };
        let (before, after) = (value(low), value(high));
        let steep = before - after > STEEP * self.phase.largest[near.guard].max(end);
        let found = (before >= 0.0 && after < 0.0 && steep)
            .then(|| narrow(&mut value, (low, before), (high, after), f64::EPSILON * trial.h));
        self.statistics.guards += count;
        let (left, right) = found?;
        // Without a value in between, it jumps too.
        let crosses = left.1 - right.1 <= 0.1 * (before - after);
        let jump = !crosses;
        let (by, residual) = if left.1 < -right.1 && !jump { left } else { right };
        let of = [y, slope, &bend];
        S::State::each(&mut state, of, |_, [y, slope, bend]| y + (slope + bend * by) * by);
        let slope = (right.1 - left.1) / (right.0 - left.0);
        Some(Landing { elapsed: trial.h + by, state, residual, slope, jump })
    }

    fn count_probe(&mut self) {
        self.statistics.field += 1;
        self.statistics.guards += 3;
    }
}

/// The distance from `theta` to the ends of a bracket. Beyond them the guard may turn, except where
/// the step ends too.
pub(crate) fn room((low, high): (f64, f64), theta: f64) -> f64 {
    let left = if low > 0.0 { theta - low } else { f64::INFINITY };
    let right = if high < 1.0 { high - theta } else { f64::INFINITY };
    left.min(right)
}

/// Where a guard is zero.
struct Landing<V> {
    /// The time from the start of the step.
    elapsed: f64,
    state: V,
    /// The value that remains.
    residual: f64,
    /// The slope of the guard.
    slope: f64,
    /// Whether the guard jumps over zero.
    jump: bool,
}

impl<V: Store> Landing<V> {
    /// A zero at the end of a step, with what was seen of the guard there.
    fn at_end(step: &StepOf<V>, end: &Probe<V>) -> Self {
        let (elapsed, state, jump) = (step.h, step.y1.clone(), false);
        Self { elapsed, state, residual: end.value, slope: end.slope, jump }
    }
}

/// A guard near its zero.
struct Near<'a, S: System> {
    system: &'a S,
    mode: S::Mode,
    guard: usize,
    sign: f64,
    /// The distance over which the guard is differenced.
    reach: f64,
}

/// A guard's value at a place, its derivatives along the solution, and the slope of the state.
#[derive(Clone)]
struct Probe<V> {
    value: f64,
    slope: f64,
    /// Half the second derivative.
    bend: f64,
    slope_of_state: V,
}

impl<V> Probe<V> {
    /// The Newton step to the zero.
    fn shift(&self) -> f64 {
        if self.value == 0.0 { 0.0 } else { -self.value / self.slope }
    }

    /// The distance from the zero that remains after a Newton step.
    fn left_by(&self, shift: f64) -> f64 {
        if shift == 0.0 { 0.0 } else { (self.bend / self.slope).abs() * shift * shift }
    }
}

impl<S: System> Near<'_, S> {
    fn value(&self, s: f64, y: &S::State, room: &mut Room<S>) -> f64 {
        self.sign * room.value(self.system, (self.mode, self.guard), s, y)
    }

    /// A zero at the end of a step where the guard has no value, but close behind it.
    fn landing_at_hole(
        &self,
        step: &StepOf<S::State>,
        end: &Probe<S::State>,
        least: f64,
        room: &mut Room<S>,
    ) -> Landing<S::State> {
        let mut moved = room.state();
        let mut behind = |by: f64| {
            S::State::shifted(&mut moved, &step.y1, &end.slope_of_state, by);
            self.value(step.s + step.h + by, &moved, room)
        };
        let jump = behind(AT_HOLE * least) < 0.1 * behind(self.reach.max(1e4 * least));
        let (elapsed, state) = (step.h, step.y1.clone());
        Landing { elapsed, state, residual: 0.0, slope: f64::INFINITY, jump }
    }

    fn rounding(&self, s: f64, y: &S::State, room: &mut Room<S>) -> f64 {
        rounding(self.system, (self.mode, self.guard), (s, y), (s, y), room).0
    }

    fn probe(&self, s: f64, y: &S::State, room: &mut Room<S>) -> Probe<S::State> {
        let (mut slope_of_state, mut moved) = (room.state(), room.state());
        self.system.field(self.mode, s, y, &mut slope_of_state);
        S::State::shifted(&mut moved, y, &slope_of_state, self.reach);
        let ahead = self.value(s + self.reach, &moved, room);
        S::State::shifted(&mut moved, y, &slope_of_state, -self.reach);
        let behind = self.value(s - self.reach, &moved, room);
        room.give(moved);
        let slope = (ahead - behind) / (2.0 * self.reach);
        let value = self.value(s, y, room);
        let bend = (0.5 * (ahead + behind) - value) / (self.reach * self.reach);
        Probe { value, slope, bend, slope_of_state }
    }
}
