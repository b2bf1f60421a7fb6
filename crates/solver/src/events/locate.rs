//! The place of a switch, located by steps of the method.
//!
//! The dense output only tells where to begin. Each iteration takes a step from the same start to a
//! trial place. So a switch is as accurate as any other point of the run.

use crate::error::RunError;
use crate::events::along_step::rounding;
use crate::events::event::Event;
use crate::events::examination::Examination;
use crate::events::one_guard::Crossing;
use crate::hybrid::{HybridSystem, Observer};
use crate::method::{Method, State, Step};

/// The largest distance from the end of a repeated step to the switch, as a part of the step, that
/// the midpoint rule bridges. Its error is the cube of this part, which is below rounding.
const BRIDGE: f64 = 1e-5;
/// A switch whose distance from the start of its step is below this part of the time counts as a
/// switch at the start.
const NOWHERE: f64 = 1e-20;
/// The part of a step over which a guard is differenced to find its slope. The guard is known to
/// change on the scale of the step, so that cancellation cannot spoil the slope, however short the
/// step is.
const REACH: f64 = 1e-3;

impl<S, O, const N: usize, const G: usize> Examination<'_, S, O, N, G>
where
    S: HybridSystem<N, G>,
    O: Observer<S::Mode, N>,
{
    /// Ends `step` where `guard` crosses zero inside the bracket. If `exact`, the event's step ends
    /// exactly at the crossing; otherwise it ends within a small part of itself.
    pub(crate) fn locate<M: Method>(
        &mut self,
        step: &Step<N>,
        guard: usize,
        crossing: &Crossing,
        exact: bool,
    ) -> Result<Event<N>, RunError> {
        let (system, mode) = (self.system, self.phase.mode);
        let (mut low, mut high) = (crossing.bracket.low, crossing.bracket.high);
        let mut theta = crossing.bracket.guess;
        let event = |elapsed, state, residual: f64, slope: f64, step| Event {
            guard,
            simultaneous: 0,
            passed: 0,
            slope: slope.abs(),
            elapsed,
            state,
            residual: residual.abs(),
            sign: crossing.sign,
            step,
        };
        if high == 0.0 {
            let residual = self.phase.values[guard];
            return Ok(event(0.0, step.y0, residual, f64::INFINITY, step.shrunk_to_start()));
        }
        if !(theta > low && theta < high) {
            theta = 0.5 * (low + high);
        }
        let mut last_value = f64::INFINITY;
        loop {
            let mut trial = self.restep::<M>(step, theta * step.h);
            let near = Near { system, mode, guard, sign: crossing.sign, reach: REACH * trial.h };
            let end = near.probe(trial.s + trial.h, &trial.y1);
            self.count_probe();
            if end.value.is_nan() {
                return Err(RunError::GuardNotANumber { guard, s: step.s });
            }
            if end.value >= 0.0 {
                low = theta;
            } else {
                high = theta;
            }
            let shift = end.shift() / step.h;
            let next = theta + shift;
            if shift.abs() <= BRIDGE * theta
                && next >= low
                && next <= high
                && let Some((elapsed, state, residual)) = self.bridge(&near, &trial, end)
            {
                if elapsed > step.h {
                    // The other guards have been examined only up to the end of the step.
                    trial = self.restep::<M>(step, step.h);
                    let residual = near.value(step.s + step.h, &trial.y1);
                    return Ok(event(step.h, trial.y1, residual, end.slope, trial));
                }
                if exact && elapsed != trial.h {
                    trial = self.restep::<M>(step, elapsed);
                }
                return Ok(event(elapsed, state, residual, end.slope, trial));
            }
            if high * step.h <= NOWHERE * step.s.abs() || high <= f64::MIN_POSITIVE {
                let residual = self.phase.values[guard];
                return Ok(event(0.0, step.y0, residual, end.slope, step.shrunk_to_start()));
            }
            if high - low <= 4.0 * f64::EPSILON * high {
                if theta < high {
                    // The zero is too flat for Newton's method, and the step ends just beyond it.
                    theta = high;
                    continue;
                }
                return Ok(event(trial.h, trial.y1, end.value, end.slope, trial));
            }
            // Newton's method if it makes progress, and bisection if the guard is too flat for it.
            let progress = end.value.abs() <= 0.1 * last_value;
            last_value = end.value.abs();
            theta = if progress && next > low && next < high { next } else { 0.5 * (low + high) };
        }
    }

    /// A step of size `h` from the start of `step`.
    fn restep<M: Method>(&mut self, step: &Step<N>, h: f64) -> Step<N> {
        self.statistics.resteps += 1;
        self.statistics.field += M::STAGES - 1 + usize::from(M::ERROR_USES_END);
        let mut shorter = Step::blank();
        self.system.step::<M>(self.phase.mode, &step.shortened(h), &mut shorter);
        shorter
    }

    /// Moves from the end of `trial` to the zero of the guard. Returns the time from the start of
    /// the step, the state, and the remaining value of the guard. The result is `None` if
    /// Newton's method does not converge as it does near a simple zero.
    fn bridge(
        &mut self,
        near: &Near<'_, S, N, G>,
        trial: &Step<N>,
        mut at: Probe<N>,
    ) -> Option<(f64, State<N>, f64)> {
        let (mut moved, mut y) = (0.0, trial.y1);
        let s = trial.s + trial.h;
        for _ in 0..4 {
            let shift = at.shift();
            if shift.abs() <= 1e-9 * trial.h && at.left_by(shift) <= f64::EPSILON * trial.h {
                moved += shift;
                y += at.slope_of_state * shift;
                let mut residual = near.value(s + moved, &y);
                self.statistics.guards += 1;
                // A large value means that the slope changes within the reach of its difference.
                if residual.abs() > 0.01 * at.value.abs()
                    && residual.abs() > 2.0 * near.rounding(s + moved, &y)
                {
                    return None;
                }
                let rest = -residual / at.slope;
                if rest.abs() > f64::EPSILON * trial.h {
                    moved += rest;
                    y += at.slope_of_state * rest;
                    residual = near.value(s + moved, &y);
                    self.statistics.guards += 1;
                }
                return Some((trial.h + moved, y, residual));
            }
            let middle = y + at.slope_of_state * (0.5 * shift);
            y += self.system.field(near.mode, s + moved + 0.5 * shift, &middle) * shift;
            moved += shift;
            let before = at.value.abs();
            at = near.probe(s + moved, &y);
            self.statistics.field += 1;
            self.count_probe();
            if at.value.abs() > 0.1 * before {
                break;
            }
        }
        None
    }

    fn count_probe(&mut self) {
        self.statistics.field += 1;
        self.statistics.guards += 3;
    }
}

