//! A size for the first step of a dynamic run, as [`crate::method::control`] estimates it.

use crate::dynamic::step::{Field, Origin};
use crate::method::Method;

/// A size for the first step, from the sizes of the state, of its derivative and of its second
/// derivative. `moved` and `slope` are room.
pub(crate) fn first_step<M: Method>(
    field: &dyn Field,
    from: Origin<'_>,
    (rtol, atol): (f64, f64),
    longest: f64,
    (moved, slope): (&mut [f64], &mut [f64]),
) -> f64 {
    let norm = |v: &[f64]| -> f64 {
        v.iter().zip(from.y).map(|(v, y)| (v / (atol + rtol * y.abs())).powi(2)).sum()
    };
    let (state_size, slope_size) = (norm(from.y), norm(from.slope));
    let guess = if state_size <= 1e-10 || slope_size <= 1e-10 {
        1e-6
    } else {
        0.01 * (state_size / slope_size).sqrt()
    };
    // Numbers at the ends of the range of doubles may overflow in between.
    let guess = if guess > 0.0 { guess } else { 1e-6 };
    let h = guess.min(longest);
    for ((moved, y), f) in moved.iter_mut().zip(from.y).zip(from.slope) {
        *moved = y + f * h;
    }
    field(from.s + h, moved, slope);
    for (f1, f0) in slope.iter_mut().zip(from.slope) {
        *f1 -= f0;
    }
    let curvature = norm(slope).sqrt() / h;
    let largest = curvature.max(slope_size.sqrt());
    let order = M::CONTROL_ORDER as f64;
    let step =
        if largest <= 1e-15 { (h * 1e-3).max(1e-6) } else { (0.01 / largest).powf(1.0 / order) };
    let step = if step > 0.0 { step } else { h };
    step.min(100.0 * h).min(longest)
}
