//! The part of a step up to the place where the run ends on it.

use crate::events::dense_output;
use crate::hybrid::{HybridSystem, Observer};
use crate::method::{Method, Step};

/// Reports the part of `step` before `s`, where an event that changes nothing has ended the run.
#[cold]
pub(crate) fn last_part<M, S, O, const N: usize, const G: usize>(
    system: &S,
    mode: S::Mode,
    step: &Step<N>,
    s: f64,
    observer: &mut O,
) where
    M: Method,
    S: HybridSystem<N, G>,
    O: Observer<S::Mode, N>,
{
    if O::WANTS_SEGMENTS && s > step.s {
        let mut part = Step::blank();
        system.step::<M>(mode, &step.shortened(s - step.s), &mut part);
        observer.on_segment(mode, &dense_output::<_, M, N, G>(system, mode, &mut part));
    }
}
