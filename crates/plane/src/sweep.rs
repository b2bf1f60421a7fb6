//! The collisions of a grid, computed in parallel.

use std::ops;

use rayon::prelude::*;
use stickslip_model::{CollisionError, Engine, InvalidValue};

use crate::grid::{Grid, Quantity};
use crate::tile::{NO_COUNT, NO_EPS_T, Tile};

/// The reason why a point of a grid has no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PointError {
    /// No collision has these parameters.
    #[error(transparent)]
    Parameter(#[from] InvalidValue),
    /// The collision cannot be computed.
    #[error(transparent)]
    Engine(#[from] CollisionError),
    /// The grid has no such point.
    #[error("point {index} of a map of {points} points")]
    Outside {
        /// The number of the point.
        index: usize,
        /// The number of all points.
        points: usize,
    },
    /// The number of switches does not fit into a [`Tile`].
    #[error("{count} switches; a map holds up to 2147483647")]
    Count {
        /// The number of switches.
        count: usize,
    },
}

/// The points of a map that have no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("kappa = {kappa:?}, psi = {psi:?}: {error}")]
pub struct Failed {
    /// The number of points without a result.
    pub points: usize,
    /// κ at the first of them.
    pub kappa: f64,
    /// ψ at the first of them.
    pub psi: f64,
    /// The reason why the first of them has no result.
    pub error: PointError,
}

/// Computes successive points of `grid` on the threads of the current rayon pool.
///
/// The results are the same with any number of threads. A point that cannot be computed gets
/// [`NO_EPS_T`] and [`NO_COUNT`]; [`point()`] says why, and [`FailureCount`] counts such points.
/// Points that the grid does not have get them too.
///
/// # Panics
/// If the results of all points do not fit into memory.
#[must_use]
pub fn compute(grid: &Grid, engine: Engine, points: ops::Range<usize>) -> Tile {
    let mut tile = Tile { eps_t: Vec::new(), switch_count: Vec::new() };
    points
        .into_par_iter()
        .map(|index| point(grid, engine, index).unwrap_or((NO_EPS_T, NO_COUNT)))
        .unzip_into_vecs(&mut tile.eps_t, &mut tile.switch_count);
    tile
}

/// The tangential restitution and the number of switches at a point of `grid`.
///
/// # Errors
/// [`PointError`] says why the point has no result.
pub fn point(grid: &Grid, engine: Engine, index: usize) -> Result<(f64, i32), PointError> {
    if index >= grid.points() {
        return Err(PointError::Outside { index, points: grid.points() });
    }
    let (column, row) = grid.cell(index);
    let (collision, _) = engine.collide(grid.contact(column, row)?)?;
    let count = collision.switches.len();
    let switch_count = i32::try_from(count).map_err(|_| PointError::Count { count })?;
    Ok((collision.eps_t(), switch_count))
}

/// Counts the points without a result while tiles arrive.
///
/// Tiles do not keep the reasons. [`Self::failed`] finds the reason of the first such point.
#[derive(Clone, Copy, Debug, Default)]
pub struct FailureCount {
    points: usize,
    first: Option<usize>,
}

impl FailureCount {
    /// Looks at the results of successive points; `start` is the first one.
    pub fn add(&mut self, start: usize, tile: &Tile) {
        for (index, count) in tile.switch_count.iter().enumerate() {
            if *count == NO_COUNT {
                self.points += 1;
                self.first.get_or_insert(start.saturating_add(index));
            }
        }
    }

    /// The number of points without a result.
    #[must_use]
    pub fn points(&self) -> usize {
        self.points
    }

    /// The points without a result, if there are any. The first one is computed again, to learn the
    /// reason.
    #[must_use]
    pub fn failed(&self, grid: &Grid, engine: Engine) -> Option<Failed> {
        let first = self.first?;
        let (column, row) = grid.cell(first);
        let [kappa, psi] = [Quantity::Kappa, Quantity::Psi].map(|q| grid.value(q, column, row));
        let error = point(grid, engine, first).err()?;
        Some(Failed { points: self.points, kappa, psi, error })
    }
}
