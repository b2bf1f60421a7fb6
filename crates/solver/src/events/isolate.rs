//! Isolation: it decides whether a guard crosses zero on a step.
//!
//! Along the dense output a guard is an analytic function q of the step fraction θ. It is expanded
//! in Chebyshev polynomials on panels that are narrow enough for degree 8. Bounds on the
//! coefficients and subdivision isolate its critical points. These cut the step into pieces on
//! which q is monotone, and on each piece the signs at the ends decide. If a value is smaller than
//! the error of the dense output, a step of the method to that point tells its sign.
//!
//! Few steps come here. A curve is therefore dispatched at run time, and all this is compiled once,
//! not once for each system and method.

mod chebyshev;
mod curve;
mod panel;

use std::ops::ControlFlow;

use crate::error::RunError;
use crate::events::isolate::curve::{Accuracy, DEPTH, NARROWEST, Quotient, power};
use crate::events::isolate::panel::{Panel, Points};

pub(crate) use curve::{Curve, noise};

/// Panels are halved at most this often in the search for critical points. A stretch that is flat
/// to within the error ends the search earlier.
const CRITICAL_DEPTH: u32 = 45;
/// The part of the step on which a quotient is expanded to find its value at the start.
const OPENING: f64 = 0.25;

/// The step fractions between which a curve crosses from ≥ 0 to < 0, and a guess in between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bracket {
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) guess: f64,
}

/// A local extremum whose distance from zero is within the error of the dense output, and its value
/// by a step of the method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Touch {
    pub(crate) theta: f64,
    pub(crate) margin: f64,
}

/// What isolation finds out about a guard on a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Verdict {
    /// The guard does not cross zero.
    None,
    /// The first crossing of the guard.
    Crossing(Bracket),
    /// The guard bounds a domain and is negative from the start.
    StartsBelow,
    /// The guard is not resolved on this step, so that a shorter one is needed.
    TooCoarse,
}

/// Finds the first crossing of a curve from ≥ 0 to < 0.
///
/// `zero_order` is the order of a known zero at θ = 0, which is divided out. `side` is the sign
/// with which the curve leaves this zero, or 0 if that is not known. If it is known, values up to
/// `hidden` count as zero. `start` and `end` are the curve's values at the ends of the step. If the
/// curve bounds a `domain`, a negative start counts too. Touches before the crossing go to
/// `on_touch`.
pub(crate) fn first_crossing(
    curve: &mut dyn Curve,
    (zero_order, side, hidden): (u32, f64, f64),
    domain: bool,
    (start, end): (f64, f64),
    on_touch: &mut dyn FnMut(Touch),
) -> Result<Verdict, RunError> {
    let mut quotient = Quotient { curve, order: zero_order };
    let mut accuracy = quotient.accuracy();
    if accuracy.dense.is_nan() {
        return Ok(Verdict::TooCoarse);
    }
    if side != 0.0 {
        // Values up to `hidden` count as zero at the start.
        accuracy.state.0 = accuracy.state.0.max(hidden);
    }
    // The last point whose sign is known, and the value there.
    let mut before = Some((0.0, start));
    if zero_order > 0 {
        let panel = Panel::new(0.0, OPENING, |theta| quotient.at(theta).0);
        let opening = panel.at(-1.0);
        if side == 0.0 {
            if panel.tail() > accuracy.on(&panel, zero_order) {
                accuracy.noise = quotient.noise(0.5 * OPENING, 0.5 * OPENING + NARROWEST);
            }
            let error = accuracy.on(&panel, zero_order);
            before = Some((0.0, opening)).filter(|_| opening.abs() > error);
            // A shorter step diminishes the error at the opening, but not the effect of noise and
            // rounding at the start.
            if before.is_none() && 2.0 * accuracy.lasting(&panel, zero_order) < error {
                return Ok(Verdict::TooCoarse);
            }
        } else {
            before = Some((0.0, opening.abs().max(f64::MIN_POSITIVE).copysign(side)));
        }
    }
    if domain && before.is_some_and(|(_, value)| value < 0.0) {
        return Ok(Verdict::StartsBelow);
    }
    let hidden = if zero_order > 0 { accuracy.state.0 } else { 0.0 };
    let end = (end, -1.0);
    let walked = walk(&mut quotient, &mut accuracy, hidden, end, on_touch, |quotient, point| {
        match before {
            Some(before) if before.1 >= 0.0 && point.1 < 0.0 => {
                let guess = panel_root(quotient, before, point);
                let bracket = Bracket { low: before.0, high: point.0, guess };
                return ControlFlow::Break(Verdict::Crossing(bracket));
            }
            // The first sign that can be told is that with which the curve leaves its zero.
            None if domain && point.1 < 0.0 => return ControlFlow::Break(Verdict::StartsBelow),
            _ => before = Some(point),
        }
        ControlFlow::Continue(())
    })?;
    Ok(match walked {
        Some(ControlFlow::Break(verdict)) => verdict,
        Some(ControlFlow::Continue(())) => Verdict::None,
        None => Verdict::TooCoarse,
    })
}

