//! What follows a step that was rejected.

use crate::error::RunError;
use crate::hybrid::Statistics;
use crate::method::Method;
use crate::method::control::Controller;
use crate::options::{Options, StepSize};

/// The size of the next attempt after a step from `s` of size `h` that had this `error`. `finite`
/// says whether it led to a finite state.
pub(crate) fn after_rejection<M: Method>(
    (controller, statistics): (&mut Controller, &mut Statistics),
    options: &Options,
    (s, h): (f64, f64),
    error: f64,
    finite: bool,
) -> Result<f64, RunError> {
    statistics.rejected += 1;
    let step = statistics.tried();
    if let StepSize::Fixed(_) = options.step_size {
        return Err(RunError::Field { s, step });
    }
    let next = controller.rejected::<M>(h, error);
    if next > f64::EPSILON * s.abs().max(f64::MIN_POSITIVE) {
        Ok(next)
    } else if finite {
        Err(RunError::Tolerance { s, h: next, step })
    } else {
        Err(RunError::Field { s, step })
    }
}
