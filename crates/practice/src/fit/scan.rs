//! The global search: minima along every line of a grid, and which of them are minima of the plane.
//!
//! One axis is the outer one. At each of its places the minima over the inner axis are found, which
//! gives the profile of the outer axis, the least misfit at each of its values. A minimum of the
//! plane is one of these that is not above those to which one descends in the neighbouring lines.

use rayon::prelude::*;

use super::FitError;
use super::axis::Axis;
use super::bodies::Values;
use super::problem::Problem;
use super::search::least;

/// A plane that is searched, or a line if there is no inner axis.
#[derive(Clone, Copy, Debug)]
pub struct Lines<'a> {
    pub problem: &'a Problem,
    /// What is not searched.
    pub fixed: Values,
    pub outer: &'a Axis,
    pub inner: Option<&'a Axis>,
}

/// A minimum along a line of the inner axis.
#[derive(Clone, Copy, Debug)]
pub struct LineMinimum {
    /// The first and the last of the places of the inner axis with the least misfit around.
    nodes: (usize, usize),
    /// The coordinate of the inner axis; 0 if there is no inner axis.
    pub at: f64,
    pub misfit: f64,
}

/// One line of the inner axis.
#[derive(Clone, Debug)]
pub struct Line {
    /// The coordinate of the outer axis.
    pub at: f64,
    /// The index of the minimum to which one descends from each place of the inner axis.
    basins: Vec<usize>,
    pub minima: Vec<LineMinimum>,
}

/// Tolerances of minima along lines, in parts of the distance of places: in the global search, and
/// where the end of an interval is looked for.
const SCANNED: f64 = 1e-4;
const PROFILED: f64 = 1e-8;
/// Places on both sides of a minimum at which the minimum of a line nearby is searched for.
const AROUND: usize = 3;

/// Whether two misfits differ by no more than rounding.
fn equal(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * (1.0 + a.abs().max(b.abs()))
}

impl Lines<'_> {
    /// The values at coordinates of both axes.
    pub fn values(&self, outer: f64, inner: f64) -> Values {
        let mut values = self.fixed;
        self.outer.set(&mut values, outer);
        if let Some(axis) = self.inner {
            axis.set(&mut values, inner);
        }
        values
    }

    /// The misfit at coordinates of both axes.
    pub fn misfit(&self, outer: f64, inner: f64) -> Result<f64, FitError> {
        self.problem.misfit_at(&self.values(outer, inner))
    }

    /// The line at a coordinate of the outer axis, on the threads of the current pool.
    pub fn line(&self, outer: f64) -> Result<Line, FitError> {
        let misfits: Vec<_> = match self.inner {
            Some(inner) => inner.places.par_iter().map(|at| self.misfit(outer, *at)).collect(),
            None => vec![self.misfit(outer, 0.0)],
        };
        self.line_of(outer, &misfits.into_iter().collect::<Result<Vec<_>, _>>()?)
    }

    /// The line whose misfits at the places of the inner axis are known.
    pub fn line_of(&self, outer: f64, misfits: &[f64]) -> Result<Line, FitError> {
        let (bottoms, basins) = bottoms(misfits);
        let minima =
            bottoms.into_iter().map(|nodes| self.line_minimum(outer, nodes, (0, misfits), SCANNED));
        Ok(Line { at: outer, basins, minima: minima.collect::<Result<_, _>>()? })
    }

    /// The minimum around the lowest places of the inner axis; `start` is the first of these.
    fn line_minimum(
        &self,
        outer: f64,
        (first, last): (usize, usize),
        (start, misfits): (usize, &[f64]),
        tolerance: f64,
    ) -> Result<LineMinimum, FitError> {
        let nodes = (start + first, start + last);
        let misfit = misfits[first];
        let Some(inner) = self.inner else { return Ok(LineMinimum { nodes, at: 0.0, misfit }) };
        let place = LineMinimum { nodes, at: inner.places[nodes.0], misfit };
        if first != last {
            return Ok(place);
        }
        let low = inner.places[nodes.0.saturating_sub(1)];
        let high = inner.places[(nodes.1 + 1).min(inner.places.len() - 1)];
        let (at, misfit) = least((low, high), tolerance, |at| self.misfit(outer, at))?;
        Ok(if misfit < place.misfit { LineMinimum { nodes, at, misfit } } else { place })
    }

    /// The least misfit over the inner axis, at a coordinate of the outer one between two lines. It
    /// is looked for around the minima of both.
    pub fn profile(&self, outer: f64, between: [&Line; 2]) -> Result<f64, FitError> {
        let Some(inner) = self.inner else { return self.misfit(outer, 0.0) };
        let mut near = vec![false; inner.places.len()];
        for minimum in between.iter().flat_map(|line| &line.minima) {
            let end = (minimum.nodes.1 + AROUND + 1).min(near.len());
            near[minimum.nodes.0.saturating_sub(AROUND)..end].fill(true);
        }
        let mut best = f64::INFINITY;
        let mut first = 0;
        while let Some(from) = near[first..].iter().position(|near| *near).map(|it| first + it) {
            let to = near[from..].iter().position(|near| !near).map_or(near.len(), |it| from + it);
            let misfits = inner.places[from..to].iter().map(|at| self.misfit(outer, *at));
            let misfits = misfits.collect::<Result<Vec<f64>, _>>()?;
            for nodes in bottoms(&misfits).0 {
                let found = self.line_minimum(outer, nodes, (from, &misfits), PROFILED)?;
                best = best.min(found.misfit);
            }
            first = to;
        }
        Ok(best)
    }
}

