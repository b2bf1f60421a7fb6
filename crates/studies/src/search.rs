//! Searches for maxima, zeros and changes, with the solvers of argmin.

use std::cell::RefCell;
use std::marker::PhantomData;
use std::ops::Neg;

use argmin::core::{CostFunction, Error, Executor, IterState, Solver, State};
use argmin::solver::brent::{BrentOpt, BrentRoot};
use argmin::solver::goldensectionsearch::GoldenSectionSearch;
use argmin::solver::neldermead::NelderMead;
use rayon::prelude::*;
use stickslip_model::InvalidValue;

/// A solver.
#[derive(Clone, Copy)]
struct Searcher {
    name: &'static str,
    /// What it expects.
    expected: &'static str,
}

const GOLDEN_SECTION: Searcher = Searcher {
    name: "the search by golden section",
    expected: "an interval of finite length above 0",
};
const SIMPLEX: Searcher =
    Searcher { name: "the simplex method", expected: "a triangle of finite size" };
const BRENT_MAXIMUM: Searcher = Searcher {
    name: "Brent's method for a maximum",
    expected: "an interval of finite length above 0",
};
const BRENT_ZERO: Searcher =
    Searcher { name: "Brent's method for a zero", expected: "values of two signs at the ends" };

/// The error of a search without a place to start from.
fn no_places() -> InvalidValue {
    InvalidValue::phrase("a search", "has no places to start from", "at least one")
}

/// A place and the value there.
#[derive(Clone, Copy, Debug)]
pub struct Optimum<T> {
    /// The place.
    pub at: T,
    /// The value there.
    pub value: f64,
}

/// The maximum of `value`: the best of `places`, which are in order, improved by golden section
/// between its neighbours, to 1e-9 of their distance.
///
/// # Errors
/// [`InvalidValue`] without places or if the solver fails, or the first failure of `value`.
pub fn maximum<E: From<InvalidValue> + Send>(
    places: &[f64],
    value: impl Fn(f64) -> Result<f64, E> + Send + Sync,
) -> Result<Optimum<f64>, E> {
    let values: Vec<_> = places.par_iter().map(|&at| value(at)).collect();
    let values: Vec<f64> = values.into_iter().collect::<Result<_, _>>()?;
    let Some(best) = (0..values.len()).max_by(|&a, &b| values[a].total_cmp(&values[b])) else {
        return Err(no_places().into());
    };
    let (low, high) = (places[best.saturating_sub(1)], places[(best + 1).min(places.len() - 1)]);
    if low >= high {
        return Ok(Optimum { at: places[best], value: values[best] });
    }
    let solver = GoldenSectionSearch::new(low, high)
        .and_then(|solver| solver.with_tolerance(1e-9 * (high - low)));
    let start = 0.5 * (low + high);
    let solver = (GOLDEN_SECTION, [low, high], solver);
    let found =
        least(|at| value(*at).map(f64::neg), solver, |state| state.param(start).max_iters(200))?;
    Ok(if -found.value > values[best] {
        Optimum { at: found.at, value: -found.value }
    } else {
        Optimum { at: places[best], value: values[best] }
    })
}

/// The maximum of `value` near `start`, by the simplex method of Nelder and Mead from a triangle of
/// size `step`.
///
/// # Errors
/// [`InvalidValue`] if the solver fails, or the first failure of `value`.
pub fn maximum_near<E: From<InvalidValue>>(
    start: [f64; 2],
    step: [f64; 2],
    value: impl Fn([f64; 2]) -> Result<f64, E>,
) -> Result<Optimum<[f64; 2]>, E> {
    let [x, y] = start;
    let corners = vec![vec![x, y], vec![x + step[0], y], vec![x, y + step[1]]];
    let depth = |at: &Vec<f64>| value([at[0], at[1]]).map(f64::neg);
    let solver = NelderMead::new(corners).with_sd_tolerance(1e-14);
    let solver = (SIMPLEX, [x, x + step[0]], solver);
    let found = least(depth, solver, |state| state.max_iters(400))?;
    Ok(Optimum { at: [found.at[0], found.at[1]], value: -found.value })
}

