//! Which collisions are tried, and how: at random, along a line, in parallel.

use fastrand::Rng;
use rayon::prelude::*;

use crate::error::ReproductionError;

/// The results of `of` for all `inputs`, in their order, on the threads of the current pool.
///
/// # Errors
/// The first error in that order, whatever the number of threads.
pub fn each<T: Sync, U: Send>(
    inputs: &[T],
    of: impl Fn(&T) -> Result<U, ReproductionError> + Send + Sync,
) -> Result<Vec<U>, ReproductionError> {
    let results: Vec<_> = inputs.par_iter().map(of).collect();
    results.into_iter().collect()
}

/// Random collisions [κ, ψ, a]: κ from 0.05 to 1000 and, if damped, a from 0.001 to 1, evenly in
/// the logarithm; ψ from 0.01 to 3.
pub fn random(count: usize, seed: u64, damped: bool) -> Vec<[f64; 3]> {
    let mut random = Rng::with_seed(seed);
    let mut draw = || {
        let kappa = 0.05 * 20_000_f64.powf(random.f64());
        let psi = 0.01 + 2.99 * random.f64();
        [kappa, psi, if damped { 1e-3 * 1e3_f64.powf(random.f64()) } else { 0.0 }]
    };
    (0..count).map(|_| draw()).collect()
}

/// `count` numbers from `low` to `high`, evenly in the logarithm.
pub fn geometric(low: f64, high: f64, count: usize) -> impl Iterator<Item = f64> + Clone {
    (0..count).map(move |i| low * (high / low).powf(i as f64 / (count - 1) as f64))
}