/// The first and the last sign that a curve shows on a step. They are 0 if it shows none. At the
/// ends of the step, values up to `hidden` have no sign. `None` means that a shorter step is
/// needed.
pub(crate) fn sides(
    curve: &mut dyn Curve,
    hidden: f64,
    end: f64,
) -> Result<Option<[f64; 2]>, RunError> {
    let mut quotient = Quotient { curve, order: 0 };
    let mut accuracy = quotient.accuracy();
    if accuracy.dense.is_nan() {
        return Ok(None);
    }
    accuracy.noise = hidden;
    let mut sides = [0.0; 2];
    let inside = accuracy.state.1;
    let end = (end, hidden + inside);
    let walked = walk(
        &mut quotient,
        &mut accuracy,
        inside,
        end,
        |_| {},
        |_, (_, value)| {
            let side = value.signum();
            sides = [if sides[0] == 0.0 { side } else { sides[0] }, side];
            ControlFlow::<()>::Continue(())
        },
    )?;
    Ok(walked.map(|_| sides))
}

/// Visits points between which a quotient is monotone, from left to right, with the values there.
///
/// Points are left out if the guard's value there is within noise and `hidden` of zero, so that it
/// has no sign. The value `end` at the end of the step is given. If it is within `hidden_end` of
/// zero, the middle of the last piece is visited instead. The result is `None` if the step is too
/// coarse.
fn walk<B>(
    quotient: &mut Quotient<'_>,
    accuracy: &mut Accuracy,
    hidden: f64,
    (end, hidden_end): (f64, f64),
    mut on_touch: impl FnMut(Touch),
    mut visit: impl FnMut(&mut Quotient<'_>, (f64, f64)) -> ControlFlow<B>,
) -> Result<Option<ControlFlow<B>>, RunError> {
    let order = quotient.order;
    let mut pending = [(0.0, 0.0); DEPTH as usize + 2];
    pending[0] = (0.0, 1.0);
    let mut count = 1;
    while count > 0 {
        count -= 1;
        let (low, high) = pending[count];
        let panel = Panel::new(low, high, |theta| quotient.at(theta).0);
        let mut error = accuracy.on(&panel, order);
        if panel.tail().is_nan() {
            return Ok(None);
        }
        let narrow = high - low < 1.5 * NARROWEST;
        if panel.tail() > error && narrow {
            // Structure that even the narrowest panel does not resolve may be noise. A shorter step
            // would not diminish that.
            accuracy.noise = accuracy.noise.max(quotient.noise(low, high));
            error = accuracy.on(&panel, order);
        }
        if panel.tail() > error {
            if narrow {
                return Ok(None);
            }
            let middle = 0.5 * (low + high);
            pending[count] = (middle, high);
            pending[count + 1] = (low, middle);
            count += 2;
            continue;
        }
        let mut points = Points::default();
        panel.critical_points(-1.0, 1.0, error, CRITICAL_DEPTH, &mut points);
        points.push(1.0);
        if points.overflowed {
            return Ok(None);
        }
        let mut last = -1.0;
        for &local in points.as_slice() {
            let mut theta = panel.theta(local);
            let at_end = theta >= 1.0;
            let mut value = if at_end { end } else { panel.at(local) };
            if at_end && value.abs() <= hidden_end {
                let middle = 0.5 * (last + local);
                value = panel.at(middle);
                if value.abs() <= error {
                    continue;
                }
                theta = panel.theta(middle);
            }
            last = local;
            if !at_end && value.abs() <= error {
                value = quotient.truth(theta)?;
                if local < 1.0 {
                    on_touch(Touch { theta, margin: value * power(theta, order) });
                }
                if value.abs() * power(theta, order) <= accuracy.noise + hidden {
                    // It has no sign. The points that follow tell whether the guard goes through.
                    continue;
                }
            }
            if value.is_nan() {
                return Ok(None);
            }
            let visited = visit(quotient, (theta, value));
            if visited.is_break() {
                return Ok(Some(visited));
            }
        }
    }
    Ok(Some(ControlFlow::Continue(())))
}

/// The root of the quotient along the dense output between two points of opposite sign, by the
/// Illinois rule.
fn panel_root(quotient: &mut Quotient<'_>, low: (f64, f64), high: (f64, f64)) -> f64 {
    let (mut a, mut b) = (low, high);
    let mut theta = b.0;
    for _ in 0..40 {
        let next = a.0 + (b.0 - a.0) * (a.1 / (a.1 - b.1));
        if !next.is_finite() || (next - theta).abs() <= 1e-9 * next {
            break;
        }
        theta = next;
        let value = quotient.at(theta).0;
        if value < 0.0 {
            b = (theta, value);
            a.1 *= 0.5;
        } else {
            a = (theta, value);
            b.1 *= 0.5;
        }
    }
    theta.clamp(low.0, high.0)
}
