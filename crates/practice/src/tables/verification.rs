//! A table compared with collisions.

use rayon::prelude::*;
use stickslip_model::{Collision, Contact};
use stickslip_plane::CollisionPlane;

use super::TableError;
use super::chebyshev::value;
use super::strip::{restitution, within};
use super::table::{Arrays, RestitutionTable, TableVerification};

/// Points at random in each strip.
const RANDOM: usize = 48;
/// Points beside each end of a strip.
const BESIDE: u32 = 16;

/// Compares a table with collisions, on the threads of the current rayon pool.
///
/// # Errors
/// [`TableError::Engine`]: a collision cannot be computed.
pub fn verify(
    table: &RestitutionTable,
    plane: &CollisionPlane,
) -> Result<TableVerification, TableError> {
    let slabs = 0..table.arrays().scales.len();
    let found = slabs.into_par_iter().map(|slab| in_slab(table, plane, slab));
    let found: Vec<Result<TableVerification, TableError>> = found.collect();
    found.into_iter().try_fold(TableVerification::NONE, |all, next| {
        let next = next?;
        let worse = !within(next.largest_error, all.largest_error);
        let points = all.points + next.points;
        let largest_error_of_eps_n =
            larger(all.largest_error_of_eps_n, next.largest_error_of_eps_n);
        Ok(TableVerification { points, largest_error_of_eps_n, ..if worse { next } else { all } })
    })
}

fn in_slab(
    table: &RestitutionTable,
    plane: &CollisionPlane,
    slab: usize,
) -> Result<TableVerification, TableError> {
    let arrays = table.arrays();
    let mut random = fastrand::Rng::with_seed(slab as u64);
    let mut collision = Collision::before(Contact::new(1.0, 1.0, 0.0)?);
    let mut found = TableVerification::NONE;
    let mut compare = |[x, y]: [f64; 2]| {
        let x = x.clamp(table.sides[0].low, table.sides[0].high);
        let y = y.clamp(table.sides[1].low, table.sides[1].high);
        let [eps_t, eps_n] = restitution(plane, [x, y], &mut collision)?;
        let error = (table.eps_t(x, y) - eps_t).abs();
        if !within(error, found.largest_error) {
            (found.largest_error, found.x, found.y) = (error, x, y);
        }
        let error = (table.eps_n(x) - eps_n).abs();
        found.largest_error_of_eps_n = larger(found.largest_error_of_eps_n, error);
        found.points += 1;
        Ok::<(), TableError>(())
    };
    let [first, end] = [slab, slab + 1].map(|slab| arrays.first_strips[slab] as usize);
    for strip in first..end - 1 {
        for _ in 0..RANDOM {
            let across = random.f64();
            compare(arrays.inside(slab, strip, random.f64(), across))?;
        }
        for _ in 0..BESIDE {
            let distance = 10_f64.powf(-1.0 - 14.0 * random.f64());
            for across in [0.0, distance, 1.0 - distance, 1.0] {
                compare(arrays.inside(slab, strip, random.f64(), across))?;
                compare(arrays.inside(slab, strip, distance, across))?;
                compare(arrays.inside(slab, strip, 1.0 - distance, across))?;
            }
        }
    }
    Ok(found)
}

/// The larger one of two errors. What is not a number is larger.
fn larger(one: f64, other: f64) -> f64 {
    if within(one, other) { other } else { one }
}

impl Arrays {
    /// x and y at a part of a slab and of a strip.
    fn inside(&self, slab: usize, strip: usize, along: f64, across: f64) -> [f64; 2] {
        let (low, high) = (self.walls[slab], self.walls[slab + 1]);
        let x = low + (high - low) * along;
        let stretched = self.slab_stretches[slab].of(along);
        let (graphs, _) = self.graphs.as_chunks();
        let [low, high] = [strip, strip + 1].map(|strip| value(&graphs[strip], stretched));
        [x, low + (high - low) * across]
    }
}
