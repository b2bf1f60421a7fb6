//! The part of a step up to the place where the run ends on it.

use crate::events::{dense_output, repeated_step};
use crate::hybrid::{HybridSystem, Observer, Statistics};
use crate::method::{Method, Step};

/// Reports the part of `step` before `s`, where an event that changes nothing has ended the run.
#[cold]
pub(crate) fn last_part<M, S, O, const N: usize, const G: usize>(
    system: &S,
    mode: S::Mode,
    step: &Step<N>,
    s: f64,
    statistics: &mut Statistics,
    observer: &mut O,
) where
    M: Method,
    S: HybridSystem<N, G>,
    O: Observer<S::Mode, N>,
{
    if O::WANTS_SEGMENTS && s > step.s {
        let part = step.shortened(s - step.s);
        let mut part = repeated_step::<S, M, N, G>(system, mode, &part, statistics);
        observer.on_segment(mode, &dense_output::<_, M, N, G>(system, mode, &mut part));
    }
}
