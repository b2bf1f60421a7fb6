//! The local search: from a place of the global one to the bottom of its valley.
//!
//! A simplex descends first, which kinks do not hinder. With the paper's law, Gauss–Newton steps
//! with the sensitivities of the collisions follow, as long as they lower the misfit. Other laws
//! have no sensitivities, and the simplex alone decides.

use super::FitError;
use super::axis::Axis;
use super::bodies::Values;
use super::free::Free;
use super::problem::{Problem, Slopes};
use super::scan::Lines;
use super::search::{least, least_near};

/// The bottom of a valley.
#[derive(Clone, Copy, Debug)]
pub struct Bottom {
    pub values: Values,
    pub misfit: f64,
    /// Whether it is at an end of a range.
    pub at_end: bool,
}

/// Most Gauss–Newton steps, and most halvings of one.
const STEPS: usize = 30;
const HALVINGS: usize = 12;
/// Part of the misfit that a Gauss–Newton step gains at least, if another one is to follow.
const LEAST_GAIN: f64 = 1e-10;
/// Part of the distance between places within which a bottom is at the end of a range.
const AT_END: f64 = 1e-6;

impl Lines<'_> {
    /// The bottom of the valley around coordinates of both axes.
    pub fn descend(&self, start: [f64; 2]) -> Result<Bottom, FitError> {
        let [outer, inner] = match self.inner {
            Some(inner) => self.simplex(inner, start)?,
            None => [self.slide(start[0])?, 0.0],
        };
        let values = self.values(outer, inner);
        let found = Bottom { values, misfit: self.misfit(outer, inner)?, at_end: false };
        let found = self.polish(found)?;
        let at_end = self.axes().any(|axis| {
            let at = axis.coordinate(of(axis.free, &found.values));
            let (low, high) = axis.ends();
            (at - low).min(high - at) <= AT_END * axis.step(at)
        });
        Ok(Bottom { at_end, ..found })
    }

    fn axes(&self) -> impl Iterator<Item = &Axis> {
        std::iter::once(self.outer).chain(self.inner)
    }

    fn slide(&self, start: f64) -> Result<f64, FitError> {
        let (low, high) = self.outer.ends();
        let step = self.outer.step(start);
        let around = ((start - step).max(low), (start + step).min(high));
        let (at, misfit) = least(around, 1e-8, |at| self.misfit(at, 0.0))?;
        Ok(if misfit < self.misfit(start, 0.0)? { at } else { start })
    }

    /// Two simplices, since one may have become flat too early.
    fn simplex(&self, inner: &Axis, start: [f64; 2]) -> Result<[f64; 2], FitError> {
        let axes = [self.outer, inner];
        let inside = |at: [f64; 2]| {
            let (ends, mut within) = (axes.map(Axis::ends), at);
            for (at, (low, high)) in within.iter_mut().zip(ends) {
                *at = at.clamp(low, high);
            }
            within
        };
        // Outside the ranges, the misfit of the end, and more with the distance.
        let cost = |at: [f64; 2]| {
            let within = inside(at);
            let outside: f64 = (0..2).map(|i| (at[i] - within[i]).abs()).sum();
            Ok(self.misfit(within[0], within[1])? * (1.0 + outside) + outside)
        };
        let steps = [0, 1].map(|i| axes[i].step(start[i]));
        let mut best = (start, cost(start)?);
        for size in [0.5, -0.05] {
            let found = least_near(best.0, steps.map(|step| size * step), cost)?;
            if found.1 < best.1 {
                best = found;
            }
        }
        Ok(inside(best.0))
    }

    /// Gauss–Newton steps with sensitivities, as long as the misfit falls.
    fn polish(&self, mut best: Bottom) -> Result<Bottom, FitError> {
        let free: Vec<Free> = self.axes().map(|axis| axis.free).collect();
        if !free.iter().all(|free| matches!(free, Free::Kappa | Free::Mu)) {
            return Ok(best);
        }
        for _ in 0..STEPS {
            let Some(slopes) = self.problem.predict_with_slopes(&best.values)? else { break };
            let Some(step) = newton_step(self.problem, &slopes, &free) else { break };
            let Some(better) = self.shortened(&best, step)? else { break };
            let gain = best.misfit - better.misfit;
            best = better;
            if gain <= LEAST_GAIN * best.misfit {
                break;
            }
        }
        Ok(best)
    }

    /// The first of the step and its halves that lowers the misfit.
    fn shortened(&self, from: &Bottom, step: [f64; 2]) -> Result<Option<Bottom>, FitError> {
        for halving in 0..HALVINGS {
            let part = 0.5_f64.powi(i32::try_from(halving).unwrap_or(0));
            let mut values = from.values;
            values.kappa += part * step[0];
            values.mu += part * step[1];
            let inside = self.axes().all(|axis| {
                let (low, high) = axis.ends();
                (low..=high).contains(&axis.coordinate(of(axis.free, &values)))
            });
            if !inside {
                continue;
            }
            let misfit = self.problem.misfit_at(&values)?;
            if misfit < from.misfit {
                return Ok(Some(Bottom { values, misfit, ..*from }));
            }
        }
        Ok(None)
    }
}

