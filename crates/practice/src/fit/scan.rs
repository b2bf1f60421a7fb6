//! The global search: minima along every line of a grid.
//!
//! One axis is the outer one. At each of its places the minima over the inner axis are found, which
//! gives the profile of the outer axis, the least misfit at each of its values.

use rayon::prelude::*;

use super::FitError;
use super::axis::Axis;
use super::bodies::Values;
use super::minima::{Line, LineMinimum, bottoms};
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

/// Tolerances of minima along lines, in parts of the distance of places: in the global search, and
/// where the end of an interval is looked for.
const SCANNED: f64 = 1e-4;
const PROFILED: f64 = 1e-8;
/// Places on both sides of a minimum at which that of a line nearby is looked for.
const AROUND: usize = 3;

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

    /// The minimum around places of the inner axis that are the lowest of some, of which `start` is
    /// the first.
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
