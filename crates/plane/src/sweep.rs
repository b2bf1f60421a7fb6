//! The collisions of a grid, computed in parallel.

use std::{fmt, ops};

use rayon::prelude::*;
use stickslip_model::{CollisionError, Engine, InvalidValue};
use twox_hash::XxHash3_128;

use crate::grid::{Grid, Quantity};

/// The points of a map that have no result.
#[derive(Clone, Debug, PartialEq)]
pub struct FailedPoints {
    /// The number of points without a result.
    pub points: usize,
    /// κ at the first of them.
    pub kappa: f64,
    /// ψ at the first of them.
    pub psi: f64,
    /// The reason why the first of them has no result.
    pub error: CollisionError,
}

impl fmt::Display for FailedPoints {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "kappa = {:?}, psi = {:?}: {}", self.kappa, self.psi, self.error)
    }
}

/// Computes successive points of `grid` on the threads of the current rayon pool.
///
/// The results are the same with any number of threads. A point that cannot be computed gets
/// [`NO_EPS_T`] and [`NO_COUNT`]; [`point()`] says why, and [`FailureCount`] counts such points.
/// Points that the grid does not have get them too. Bodies that stay together have [`NO_EPS_T`] and
/// the number of switches up to where that is certain.
///
/// # Panics
/// If the results of all points do not fit into memory.
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
/// [`CollisionError`] says why the point has no result, also if the grid does not have it.
pub fn point(grid: &Grid, engine: Engine, index: usize) -> Result<(f64, i32), CollisionError> {
    if index >= grid.points() {
        let expected = format!("a point of a map of {}", grid.points());
        return Err(InvalidValue::new("point", index, expected).into());
    }
    let (column, row) = grid.cell(index);
    let (collision, _) = engine.collide(grid.contact(column, row)?)?;
    let count = collision.switches.len();
    let switch_count = i32::try_from(count)
        .map_err(|_| InvalidValue::new("switches", count, "up to 2147483647 in a map"))?;
    Ok((if collision.adheres { NO_EPS_T } else { collision.eps_t() }, switch_count))
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
    pub fn points(&self) -> usize {
        self.points
    }

    /// The points without a result, if there are any. The first one is computed again, to learn the
    /// reason.
    pub fn failed(&self, grid: &Grid, engine: Engine) -> Option<FailedPoints> {
        let first = self.first?;
        let (column, row) = grid.cell(first);
        let [kappa, psi] = [Quantity::Kappa, Quantity::Psi].map(|q| grid.value(q, column, row));
        let error = point(grid, engine, first).err()?;
        Some(FailedPoints { points: self.points, kappa, psi, error })
    }
}

/// Tangential restitution and number of switches at successive points.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    /// Tangential restitution ε_t of each point; [`NO_EPS_T`] where it could not be computed, and
    /// where bodies stay together.
    pub eps_t: Vec<f64>,
    /// Number of switches at each point; [`NO_COUNT`] where it could not be computed.
    pub switch_count: Vec<i32>,
}

/// Stands for ε_t where it could not be computed, or there is none: a NaN that always has the same
/// bits.
pub const NO_EPS_T: f64 = f64::NAN;
/// Stands for the number of switches where it could not be computed.
pub const NO_COUNT: i32 = -1;

impl Tile {
    /// The tile as bytes: `label`, all ε_t, all counts, and a checksum over everything before it.
    ///
    /// Numbers are little-endian. The label names the map and the place of the tile in it.
    pub fn to_bytes(&self, label: &str) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(Self::length(label, self.eps_t.len()));
        bytes.extend_from_slice(label.as_bytes());
        bytes.extend(self.eps_t.iter().flat_map(|value| value.to_le_bytes()));
        bytes.extend(self.switch_count.iter().flat_map(|count| count.to_le_bytes()));
        bytes.extend(XxHash3_128::oneshot(&bytes).to_le_bytes());
        bytes
    }

    /// The number of bytes that a tile of `points` points has with `label`.
    pub fn length(label: &str, points: usize) -> usize {
        label.len() + points * (8 + 4) + 16
    }

    /// Reads a tile of `points` points. It is `None` unless [`Self::to_bytes`] wrote `bytes` with
    /// the same label.
    pub fn from_bytes(bytes: &[u8], label: &str, points: usize) -> Option<Self> {
        if points > bytes.len() || bytes.len() != Self::length(label, points) {
            return None;
        }
        let (content, checksum) = bytes.split_last_chunk()?;
        if XxHash3_128::oneshot(content) != u128::from_le_bytes(*checksum) {
            return None;
        }
        let results = content.strip_prefix(label.as_bytes())?;
        let (eps_t, switch_count) = results.split_at_checked(8 * points)?;
        let eps_t = eps_t.as_chunks().0.iter().map(|bytes| f64::from_le_bytes(*bytes));
        let switch_count = switch_count.as_chunks().0.iter();
        Some(Self {
            eps_t: eps_t.collect(),
            switch_count: switch_count.map(|bytes| i32::from_le_bytes(*bytes)).collect(),
        })
    }
}