/// A fitted number among the values.
pub fn of(free: Free, values: &Values) -> f64 {
    match free {
        Free::Kappa => values.kappa,
        Free::Mu => values.mu,
        Free::TangentialDamping => values.tangential_damping,
        Free::Damping => values.damping,
    }
}

/// The change of κ and μ that would lower the misfit to its least if the model were linear. `None`
/// if the data do not determine it.
fn newton_step(problem: &Problem, slopes: &Slopes, free: &[Free]) -> Option<[f64; 2]> {
    let [mut a, mut b, mut c, mut p, mut q] = [0.0; 5];
    for (index, error) in problem.errors.iter().enumerate() {
        let slope = |which, slopes: &[f64]| {
            if free.contains(&which) { slopes[index] / error } else { 0.0 }
        };
        let (x, y) = (slope(Free::Kappa, &slopes.kappa), slope(Free::Mu, &slopes.mu));
        let residual = (problem.observed[index] - slopes.predicted[index]) / error;
        a += x * x;
        b += x * y;
        c += y * y;
        p += x * residual;
        q += y * residual;
    }
    let step = match (free.contains(&Free::Kappa), free.contains(&Free::Mu)) {
        (true, false) => [p / a, 0.0],
        (false, true) => [0.0, q / c],
        _ => {
            let determinant = a * c - b * b;
            [(c * p - b * q) / determinant, (a * q - b * p) / determinant]
        }
    };
    (step[0].is_finite() && step[1].is_finite()).then_some(step)
}

/// The bottoms of different valleys, the deepest first. Two are in one valley if the way between
/// them is not higher than both.
pub fn different(lines: &Lines<'_>, mut bottoms: Vec<Bottom>) -> Result<Vec<Bottom>, FitError> {
    /// Places of the global search up to which two bottoms may be in one valley.
    const NEAR: f64 = 3.0;
    bottoms.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
    let mut kept: Vec<Bottom> = Vec::new();
    'bottoms: for bottom in bottoms {
        for other in &kept {
            let coordinates =
                |axis: &Axis| [other, &bottom].map(|it| axis.coordinate(of(axis.free, &it.values)));
            let mut near = true;
            for axis in lines.axes() {
                let [a, b] = coordinates(axis);
                near &= (a - b).abs() <= NEAR * axis.step(a);
            }
            if near && !separated(lines, other, &bottom)? {
                continue 'bottoms;
            }
        }
        kept.push(bottom);
    }
    Ok(kept)
}

/// Whether the misfit between two bottoms is higher than at both.
fn separated(lines: &Lines<'_>, a: &Bottom, b: &Bottom) -> Result<bool, FitError> {
    const BETWEEN: u32 = 7;
    let highest = a.misfit.max(b.misfit);
    for i in 1..=BETWEEN {
        let part = f64::from(i) / f64::from(BETWEEN + 1);
        let mut values = a.values;
        for axis in lines.axes() {
            let [from, to] = [a, b].map(|it| axis.coordinate(of(axis.free, &it.values)));
            axis.set(&mut values, from + part * (to - from));
        }
        if lines.problem.misfit_at(&values)? > highest * (1.0 + 1e-9) + 1e-15 {
            return Ok(true);
        }
    }
    Ok(false)
}
