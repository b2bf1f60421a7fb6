//! The part of a step up to the place where the run ends on it.

use crate::events::{dense_output, repeated_step};
use crate::hybrid::Statistics;
use crate::method::{Method, StepOf};
use crate::runs::runner::Watcher;
use crate::system::{Room, System};

/// Reports the part of `step` before `s`, where an event that changes nothing has ended the run.
#[cold]
pub(crate) fn last_part<M: Method, S: System, O: Watcher<S>>(
    system: &S,
    mode: S::Mode,
    step: &StepOf<S::State>,
    s: f64,
    statistics: &mut Statistics,
    observer: &mut O,
    room: &mut Room<S>,
) {
    if O::WANTS_SEGMENTS && s > step.s {
        let part = step.shortened(s - step.s);
        let mut part = repeated_step::<S, M>(system, mode, &part, statistics, room);
        let mut dense = room.dense();
        dense_output::<_, M>(system, mode, &mut part, &mut dense);
        observer.on_segment(mode, &dense);
    }
}