impl Line {
    /// The least minimum. Each line has at least one.
    pub fn best(&self) -> LineMinimum {
        let least = |a: &LineMinimum, b: &LineMinimum| a.misfit.total_cmp(&b.misfit);
        let nowhere = LineMinimum { nodes: (0, 0), at: f64::NAN, misfit: f64::NAN };
        self.minima.iter().copied().min_by(least).unwrap_or(nowhere)
    }
}

/// The lowest places of a list, as runs of equal values with higher ones, or the end, on both
/// sides; and for each place the index of the run to which one descends from there.
fn bottoms(values: &[f64]) -> (Vec<(usize, usize)>, Vec<usize>) {
    let ends =
        (0..values.len()).filter(|&i| i + 1 == values.len() || !equal(values[i], values[i + 1]));
    let mut runs = Vec::new();
    for last in ends {
        let first = runs.last().map_or(0, |&(_, last): &(usize, usize)| last + 1);
        runs.push((first, last));
    }
    // Whoever has gone on to a lower run never turns back: every way comes to an end.
    let next = |run: usize| {
        let (first, last) = runs[run];
        let left = first.checked_sub(1).map_or(0.0, |i| values[first] - values[i]);
        let right = values.get(last + 1).map_or(0.0, |value| values[last] - value);
        if left > 0.0 && left >= right {
            run - 1
        } else if right > 0.0 {
            run + 1
        } else {
            run
        }
    };
    let (mut found, mut lowest) = (Vec::new(), Vec::new());
    let mut ways = vec![0; runs.len()];
    for run in 0..runs.len() {
        let mut at = run;
        while next(at) != at {
            at = next(at);
        }
        ways[run] = at;
        if at == run {
            found.push(run);
            lowest.push(runs[run]);
        }
    }
    let mut basins = Vec::with_capacity(values.len());
    for (run, (first, last)) in runs.iter().enumerate() {
        let basin = found.iter().position(|&bottom| bottom == ways[run]).unwrap_or(0);
        basins.extend(std::iter::repeat_n(basin, last + 1 - first));
    }
    (lowest, basins)
}

/// The minima of the plane among the minima of its lines, as coordinates of the outer and the inner
/// axis. If successive lines have equal minima, as on a plain, the last one counts.
pub fn candidates(lines: &[Line]) -> Vec<[f64; 2]> {
    let mut found = Vec::new();
    // Whether each minimum of the line before is reached from above.
    let mut reached: Vec<bool> = Vec::new();
    for (index, line) in lines.iter().enumerate() {
        let neighbour = |other: Option<usize>, minimum: &LineMinimum| {
            let line = lines.get(other?)?;
            let place = *line.basins.get(minimum.nodes.0)?;
            Some((place, line.minima.get(place)?.misfit))
        };
        let mut now = Vec::with_capacity(line.minima.len());
        for minimum in &line.minima {
            let from_above = match neighbour(index.checked_sub(1), minimum) {
                Some((place, misfit)) if equal(misfit, minimum.misfit) => {
                    reached.get(place).copied().unwrap_or(true)
                }
                Some((_, misfit)) => misfit > minimum.misfit,
                None => true,
            };
            let rises = neighbour(Some(index + 1), minimum).is_none_or(|(_, misfit)| {
                misfit > minimum.misfit && !equal(misfit, minimum.misfit)
            });
            if from_above && rises {
                found.push([line.at, minimum.at]);
            }
            now.push(from_above);
        }
        reached = now;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bottoms_of_lists() {
        let found = bottoms(&[3.0, 1.0, 2.0, 2.0, 5.0, 0.0]);
        assert_eq!(found, (vec![(1, 1), (5, 5)], vec![0, 0, 0, 0, 1, 1]));
        assert_eq!(bottoms(&[1.0, 1.0, 1.0]), (vec![(0, 2)], vec![0, 0, 0]));
        assert_eq!(bottoms(&[1.0, 2.0, 2.0, 1.0]).0, [(0, 0), (3, 3)]);
        assert_eq!(bottoms(&[]), (vec![], vec![]));
        // Steps that are rounding, down and up again.
        let slope: Vec<f64> = (0..9).map(|i| 1.0 - 1e-13 * f64::from((i - 4) * (i - 4))).collect();
        assert_eq!(bottoms(&slope), (vec![(0, 8)], vec![0; 9]));
    }

    /// Lines of a surface with its minima at places, without refinement.
    fn lines(surface: impl Fn(f64, f64) -> f64) -> Vec<Line> {
        let line = |x: usize| {
            let misfits: Vec<f64> = (0..40).map(|y| surface(x as f64, f64::from(y))).collect();
            let minimum = |nodes: (usize, usize)| LineMinimum {
                nodes,
                at: nodes.0 as f64,
                misfit: misfits[nodes.0],
            };
            let (bottoms, basins) = bottoms(&misfits);
            let minima = bottoms.into_iter().map(minimum).collect();
            Line { at: x as f64, basins, minima }
        };
        (0..40).map(line).collect()
    }

    #[test]
    fn minima_of_surfaces() {
        let bowls = |x: f64, y: f64| {
            let bowl = |a: f64, b: f64, c: f64| (x - a).powi(2) + (y - b).powi(2) + c;
            bowl(8.0, 9.0, 1.0).min(bowl(30.0, 8.0, 2.0)).min(bowl(21.0, 33.0, 0.0))
        };
        let mut found = candidates(&lines(bowls));
        found.sort_by(|a, b| a[0].total_cmp(&b[0]));
        assert_eq!(found, [[8.0, 9.0], [21.0, 33.0], [30.0, 8.0]]);
        // A plain is one minimum.
        assert_eq!(candidates(&lines(|_, _| 1.0)), [[39.0, 0.0]]);
        // The bottom of a valley that falls to one end.
        let valley = |x: f64, y: f64| (y - 20.0).powi(2) - x;
        assert_eq!(candidates(&lines(valley)), [[39.0, 20.0]]);
    }
}
