//! Reports of how far a long computation has come, and threads for the tracer.

use rayon::prelude::*;
use stickslip_tracer::{Executor, Family, FreeRunOf, LabelOf, Point};

pub use stickslip_tracer::{Progress, Report, Watch};

/// Ignores all reports.
pub const SILENT: Report<'static> = &|_| {};

/// Computes the runs of a family on the threads of the current rayon pool.
///
/// ```
/// use stickslip_plane::CollisionPlane;
/// use stickslip_plane::progress::InParallel;
/// use stickslip_tracer::Surveyor;
///
/// let plane = CollisionPlane::new((5.0, 8.0), (0.8, 1.2), 0.0)?;
/// let surveyor = Surveyor::default();
/// let Surveyor { options, watch, .. } = surveyor;
/// let parallel = Surveyor { options, executor: InParallel, watch };
/// let atlas = parallel.atlas(&plane.family(), &plane.window())?;
/// assert!(atlas.agrees());
/// let serial = surveyor.atlas(&plane.family(), &plane.window())?;
/// assert_eq!(atlas.plane.curves(), serial.plane.curves());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct InParallel;

impl<F> Executor<F> for InParallel
where
    F: Family<Label: Send, Margin: Send, Error: Send> + Sync,
{
    fn free_runs(&self, family: &F, points: &[Point]) -> Vec<FreeRunOf<F>> {
        points.par_iter().map(|point| family.free_run(point)).collect()
    }

    fn labels(&self, family: &F, points: &[Point]) -> Vec<LabelOf<F>> {
        points.par_iter().map(|point| family.label(point)).collect()
    }
}
