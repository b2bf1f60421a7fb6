//! A guard as a function along a step, and the effect of rounding on it.

use std::marker::PhantomData;

use crate::error::RunError;
use crate::events::aside::{Aside, resolution};
use crate::events::isolate::{Curve, Enclosed};
use crate::events::path::Path;
use crate::hybrid::{HybridSystem, Statistics};
use crate::method::{Dense, Method, State, Step, Trial};
use crate::number::{Enclosure, Interval};

/// The relative change of state and time with which a guard's sensitivity to them is measured.
pub(crate) const SLIGHT: f64 = 1e-12;

/// The change of a guard's `value` at (`s`, `y`) if time and state change by some units in the last
/// place of `s_scale` and `y_scale`.
///
/// It is zero if the guard has no value nearby, since nothing is known about it beyond its domain.
pub(crate) fn rounding<const N: usize>(
    value: impl Fn(f64, &State<N>) -> f64,
    (s, y): (f64, &State<N>),
    (s_scale, y_scale): (f64, &State<N>),
) -> f64 {
    let here = value(s, y);
    let mut change = (value(s + SLIGHT * s_scale.abs(), y) - here).abs();
    for i in 0..N {
        let mut moved = *y;
        moved[i] += SLIGHT * y_scale[i].abs();
        change += (value(s, &moved) - here).abs();
    }
    if change.is_finite() { 4.0 * f64::EPSILON / SLIGHT * change } else { 0.0 }
}

/// The dense output over a step taken in `mode`.
///
/// All callers share this one function, because what it compiles to is large.
#[inline(never)]
pub(crate) fn dense_output<S, M, const N: usize, const G: usize>(
    system: &S,
    mode: S::Mode,
    step: &mut Step<N>,
) -> Dense<N>
where
    S: HybridSystem<N, G>,
    M: Method,
{
    // Dispatched at run time, so that it is compiled once for each method and dimension.
    let field: &mut dyn FnMut(f64, &State<N>) -> State<N> = &mut |s, y| system.field(mode, s, y);
    step.dense::<M>(&mut &mut *field)
}

/// The step `trial` in `mode`, taken again to look at the solution more closely.
///
/// All callers share this one function, apart from the step of the run itself, because what it
/// compiles to is large.
#[inline(never)]
pub(crate) fn repeated_step<S, M, const N: usize, const G: usize>(
    system: &S,
    mode: S::Mode,
    trial: &Trial<'_, N>,
    statistics: &mut Statistics,
) -> Step<N>
where
    S: HybridSystem<N, G>,
    M: Method,
{
    statistics.resteps += 1;
    statistics.field += M::STAGES - 1 + usize::from(M::ERROR_USES_END);
    let mut step = Step::blank();
    system.step::<M>(mode, trial, &mut step);
    step
}

/// A guard as a function along a step, for isolation.
pub(crate) struct AlongStep<'a, S: HybridSystem<N, G>, M, const N: usize, const G: usize> {
    pub(crate) system: &'a S,
    pub(crate) mode: S::Mode,
    pub(crate) guard: usize,
    pub(crate) sign: f64,
    pub(crate) step: &'a Step<N>,
    pub(crate) dense: &'a Dense<N>,
    pub(crate) statistics: &'a mut Statistics,
    pub(crate) method: PhantomData<M>,
}

impl<S, M, const N: usize, const G: usize> AlongStep<'_, S, M, N, G>
where
    S: HybridSystem<N, G>,
    M: Method,
{
    fn value(&mut self, theta: f64, y: &State<N>) -> f64 {
        self.statistics.guards += 1;
        let s = self.step.s + theta * self.step.h;
        self.sign * self.system.guard_values(self.mode, s, y)[self.guard]
    }

    /// Bounds of the guard from bounds of time and state.
    fn enclose(&mut self, (s, y): (Enclosure, [Enclosure; N])) -> Enclosure {
        self.statistics.enclosures += 1;
        let bounds = self.system.enclose_guards(self.mode, s, &y)[self.guard];
        if self.sign < 0.0 { -bounds } else { bounds }
    }

    /// The state by a step of the method to `theta`.
    fn state_at(&mut self, theta: f64) -> State<N> {
        let shorter = self.step.shortened(theta * self.step.h);
        repeated_step::<S, M, N, G>(self.system, self.mode, &shorter, self.statistics).y1
    }

    /// `theta`, or a place beside it if the guard has no value there, with the state by a step of
    /// the method and the guard's value.
    fn step_to(&mut self, theta: f64) -> Result<(f64, State<N>, f64), RunError> {
        let step = self.step;
        let mut aside = Aside::new(self.guard, step.s, resolution(step.s, step.h));
        let mut place = theta;
        loop {
            let state = self.state_at(place);
            let value = self.value(place, &state);
            if !value.is_nan() {
                return Ok((place, state, value));
            }
            place = aside.of(theta)?;
        }
    }
}

