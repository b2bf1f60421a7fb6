//! Executors compute the runs at many points, on as many threads as the caller wants.
//!
//! Only the runs of the grid and of a verification are computed this way. Following a curve is
//! serial: each node depends on the one before, and each vertex on all curves before.

use crate::family::{Family, FreeRun};
use crate::window::Point;

/// The free run of a family, or why it failed.
pub type FreeRunOf<F> =
    Result<FreeRun<<F as Family>::Label, <F as Family>::Margin>, <F as Family>::Error>;

/// The label of a family, or why its run failed.
pub type LabelOf<F> = Result<<F as Family>::Label, <F as Family>::Error>;

/// Computes the runs at many points. No run depends on another.
///
/// Both functions return as many results as there are points, in their order. Where the runs are
/// computed, and in which order, does not matter, so that an atlas is the same with any executor,
/// bit for bit. This crate starts no threads; an executor of the caller can. `stickslip_plane` has
/// one that uses the current rayon pool.
pub trait Executor<F: Family> {
    /// The free runs at `points`.
    fn free_runs(&self, family: &F, points: &[Point]) -> Vec<FreeRunOf<F>>;

    /// The labels at `points`.
    fn labels(&self, family: &F, points: &[Point]) -> Vec<LabelOf<F>>;
}

/// One run after the other.
#[derive(Clone, Copy, Debug, Default)]
pub struct Serial;

impl<F: Family> Executor<F> for Serial {
    fn free_runs(&self, family: &F, points: &[Point]) -> Vec<FreeRunOf<F>> {
        points.iter().map(|point| family.free_run(point)).collect()
    }

    fn labels(&self, family: &F, points: &[Point]) -> Vec<LabelOf<F>> {
        points.iter().map(|point| family.label(point)).collect()
    }
}