/// The place of the one maximum of `height` in `interval`, by Brent's method, to a `tolerance` in
/// parts of the interval.
///
/// # Errors
/// [`InvalidValue`] if the solver fails, or the first failure of `height`.
pub fn highest<E: From<InvalidValue>>(
    interval: (f64, f64),
    tolerance: f64,
    height: impl Fn(f64) -> Result<f64, E>,
) -> Result<f64, E> {
    let solver = BrentOpt::new(0.0, 1.0).set_tolerance(tolerance, tolerance);
    let depth = |part: &f64| height(inside(interval, *part)).map(f64::neg);
    let solver = (BRENT_MAXIMUM, interval.into(), Ok(solver));
    Ok(inside(interval, least(depth, solver, |state| state.max_iters(200))?.at))
}

/// The place of the one zero of `height` in `interval`, by Brent's method, to 1e-14 of the
/// interval.
///
/// # Errors
/// [`InvalidValue`] if the solver fails, or the first failure of `height`.
pub fn root<E: From<InvalidValue>>(
    interval: (f64, f64),
    height: impl Fn(f64) -> Result<f64, E>,
) -> Result<f64, E> {
    let solver = BrentRoot::new(0.0, 1.0, 1e-14);
    let height = |part: &f64| height(inside(interval, *part));
    let solver = (BRENT_ZERO, interval.into(), Ok(solver));
    Ok(inside(interval, least(height, solver, |state| state.max_iters(200))?.at))
}

/// The place between `from` and `to` where `holds`, true at `from` and false at `to`, changes; by
/// bisection, to rounding. It is NaN if an end is NaN or both are infinite.
///
/// # Errors
/// The first failure of `holds`.
pub fn change<E>(
    mut from: f64,
    mut to: f64,
    holds: impl Fn(f64) -> Result<bool, E>,
) -> Result<f64, E> {
    loop {
        let middle = 0.5 * (from + to);
        if !(from.min(to) < middle && middle < from.max(to)) {
            return Ok(middle);
        }
        if holds(middle)? { from = middle } else { to = middle }
    }
}

/// The place at a part of `interval`: to the solver it is 0 to 1, so that tolerances fit.
fn inside((low, high): (f64, f64), part: f64) -> f64 {
    low + part * (high - low)
}

/// The state of a solver over places `P`.
type SolverState<P> = IterState<P, (), (), (), (), f64>;

/// The place where a solver finds `cost` least, or zero if it looks for a zero; with its name and
/// the ends of what it searches.
fn least<P, F, E, S>(
    cost: F,
    (searcher, ends, solver): (Searcher, [f64; 2], Result<S, Error>),
    start: impl FnOnce(SolverState<P>) -> SolverState<P>,
) -> Result<Optimum<P>, E>
where
    P: Clone,
    F: Fn(&P) -> Result<f64, E>,
    E: From<InvalidValue>,
    S: for<'a> Solver<&'a Cost<P, F, E>, SolverState<P>>,
{
    let cost = Cost { value: cost, failed: RefCell::default(), place: PhantomData };
    let solved =
        solver.and_then(|solver| Executor::new(&cost, solver).timer(false).configure(start).run());
    if let Some(failure) = cost.failed.take() {
        return Err(failure);
    }
    let solved = solved.map_err(|_| {
        let Searcher { name, expected } = searcher;
        let [low, high] = ends;
        InvalidValue::phrase(name, format!("failed from {low} to {high}"), expected)
    })?;
    let state = solved.state();
    let best = state.get_best_param().map(|at| (at.clone(), state.get_best_cost()));
    let (at, value) = best.ok_or_else(no_places)?;
    Ok(Optimum { at, value })
}

/// A function whose minimum or zero is looked for, and its first failure. After a failure the
/// solver goes on with an infinite cost, since argmin panics where a cost fails at the start.
struct Cost<P, F, E> {
    value: F,
    failed: RefCell<Option<E>>,
    place: PhantomData<P>,
}

impl<P, F: Fn(&P) -> Result<f64, E>, E> CostFunction for &Cost<P, F, E> {
    type Param = P;
    type Output = f64;

    fn cost(&self, at: &P) -> Result<f64, Error> {
        Ok((self.value)(at).unwrap_or_else(|failure| {
            self.failed.borrow_mut().get_or_insert(failure);
            f64::INFINITY
        }))
    }
}