impl<S, M, const N: usize, const G: usize> Curve for AlongStep<'_, S, M, N, G>
where
    S: HybridSystem<N, G>,
    M: Method,
{
    fn dense(&mut self, theta: f64) -> f64 {
        self.value(theta, &self.dense.at(theta))
    }

    fn coarse(&mut self, theta: f64) -> f64 {
        self.value(theta, &self.dense.coarse_at(theta))
    }

    fn rounding(&mut self) -> (f64, f64) {
        self.statistics.guards += 3 * (N + 2);
        let value = |s: f64, y: &State<N>| self.system.guard_values(self.mode, s, y)[self.guard];
        let [start, middle, end] = [0.0, 0.5, 1.0].map(|theta| {
            let (s, y) = (self.step.s + theta * self.step.h, self.dense.at(theta));
            rounding(value, (s, &y), (s, &y))
        });
        (start, start.max(middle).max(end))
    }

    fn truth(&mut self, theta: f64) -> Result<f64, RunError> {
        self.step_to(theta).map(|(.., value)| value)
    }
}

/// A guard of a readable system along a step.
pub(crate) struct EnclosedAlongStep<'a, S, M, const N: usize, const G: usize>
where
    S: HybridSystem<N, G>,
{
    pub(crate) along: AlongStep<'a, S, M, N, G>,
    /// The path along the dense output.
    pub(crate) path: Path<N>,
    /// The path on the part of the step that is looked at more closely.
    pub(crate) local: Option<Path<N>>,
}

impl<S, M, const N: usize, const G: usize> Enclosed for EnclosedAlongStep<'_, S, M, N, G>
where
    S: HybridSystem<N, G>,
    M: Method,
{
    fn over(&mut self, low: f64, high: f64) -> Enclosure {
        let part = self.local.as_ref().unwrap_or(&self.path).part(low, high);
        self.along.enclose(part.whole())
    }

    fn bounds(&mut self, low: f64, high: f64) -> (Enclosure, Enclosure) {
        let part = self.local.as_ref().unwrap_or(&self.path).part(low, high);
        let plain = self.along.enclose(part.whole());
        if plain.value.sign() != 0.0 {
            return (plain, plain);
        }
        let centre = self.along.enclose(part.centre());
        if !plain.slope.is_bounded() {
            return (plain, centre);
        }
        (plain.about(&centre, 0.5 * (high - low)), centre)
    }

    fn truth(&mut self, theta: f64) -> Result<(f64, Interval), RunError> {
        let (theta, y, value) = self.along.step_to(theta)?;
        let AlongStep { system, mode, guard, sign, step, .. } = self.along;
        let s = Enclosure::from(step.s + theta * step.h);
        let state = std::array::from_fn(|i| Enclosure::from(y[i]));
        let bounds = system.enclose_guards(mode, s, &state)[guard].value;
        Ok((value, if sign < 0.0 { bounds.negated() } else { bounds }))
    }

    fn at(&mut self, theta: f64) -> f64 {
        self.along.dense(theta)
    }

    fn refine(&mut self, low: f64, high: f64) -> Result<Option<bool>, RunError> {
        let AlongStep { system, mode, step, .. } = self.along;
        let (middle, reach) = (0.5 * (low + high), 0.5 * (high - low) * step.h);
        let y = self.along.state_at(middle);
        let s = step.s + middle * step.h;
        let slope = system.field(mode, s, &y);
        let away = |by: f64| system.field(mode, s + by, &(y + slope * by));
        let bend = (away(reach) - away(-reach)) / (2.0 * reach);
        self.along.statistics.field += 3;
        let local = self.path.local((low, high), [&y, &slope, &bend]);
        Ok(local.map(|(local, exact)| {
            self.local = Some(local);
            exact
        }))
    }

    fn widen(&mut self) {
        self.local = None;
    }
}
