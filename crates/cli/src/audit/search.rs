//! Extremal problems of one and two variables, by argmin.

use argmin::core::{CostFunction, Error, Executor};
use argmin::solver::goldensectionsearch::GoldenSectionSearch;
use argmin::solver::neldermead::NelderMead;

use super::subject::each;
use crate::error::Failure;

/// A place and the value there.
#[derive(Clone, Copy, Debug)]
pub struct Extremum<T> {
    pub at: T,
    pub value: f64,
}

/// The maximum of `value`: the best of `places`, which are in order, improved by golden section between its neighbours.
pub fn maximum(
    places: &[f64],
    value: impl Fn(f64) -> Result<f64, Failure> + Send + Sync,
) -> Result<Extremum<f64>, Failure> {
    let values = each(places, |&at| value(at))?;
    let Some(best) = (0..values.len()).max_by(|&a, &b| values[a].total_cmp(&values[b])) else {
        return Err(Failure::Audit("a maximum is asked for without a place".to_owned()));
    };
    let (low, high) = (places[best.saturating_sub(1)], places[(best + 1).min(places.len() - 1)]);
    let found = between(low, high, value)?;
    Ok(if found.value > values[best] {
        found
    } else {
        Extremum { at: places[best], value: values[best] }
    })
}

/// The maximum of `value` on an interval in which it has one only, to 1e-9 of its length.
fn between(
    low: f64,
    high: f64,
    value: impl Fn(f64) -> Result<f64, Failure>,
) -> Result<Extremum<f64>, Failure> {
    struct Cost<F>(F);
    impl<F: Fn(f64) -> Result<f64, Failure>> CostFunction for Cost<F> {
        type Param = f64;
        type Output = f64;
        fn cost(&self, at: &f64) -> Result<f64, Error> {
            (self.0)(*at).map(|value| -value).map_err(|error| Error::msg(error.to_string()))
        }
    }
    let solved = GoldenSectionSearch::new(low, high)
        .and_then(|solver| solver.with_tolerance(1e-9 * (high - low)))
        .and_then(|solver| {
            let start = 0.5 * (low + high);
            Executor::new(Cost(value), solver).configure(|s| s.param(start).max_iters(200)).run()
        })
        .map_err(|error| failure(&error))?;
    let state = solved.state();
    Ok(Extremum { at: state.best_param.unwrap_or(f64::NAN), value: -state.best_cost })
}

/// The maximum of `value` near `start`, by the simplex method of Nelder and Mead from a triangle of size `step`.
pub fn maximum_near(
    start: [f64; 2],
    step: [f64; 2],
    value: impl Fn([f64; 2]) -> Result<f64, Failure>,
) -> Result<Extremum<[f64; 2]>, Failure> {
    struct Cost<F>(F);
    impl<F: Fn([f64; 2]) -> Result<f64, Failure>> CostFunction for Cost<F> {
        type Param = Vec<f64>;
        type Output = f64;
        fn cost(&self, at: &Vec<f64>) -> Result<f64, Error> {
            (self.0)([at[0], at[1]])
                .map(|value| -value)
                .map_err(|error| Error::msg(error.to_string()))
        }
    }
    let [x, y] = start;
    let corners = vec![vec![x, y], vec![x + step[0], y], vec![x, y + step[1]]];
    let solved = NelderMead::new(corners)
        .with_sd_tolerance(1e-14)
        .and_then(|solver| Executor::new(Cost(value), solver).configure(|s| s.max_iters(400)).run())
        .map_err(|error| failure(&error))?;
    let state = solved.state();
    let at = state.best_param.as_ref().map_or([f64::NAN; 2], |best| [best[0], best[1]]);
    Ok(Extremum { at, value: -state.best_cost })
}

/// The place between `from` and `to` where `holds`, true at `from` and false at `to`, changes; to rounding.
pub fn change(
    mut from: f64,
    mut to: f64,
    holds: impl Fn(f64) -> Result<bool, Failure>,
) -> Result<f64, Failure> {
    loop {
        let middle = 0.5 * (from + to);
        if middle == from || middle == to {
            return Ok(middle);
        }
        if holds(middle)? { from = middle } else { to = middle }
    }
}

fn failure(error: &Error) -> Failure {
    Failure::Audit(error.to_string())
}
