//! Searches for minima and roots, with the solvers of argmin.

use std::cell::RefCell;
use std::marker::PhantomData;

use argmin::core::{CostFunction, Error, Executor, IterState, Solver, State};
use argmin::solver::brent::{BrentOpt, BrentRoot};
use argmin::solver::neldermead::NelderMead;

use super::FitError;

/// The place of the one minimum of `cost` in an interval and the value there, by Brent's method, to
/// a `tolerance` in parts of the interval.
pub fn least(
    (low, high): (f64, f64),
    tolerance: f64,
    cost: impl Fn(f64) -> Result<f64, FitError>,
) -> Result<(f64, f64), FitError> {
    let inside = |part: f64| low + part * (high - low);
    let solver = BrentOpt::new(0.0, 1.0).set_tolerance(tolerance, tolerance);
    let cost = |part: &f64| cost(inside(*part));
    let failure = FitError::Minimum { low, high };
    let (part, value) = solve(cost, Ok(solver), failure, |state| state.max_iters(100))?;
    Ok((inside(part), value))
}

/// The place of a zero of `height` between two places at which its values are known and have two
/// signs, by Brent's method, to 1e-8 of their distance.
pub fn root(
    [(low, at_low), (high, at_high)]: [(f64, f64); 2],
    height: impl Fn(f64) -> Result<f64, FitError>,
) -> Result<f64, FitError> {
    if at_low == 0.0 || at_high == 0.0 {
        return Ok(if at_low == 0.0 { low } else { high });
    }
    let inside = |part: f64| low + part * (high - low);
    let solver = BrentRoot::new(0.0, 1.0, 1e-8);
    let height = |part: &f64| match *part {
        0.0 => Ok(at_low),
        1.0 => Ok(at_high),
        part => height(inside(part)),
    };
    let failure = FitError::Zero { low, high };
    Ok(inside(solve(height, Ok(solver), failure, |state| state.max_iters(100))?.0))
}

/// The minimum of `cost` near `start`, by the simplex method of Nelder and Mead from a triangle
/// with sides `step`.
pub fn least_near(
    start: [f64; 2],
    step: [f64; 2],
    cost: impl Fn([f64; 2]) -> Result<f64, FitError>,
) -> Result<([f64; 2], f64), FitError> {
    let [x, y] = start;
    // The tolerance is one of the values, which may have any size.
    let unit = cost(start)?;
    let unit = if unit > 0.0 { unit } else { 1.0 };
    let corners = vec![vec![x, y], vec![x + step[0], y], vec![x, y + step[1]]];
    let solver = NelderMead::new(corners).with_sd_tolerance(1e-15);
    let cost = |at: &Vec<f64>| cost([at[0], at[1]]).map(|value| value / unit);
    let failure = FitError::Simplex { start, sides: step };
    let (at, value) = solve(cost, solver, failure, |state| state.max_iters(300))?;
    Ok(([at[0], at[1]], value * unit))
}

type SolverState<P> = IterState<P, (), (), (), (), f64>;

/// The best place that `solver` finds, and the cost there; `failure` if the solver fails.
fn solve<P, F, S>(
    cost: F,
    solver: Result<S, Error>,
    failure: FitError,
    start: impl FnOnce(SolverState<P>) -> SolverState<P>,
) -> Result<(P, f64), FitError>
where
    P: Clone,
    F: Fn(&P) -> Result<f64, FitError>,
    S: for<'a> Solver<&'a Cost<P, F>, SolverState<P>>,
{
    let cost = Cost { value: cost, failed: RefCell::default(), place: PhantomData };
    let solved =
        solver.and_then(|solver| Executor::new(&cost, solver).timer(false).configure(start).run());
    if let Some(failed) = cost.failed.take() {
        return Err(failed);
    }
    let solved = solved.map_err(|_| failure)?;
    let state = solved.state();
    let best = state.get_best_param().map(|at| (at.clone(), state.get_best_cost()));
    best.ok_or(FitError::NoPlaces)
}

/// A function whose minimum or zero is looked for, and its first failure. After a failure the
/// solver goes on with an infinite cost, since argmin panics where a cost fails at the start.
struct Cost<P, F> {
    value: F,
    failed: RefCell<Option<FitError>>,
    place: PhantomData<P>,
}

impl<P, F: Fn(&P) -> Result<f64, FitError>> CostFunction for &Cost<P, F> {
    type Param = P;
    type Output = f64;

    fn cost(&self, at: &P) -> Result<f64, Error> {
        Ok((self.value)(at).unwrap_or_else(|failure| {
            self.failed.borrow_mut().get_or_insert(failure);
            f64::INFINITY
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BROKEN: FitError = FitError::NoPlaces;

    fn broken<P>(_: P) -> Result<f64, FitError> {
        Err(BROKEN)
    }

    #[test]
    fn minima_and_roots() {
        let (at, value) = least((1.0, 3.0), 1e-8, |x| Ok((x - 1.7).powi(2) + 2.0)).unwrap();
        assert!((at - 1.7).abs() < 1e-7 && (value - 2.0).abs() < 1e-14);
        // A kink is a minimum too.
        let (at, _) = least((1.0, 3.0), 1e-8, |x: f64| Ok((x - 1.7).abs())).unwrap();
        assert!((at - 1.7).abs() < 1e-7);
        let zero = root([(1.0, -1.0), (3.0, 7.0)], |x| Ok(x * x - 2.0)).unwrap();
        assert!((zero - 2.0_f64.sqrt()).abs() < 1e-7);
        let bowl = |[x, y]: [f64; 2]| Ok(1e9 * ((x - 1.0).powi(2) + 3.0 * (y + 0.5).powi(2)));
        let ([x, y], _) = least_near([0.0, 0.0], [0.1, 0.1], bowl).unwrap();
        assert!((x - 1.0).abs() < 1e-6 && (y + 0.5).abs() < 1e-6, "{x} {y}");
    }

    #[test]
    fn failures_come_through() {
        assert_eq!(least((0.0, 1.0), 1e-8, broken).unwrap_err(), BROKEN);
        assert_eq!(root([(0.0, -1.0), (1.0, 1.0)], broken).unwrap_err(), BROKEN);
        assert_eq!(least_near([0.0; 2], [0.1; 2], broken).unwrap_err(), BROKEN);
    }

    #[test]
    fn a_zero_needs_values_of_two_signs() {
        let found = root([(1.0, 2.0), (3.0, 10.0)], |x| Ok(x * x + 1.0));
        assert_eq!(found, Err(FitError::Zero { low: 1.0, high: 3.0 }));
    }
}
