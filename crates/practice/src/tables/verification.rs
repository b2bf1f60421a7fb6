//! A table compared with collisions.

use rayon::prelude::*;
use stickslip_model::{Collision, Contact};

use super::TableError;
use super::chebyshev::value;
use super::strip::{exact_eps_t, within};
use super::table::{Arrays, Table};

/// What the comparison of a table with collisions found.
///
/// The points are none of those with which the table was made: points at random in each strip, and
/// points on both sides of each boundary, at distances in ψ from 1e-15 to 0.1 of its strip.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Verification {
    /// The number of points.
    pub points: u64,
    /// The largest error of ε_t.
    pub largest_error: f64,
    /// κ at the largest error.
    pub kappa: f64,
    /// ψ at the largest error.
    pub psi: f64,
}

/// Points at random in each strip.
const RANDOM: usize = 48;
/// Points beside each end of a strip.
const BESIDE: u32 = 16;

/// Compares a table with collisions, on the threads of the current rayon pool.
///
/// # Errors
/// [`TableError::Engine`]: a collision cannot be computed.
pub fn verify(table: &Table) -> Result<Verification, TableError> {
    let slabs = 0..table.arrays().scales.len();
    let found = slabs.into_par_iter().map(|slab| in_slab(table, slab));
    let found: Vec<Result<Verification, TableError>> = found.collect();
    let none = Verification { points: 0, largest_error: 0.0, kappa: 0.0, psi: 0.0 };
    found.into_iter().try_fold(none, |all, next| {
        let next = next?;
        let worse = !within(next.largest_error, all.largest_error);
        let points = all.points + next.points;
        Ok(Verification { points, ..if worse { next } else { all } })
    })
}

fn in_slab(table: &Table, slab: usize) -> Result<Verification, TableError> {
    let arrays = table.arrays();
    let mut random = fastrand::Rng::with_seed(slab as u64);
    let mut collision = Collision::before(Contact::new(1.0, 1.0, 0.0)?);
    let mut found = Verification { points: 0, largest_error: 0.0, kappa: 0.0, psi: 0.0 };
    let mut compare = |[kappa, psi]: [f64; 2]| {
        let kappa = kappa.clamp(table.kappa[0], table.kappa[1]);
        let psi = psi.clamp(table.psi[0], table.psi[1]);
        let exact = exact_eps_t([kappa, psi], table.damping, &mut collision)?;
        let error = (table.eps_t(kappa, psi) - exact).abs();
        if !within(error, found.largest_error) {
            (found.largest_error, found.kappa, found.psi) = (error, kappa, psi);
        }
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

impl Arrays {
    /// κ and ψ at a part of a slab and of a strip.
    fn inside(&self, slab: usize, strip: usize, along: f64, across: f64) -> [f64; 2] {
        let (low, high) = (self.walls[slab], self.walls[slab + 1]);
        let kappa = low + (high - low) * along;
        let stretched = self.slab_stretches[slab].of(along);
        let (graphs, _) = self.graphs.as_chunks();
        let [low, high] = [strip, strip + 1].map(|strip| value(&graphs[strip], stretched));
        [kappa, low + (high - low) * across]
    }
}
