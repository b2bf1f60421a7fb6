//! Extremal problems of one and two variables, by argmin.

use std::cell::RefCell;
use std::marker::PhantomData;

use argmin::core::{CostFunction, Error, Executor, IterState, OptimizationResult};
use argmin::solver::goldensectionsearch::GoldenSectionSearch;
use argmin::solver::neldermead::NelderMead;

use super::sampling::each;
use crate::error::StudyError;

/// A place and the value there.
#[derive(Clone, Copy, Debug)]
pub struct Extremum<T> {
    pub at: T,
    pub value: f64,
}

/// The maximum of `value`: the best of `places`, which are in order, improved by golden section
/// between its neighbours.
pub fn maximum(
    places: &[f64],
    value: impl Fn(f64) -> Result<f64, StudyError> + Send + Sync,
) -> Result<Extremum<f64>, StudyError> {
    let values = each(places, |&at| value(at))?;
    let Some(best) = (0..values.len()).max_by(|&a, &b| values[a].total_cmp(&values[b])) else {
        return Err(StudyError::NoPlaces);
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
    value: impl Fn(f64) -> Result<f64, StudyError>,
) -> Result<Extremum<f64>, StudyError> {
    let cost = Cost::new(|at: &f64| value(*at));
    let solved = GoldenSectionSearch::new(low, high)
        .and_then(|solver| solver.with_tolerance(1e-9 * (high - low)))
        .and_then(|solver| {
            let start = 0.5 * (low + high);
            Executor::new(&cost, solver).configure(|s| s.param(start).max_iters(200)).run()
        });
    let (at, value) = cost.best(solved)?;
    Ok(Extremum { at, value })
}

/// The maximum of `value` near `start`, by the simplex method of Nelder and Mead from a triangle of
/// size `step`.
pub fn maximum_near(
    start: [f64; 2],
    step: [f64; 2],
    value: impl Fn([f64; 2]) -> Result<f64, StudyError>,
) -> Result<Extremum<[f64; 2]>, StudyError> {
    let cost = Cost::new(|at: &Vec<f64>| value([at[0], at[1]]));
    let [x, y] = start;
    let corners = vec![vec![x, y], vec![x + step[0], y], vec![x, y + step[1]]];
    let solved = NelderMead::new(corners)
        .with_sd_tolerance(1e-14)
        .and_then(|solver| Executor::new(&cost, solver).configure(|s| s.max_iters(400)).run());
    let (at, value) = cost.best(solved)?;
    Ok(Extremum { at: [at[0], at[1]], value })
}

/// What argmin returns.
type Solved<O, S, P> = Result<OptimizationResult<O, S, IterState<P, (), (), (), (), f64>>, Error>;

/// A function whose maximum is looked for, and its first failure: argmin panics where a cost fails
/// at the start.
struct Cost<P, F> {
    value: F,
    failed: RefCell<Option<StudyError>>,
    place: PhantomData<P>,
}

impl<P: Clone, F: Fn(&P) -> Result<f64, StudyError>> Cost<P, F> {
    fn new(value: F) -> Self {
        Self { value, failed: RefCell::default(), place: PhantomData }
    }

    /// The best place and the value there.
    fn best<O, S>(&self, solved: Solved<O, S, P>) -> Result<(P, f64), StudyError> {
        if let Some(failure) = self.failed.take() {
            return Err(failure);
        }
        let solved = solved?;
        let state = solved.state();
        let best = state.best_param.clone().map(|at| (at, -state.best_cost));
        best.ok_or_else(|| StudyError::NoPlaces)
    }
}

impl<P, F: Fn(&P) -> Result<f64, StudyError>> CostFunction for &Cost<P, F> {
    type Param = P;
    type Output = f64;

    fn cost(&self, at: &P) -> Result<f64, Error> {
        Ok((self.value)(at).map_or_else(
            |failure| {
                self.failed.borrow_mut().get_or_insert(failure);
                f64::INFINITY
            },
            |value| -value,
        ))
    }
}

/// The place between `from` and `to` where `holds`, true at `from` and false at `to`, changes; to
/// rounding.
pub fn change(
    mut from: f64,
    mut to: f64,
    holds: impl Fn(f64) -> Result<bool, StudyError>,
) -> Result<f64, StudyError> {
    loop {
        let middle = 0.5 * (from + to);
        if middle == from || middle == to {
            return Ok(middle);
        }
        if holds(middle)? { from = middle } else { to = middle }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maxima_between_and_at_the_places() {
        let wave = |x: f64| Ok((x - 0.3).cos() + 0.1 * x);
        let places: Vec<f64> = (0..20).map(|i| 0.2 * f64::from(i) - 1.0).collect();
        let found = maximum(&places, wave).unwrap();
        assert!((found.at - (0.3 + 0.1_f64.asin())).abs() < 1e-7);
        let end = maximum(&places, Ok).unwrap();
        assert_eq!(end.at, places[19]);
        assert!(maximum(&[], Ok).is_err());
    }

    #[test]
    fn a_maximum_of_two_variables() {
        let hill = |[x, y]: [f64; 2]| Ok(-(x - 1.0).powi(2) - 3.0 * (y + 0.5).powi(2) - x * y);
        let found = maximum_near([0.0, 0.0], [0.1, 0.1], hill).unwrap();
        // Where 2(x − 1) + y = 0 and 6(y + 1/2) + x = 0.
        assert!(
            (found.at[0] - 15.0 / 11.0).abs() < 1e-6 && (found.at[1] + 8.0 / 11.0).abs() < 1e-6
        );
    }

    #[test]
    fn a_change_is_found_to_rounding() {
        let root = change(1.0, 2.0, |x| Ok(x * x < 2.0)).unwrap();
        assert!((root - 2.0_f64.sqrt()).abs() <= f64::EPSILON);
    }

    #[test]
    fn failures_come_through() {
        let broken = || StudyError::NoSpring { kappa: 1.0, psi: 2.0 };
        let is_broken = |error| matches!(error, StudyError::NoSpring { kappa: 1.0, psi: 2.0 });
        assert!(is_broken(maximum(&[0.0, 1.0], |_| Err(broken())).unwrap_err()));
        assert!(is_broken(maximum_near([0.0, 0.0], [0.1, 0.1], |_| Err(broken())).unwrap_err()));
    }
}
