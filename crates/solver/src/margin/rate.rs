//! How fast a guard changes, known or by differences.
//!
//! If a system does not know its rates, they are replaced by differences. The reach of these
//! differences is a small part of the longest step so far. Error control knows the scale on which
//! the solution changes, so this works in any unit of time. The rounding of the differences is
//! measured if a decision depends on it.

use std::cell::Cell;

use crate::hybrid::{HybridSystem, Start};
use crate::method::control::first_step;
use crate::method::{Method, State, Step, Trial};
use crate::options::{Options, StepSize};

/// The part of a step over which differences reach. Its fourth power makes an error of 1e-11 of a
/// rate, and rounding one of some 1e-13.
const REACH: f64 = 1.0 / 256.0;

/// The reach of the differences that replace unknown rates.
pub(super) struct Reach {
    /// The start of the present step.
    start: Cell<f64>,
    /// The distance over which the differences reach.
    distance: Cell<f64>,
}

impl Reach {
    /// The reach for the first step of a run.
    pub fn new<M, S, const N: usize, const G: usize>(
        system: &S,
        start: &Start<S::Mode, N>,
        end: f64,
        options: &Options,
    ) -> Self
    where
        M: Method,
        S: HybridSystem<N, G>,
    {
        let Start { mode, s, state } = *start;
        let longest = (end - s).min(options.max_step);
        let first = match (options.step_size, options.first_step) {
            (StepSize::Fixed(h), _) | (_, Some(h)) => h.min(longest),
            _ => {
                let mut field = |s: f64, y: &State<N>| system.field(mode, s, y);
                let slope = field(s, &state);
                let tolerances = (options.rtol, options.atol);
                first_step::<M, N>(&mut field, s, &state, &slope, tolerances, longest)
            }
        };
        Self { start: Cell::new(s), distance: Cell::new(REACH * first) }
    }

    /// Adapts the reach to the step before, which was accepted up to `s`, where a step now starts.
    pub fn follow(&self, s: f64) {
        let distance = REACH * (s - self.start.replace(s));
        // It changes seldom, so that rates seldom change between two steps.
        if distance >= 2.0 * self.distance.get() {
            self.distance.set(distance);
        }
    }

    /// A reach that is small for the solution through `y`: there, a step of its length is good
    /// enough.
    fn shortened<M, S, const N: usize, const G: usize>(
        &self,
        system: &S,
        (mode, options): (S::Mode, &Options),
        (s, y): (f64, &State<N>),
    ) -> Self
    where
        M: Method,
        S: HybridSystem<N, G>,
    {
        let slope = system.field(mode, s, y);
        let tolerances = (options.rtol, options.atol);
        let mut step = Step::blank();
        let mut h = self.distance.get() / REACH;
        // More would be below the rounding of any time.
        for _ in 0..50 {
            let trial = Trial { s, y, rest: Trial::NO_REST, slope: &slope, h, tolerances };
            system.step::<M>(mode, &trial, &mut step);
            if step.error < 1.0 {
                break;
            }
            h *= 0.25;
        }
        Self { start: Cell::new(s), distance: Cell::new(REACH * h) }
    }

    /// The rate of `guard`, by differences if it is not known.
    pub fn rate<S, const N: usize, const G: usize>(
        &self,
        system: &S,
        mode: S::Mode,
        guard: usize,
        (s, y): (f64, &State<N>),
    ) -> f64
    where
        S: HybridSystem<N, G>,
    {
        let rate = system.guard_rates(mode, s, y)[guard];
        if !rate.is_nan() {
            return rate;
        }
        let (slope, reach) = (system.field(mode, s, y), self.distance.get());
        let at = |reach: f64| system.guard_values(mode, s + reach, &(y + slope * reach))[guard];
        fourth_order(at, reach)
    }

    /// The derivative of the rate of `guard`, by differences along steps of the method.
    pub fn bend<M, S, const N: usize, const G: usize>(
        &self,
        system: &S,
        mode: S::Mode,
        guard: usize,
        (s, y): (f64, &State<N>),
    ) -> f64
    where
        M: Method,
        S: HybridSystem<N, G>,
    {
        let slope = system.field(mode, s, y);
        let mut step = Step::blank();
        let at = |h: f64| {
            let (rest, tolerances) = (Trial::NO_REST, (1.0, 1.0));
            let trial = Trial { s, y, rest, slope: &slope, h, tolerances };
            system.step::<M>(mode, &trial, &mut step);
            self.rate(system, mode, guard, (s + h, &step.y1))
        };
        // Of the differences of differences, rounding is the greater part of the error.
        fourth_order(at, 8.0 * self.distance.get())
    }
}

/// A derivative of a guard along the solution, up to a positive factor; `None` for the third one
/// and higher ones.
pub(super) fn derivative<M, S, const N: usize, const G: usize>(
    system: &S,
    reach: &Reach,
    (mode, options): (S::Mode, &Options),
    (guard, derivative): (usize, u32),
    (s, y): (f64, &State<N>),
) -> Option<f64>
where
    M: Method,
    S: HybridSystem<N, G>,
{
    let good = || reach.shortened::<M, S, N, G>(system, (mode, options), (s, y));
    match derivative {
        0 => Some(system.guard_values(mode, s, y)[guard]),
        1 => Some(good().rate(system, mode, guard, (s, y))),
        2 => Some(good().bend::<M, S, N, G>(system, mode, guard, (s, y))),
        _ => None,
    }
}

/// Whether `guard` of the mode `from`, where it has just fired, has the same value in the mode `to`
/// after the transition.
pub(super) fn stands<S, const N: usize, const G: usize>(
    system: &S,
    guard: usize,
    s: f64,
    (from, before): (S::Mode, &State<N>),
    (to, after): (S::Mode, &State<N>),
) -> bool
where
    S: HybridSystem<N, G>,
{
    let value = |mode, y| system.guard_values(mode, s, y)[guard];
    value(from, before) == value(to, after)
}

/// The derivative of `at` at 0, by a difference of fourth order.
fn fourth_order(mut at: impl FnMut(f64) -> f64, reach: f64) -> f64 {
    let near = at(reach) - at(-reach);
    let far = at(2.0 * reach) - at(-2.0 * reach);
    (8.0 * near - far) / (12.0 * reach)
}