/// A guard near its zero.
struct Near<'a, S: HybridSystem<N, G>, const N: usize, const G: usize> {
    system: &'a S,
    mode: S::Mode,
    guard: usize,
    sign: f64,
    /// The distance over which the guard is differenced.
    reach: f64,
}

/// A guard's value at a place, its derivatives along the solution, and the slope of the state.
#[derive(Clone, Copy)]
struct Probe<const N: usize> {
    value: f64,
    slope: f64,
    /// Half the second derivative.
    bend: f64,
    slope_of_state: State<N>,
}

impl<const N: usize> Probe<N> {
    /// The Newton step to the zero.
    fn shift(&self) -> f64 {
        if self.value == 0.0 { 0.0 } else { -self.value / self.slope }
    }

    /// The distance from the zero that remains after a Newton step.
    fn left_by(&self, shift: f64) -> f64 {
        if shift == 0.0 { 0.0 } else { (self.bend / self.slope).abs() * shift * shift }
    }
}

impl<S: HybridSystem<N, G>, const N: usize, const G: usize> Near<'_, S, N, G> {
    fn value(&self, s: f64, y: &State<N>) -> f64 {
        self.sign * self.system.guard_values(self.mode, s, y)[self.guard]
    }

    fn rounding(&self, s: f64, y: &State<N>) -> f64 {
        rounding(|s, y| self.value(s, y), (s, y), (s, y))
    }

    fn probe(&self, s: f64, y: &State<N>) -> Probe<N> {
        let slope_of_state = self.system.field(self.mode, s, y);
        let reach = slope_of_state * self.reach;
        let ahead = self.value(s + self.reach, &(y + reach));
        let behind = self.value(s - self.reach, &(y - reach));
        let slope = (ahead - behind) / (2.0 * self.reach);
        let value = self.value(s, y);
        let bend = (0.5 * (ahead + behind) - value) / (self.reach * self.reach);
        Probe { value, slope, bend, slope_of_state }
    }
}
