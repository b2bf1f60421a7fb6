//! Isolation: it decides whether a guard crosses zero on a step.
//!
//! Along the dense output a guard is a function q of the step fraction θ. If its system is
//! readable, `enclosed` bounds it and its derivatives. Otherwise it is *sampled*: expanded in
//! Chebyshev polynomials on panels that are narrow enough for degree 8. Bounds on the coefficients
//! and subdivision isolate its critical points. A stretch that is flat to an eighth of the error
//! counts as one critical point. Critical points and the ends of panels cut the step into pieces on
//! which q is monotone. The first piece that starts at or above 0 and ends below 0 contains the
//! first crossing. A panel that stays unresolved however narrow it is has a kink, a jump or a pole.
//!
//! If a value is smaller than the error of the dense output, a step of the method to that point
//! gives its sign. This error is four times the effect of the last term of the dense output on the
//! guard, the effect of the rounding of state and time, and 64 roundings of the guard's value.
//!
//! A guard may round more coarsely than its value, the state and the time show: 0.5 − 0.5 has the
//! rounding of 0.5. Where no panel is narrow enough for degree 8, the scatter is measured from
//! sixth differences (Moré and Wild 2011), in three places and with two spacings, so that neither a
//! jump nor a narrow smooth dip counts as noise. A sign counts if the value is at least 32 standard
//! deviations from 0.
//!
//! Few steps come here. A curve is therefore dispatched at run time, and all this is compiled once,
//! not once for each system and method.

mod chebyshev;
mod curve;
mod enclosed;
mod notice;
mod panel;
mod root;

use std::ops::ControlFlow;

use crate::error::RunError;
use crate::events::isolate::curve::{Accuracy, NARROWEST, Quotient, power};
use crate::events::isolate::panel::{Panel, Points};

pub(crate) use curve::{Curve, noise};
pub(crate) use enclosed::{Enclosed, first_enclosed_crossing, last_enclosed_sign, rests};
pub(crate) use notice::{Notice, Touch};
pub(crate) use root::narrow;
use root::root;

/// Panels are halved at most this often in the search for critical points. A stretch that is flat
/// to within the error ends the search earlier.
const CRITICAL_DEPTH: u32 = 45;
/// Panels that do not resolve the guard are halved at most this often.
const DEPTH: usize = 48;
/// The panels that may be examined before a step counts as too coarse.
const LIMIT: usize = 20_000;
/// Values that are larger than those around them by this factor make a pole.
const GROWS: f64 = 4.0;
/// The number of widths from a pole where it is compared with its surroundings.
const AROUND: f64 = 64.0;
/// A value that is this part of those on both sides of it is near a zero.
const VANISHES: f64 = 1e-3;
/// If this part of a step is no wider than a point, time is resolved poorly on the step.
const SHORT: f64 = 0.01;
/// The least part of the step that may be a plateau. On a shorter part, differences of a guard may
/// be zero by rounding.
const PLATEAU: f64 = 1e-6;
/// The part of the step on which a quotient is expanded to find its value at the start.
const OPENING: f64 = 0.25;
/// A value has a sign if it exceeds the effect of rounding of the state by this factor.
const HIDDEN: f64 = 4.0;

/// The step fractions between which a curve crosses from ≥ 0 to < 0, and a guess in between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bracket {
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) guess: f64,
    /// Whether it is zero from `low` on up to the crossing.
    pub(crate) rests: bool,
}

/// Where isolation begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Beginning {
    /// The step fraction.
    pub(crate) theta: f64,
    /// The guard's value there. Only its sign counts.
    pub(crate) value: f64,
    /// The order of a known zero there, 0 if there is none. It is 0 unless `theta` is 0.
    pub(crate) zero_order: u32,
}

/// What isolation finds out about a guard on a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Verdict {
    /// The guard does not cross zero.
    None,
    /// The first crossing of the guard.
    Crossing(Bracket),
    /// The first crossing of the guard, if it is upwards and upward crossings were wanted too.
    Rise(Bracket),
    /// The guard bounds a domain and is negative from the start.
    StartsBelow,
    /// The guard is exactly zero over a part of the step from its start on.
    Flat,
    /// The guard is not resolved on this step, so that a shorter one is needed.
    TooCoarse,
}

/// A guard on a step, normalised so that it fires where it falls.
pub(crate) struct Task {
    pub(crate) beginning: Beginning,
    /// Whether it bounds a domain, so that a negative start counts too.
    pub(crate) domain: bool,
    /// Whether it fires where it rises, too. Only a search by bounds can find both at once.
    pub(crate) both: bool,
    /// The value at the end of the step.
    pub(crate) end: f64,
    /// The narrowest part of the step that is wider than a point.
    pub(crate) resolution: f64,
    /// The widest panel on which the guard may be expanded.
    pub(crate) widest: f64,
}

/// Finds the first crossing of a sampled curve from ≥ 0 to < 0. What it notices before the crossing
/// goes to `notice`.
pub(crate) fn first_crossing(
    curve: &mut dyn Curve,
    task: &Task,
    notice: &mut dyn FnMut(Notice),
) -> Result<Verdict, RunError> {
    let Beginning { theta: first, value: start, zero_order } = task.beginning;
    // A guard that is exactly zero, and was not declared to be, fires if it falls from there.
    let falls_from_zero = zero_order == 0 && start == 0.0 && first == 0.0;
    let zero_order = if falls_from_zero { 1 } else { zero_order };
    let at_start = Verdict::Crossing(Bracket::at(first));
    let mut quotient = Quotient { curve, order: zero_order };
    let mut accuracy = quotient.accuracy();
    if accuracy.dense.is_nan() {
        return Ok(Verdict::TooCoarse);
    }
    if falls_from_zero && is_flat(&mut quotient, accuracy.state.0) {
        return Ok(Verdict::Flat);
    }
    // The last point whose sign is known, and the value there.
    let mut before = Some((first, start));
    if first > 0.0 {
        // Only the sign of the given value counts.
        let size = quotient.at(first).abs().max(f64::MIN_POSITIVE);
        before = Some((first, size.copysign(start)));
    }
    if zero_order > 0 {
        let panel = Panel::new(0.0, OPENING, |theta| quotient.at(theta));
        let opening = panel.at(-1.0);
        if panel.tail() > accuracy.on(&panel, zero_order) {
            accuracy.learn(quotient.noise(0.5 * OPENING, 0.5 * OPENING + NARROWEST), &panel);
        }
        let error = accuracy.on(&panel, zero_order);
        // A zero that was not declared may be of higher order. The opening is only rounding then.
        let shown = !falls_from_zero
            || [0.01, 0.03, 0.1].iter().all(|&theta| quotient.at(theta) * opening > 0.0);
        before = Some((0.0, opening)).filter(|_| shown && opening.abs() > error);
        // A shorter step diminishes the error at the opening, but not the effect of noise and
        // rounding at the start.
        let lasts = 2.0 * accuracy.lasting(&panel, zero_order) >= error;
        // A zero that was not declared may be of higher order. On a short step the first sign that
        // shows counts then.
        let may_be_higher = falls_from_zero && task.resolution > SHORT;
        if before.is_none() && !lasts && !may_be_higher {
            return Ok(Verdict::TooCoarse);
        }
    }
    if before.is_some_and(|(_, value)| value < 0.0) && (task.domain || falls_from_zero) {
        return Ok(if task.domain { Verdict::StartsBelow } else { at_start });
    }
    let hidden = HIDDEN * accuracy.state.0 + accuracy.noise;
    let walked =
        walk(&mut quotient, &mut accuracy, task, notice, |quotient, (theta, value), notice| {
            match before {
                Some((low, at_low)) if at_low >= 0.0 && value < 0.0 => {
                    let (a, b) = ((low, at_low), (theta, value));
                    let guess = root(|theta| quotient.at(theta), a, b);
                    if let Some(place) = pole(quotient, a, b, guess, task.resolution) {
                        notice(Notice::Pole(place));
                        // A domain ends at a pole too.
                        if !task.domain {
                            before = Some((theta, value));
                            return ControlFlow::Continue(());
                        }
                    }
                    return ControlFlow::Break(Verdict::Crossing(Bracket {
                        low,
                        high: theta,
                        guess,
                        rests: false,
                    }));
                }
                // The first certain sign is the sign with which the curve leaves its zero.
                None if value < 0.0 => match hump(quotient, (theta, value), hidden) {
                    Some(bracket) => return ControlFlow::Break(Verdict::Crossing(bracket)),
                    None if task.domain => return ControlFlow::Break(Verdict::StartsBelow),
                    None if falls_from_zero => return ControlFlow::Break(at_start),
                    // Rounding hides how far it rises.
                    None if quotient.curve.start_rate() > 0.0 => {
                        return ControlFlow::Break(at_start);
                    }
                    None => before = Some((theta, value)),
                },
                _ => before = Some((theta, value)),
            }
            ControlFlow::Continue(())
        })?;
    Ok(match walked {
        Some(ControlFlow::Break(verdict)) => verdict,
        Some(ControlFlow::Continue(())) => Verdict::None,
        None => Verdict::TooCoarse,
    })
}

/// The crossing of a curve that rises from its zero at the start, so slightly that the sign of the
/// quotient does not show there, and is negative at `end`. The curve is looked at closer and closer
/// to the start, as long as it is larger than what is `hidden` by rounding.
fn hump(quotient: &mut Quotient<'_>, end: (f64, f64), hidden: f64) -> Option<Bracket> {
    let (mut above, mut below) = (None, end);
    let mut theta = 0.5 * end.0;
    while theta > f64::EPSILON {
        let value = quotient.at(theta);
        if (value * power(theta, quotient.order)).abs() <= hidden || !value.is_finite() {
            break;
        }
        if value < 0.0 {
            (above, below) = (None, (theta, value));
        } else if above.is_none() {
            above = Some((theta, value));
        }
        theta *= 0.5;
    }
    let (low, high) = (above?, below);
    let guess = root(|theta| quotient.at(theta), low, high);
    Some(Bracket { low: low.0, high: high.0, guess, rests: false })
}

/// Whether a curve is exactly zero from the start of the step on, for longer than rounding of the
/// state explains, which changes it by `rounding`.
fn is_flat(quotient: &mut Quotient<'_>, rounding: f64) -> bool {
    let mut places = (0..=6).rev().map(|k| 0.5_f64.powi(k));
    let Some(theta) = places.find(|&theta| quotient.curve.dense(theta) != 0.0) else {
        return false;
    };
    let (mut zero, mut other) = (0.0, theta);
    for _ in 0..DEPTH {
        let middle = 0.5 * (zero + other);
        if quotient.curve.dense(middle) == 0.0 {
            zero = middle;
        } else {
            other = middle;
        }
    }
    zero > PLATEAU && quotient.curve.dense(theta).abs() * (zero / theta) > 16.0 * rounding
}

/// The place of a pole at which a curve changes its sign between two places, near `guess`. The
/// result is `None` if it is not a pole.
///
/// The places are first brought together as closely as time is resolved. The values there are
/// compared with the values at the places, or with values around them if the places are close to
/// the pole already. Without the first step, a guard that goes up and down often would pass for a
/// pole where the places around are near its other zeros.
fn pole(
    quotient: &mut Quotient<'_>,
    low: (f64, f64),
    high: (f64, f64),
    guess: f64,
    resolution: f64,
) -> Option<f64> {
    let (least, size) = (low.1.min(-high.1), low.1.max(-high.1));
    let width = high.0 - low.0;
    let close = width < NARROWEST;
    // No quicker test shows that it is a zero.
    let enough = if close { VANISHES * least } else { 2.0 * size };
    if quotient.at(guess).abs() <= enough {
        return None;
    }
    let mut at = |theta: f64| quotient.at(theta.clamp(f64::MIN_POSITIVE, 1.0));
    let (a, b) = narrow(&mut at, low, high, resolution);
    let near = a.1.max(-b.1);
    let mut around = || at(low.0 - AROUND * width).abs().max(at(high.0 + AROUND * width).abs());
    let grows = near > GROWS * size || close && near > GROWS * around();
    grows.then_some(0.5 * (a.0 + b.0))
}

/// The last sign that a curve shows on a step, or 0 if it shows none. The result is `None` if a
/// shorter step is needed.
pub(crate) fn last_sign(curve: &mut dyn Curve, resolution: f64) -> Result<Option<f64>, RunError> {
    let mut quotient = Quotient { curve, order: 0 };
    let mut accuracy = quotient.accuracy();
    if accuracy.dense.is_nan() {
        return Ok(None);
    }
    let mut last = 0.0;
    let beginning = Beginning { theta: 0.0, value: 0.0, zero_order: 0 };
    let (domain, both) = (false, false);
    let task = Task { beginning, domain, both, end: 0.0, resolution, widest: 1.0 };
    let walked = walk(&mut quotient, &mut accuracy, &task, &mut |_| {}, |_, (_, value), _| {
        last = value.signum();
        ControlFlow::<()>::Continue(())
    })?;
    Ok(walked.map(|_| last))
}

impl Verdict {
    /// A crossing to values with the sign of `value`.
    fn crossing(value: f64, bracket: Bracket) -> Self {
        if value < 0.0 { Self::Crossing(bracket) } else { Self::Rise(bracket) }
    }
}

impl Bracket {
    /// A crossing exactly at `theta`.
    pub(crate) const fn at(theta: f64) -> Self {
        Self { low: theta, high: theta, guess: theta, rests: false }
    }

    /// A crossing of a curve that rests on zero at `low`, and has crossed it at `high`.
    fn behind_rest(low: f64, high: f64) -> Self {
        Self { low, high, guess: 0.5 * (low + high), rests: true }
    }
}

/// What is done at a point of a curve, with its value there.
trait Visit<B>: FnMut(&mut Quotient<'_>, (f64, f64), &mut dyn FnMut(Notice)) -> ControlFlow<B> {}

impl<B, F> Visit<B> for F where
    F: FnMut(&mut Quotient<'_>, (f64, f64), &mut dyn FnMut(Notice)) -> ControlFlow<B>
{
}

/// Visits points between which a quotient is monotone, from left to right, with the values there.
///
/// Points are left out if the guard's value there is within its noise, so that it has no sign. If
/// the value at the end of the step is zero, the middle of the last piece is visited instead. The
/// result is `None` if the step is too coarse.
fn walk<B>(
    quotient: &mut Quotient<'_>,
    accuracy: &mut Accuracy,
    task: &Task,
    notice: &mut dyn FnMut(Notice),
    mut visit: impl Visit<B>,
) -> Result<Option<ControlFlow<B>>, RunError> {
    let order = quotient.order;
    let hidden = if order > 0 { accuracy.state.0 } else { 0.0 };
    let mut pending = [(0.0, 0.0); DEPTH + 2];
    pending[0] = (task.beginning.theta, 1.0);
    let mut count = 1;
    let mut examined = 0;
    // The sign that was seen last.
    let mut side = if order == 0 { task.beginning.value } else { 0.0 };
    while count > 0 {
        count -= 1;
        examined += 1;
        let (low, high) = pending[count];
        let panel = Panel::new(low, high, |theta| quotient.at(theta));
        let mut error = accuracy.on(&panel, order);
        if panel.tail().is_nan() || examined > LIMIT {
            return Ok(None);
        }
        let wide = high - low > task.widest;
        let narrow = high - low < 1.5 * NARROWEST;
        if panel.tail() > error && narrow {
            // Structure that even a narrow panel does not resolve may be noise. A shorter step
            // would not diminish that.
            accuracy.learn(quotient.noise(low, high), &panel);
            error = accuracy.on(&panel, order);
        }
        let unresolved = panel.tail() > error && !(narrow && panel.is_far_from_zero());
        if unresolved || wide {
            if high - low > task.resolution && count + 2 <= DEPTH {
                let middle = 0.5 * (low + high);
                pending[count] = (middle, high);
                pending[count + 1] = (low, middle);
                count += 2;
                continue;
            }
            let visited = at_break(quotient, task, (low, high), notice, &mut visit);
            match visited {
                Some(ControlFlow::Continue(())) => continue,
                visited => return Ok(visited),
            }
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
            let mut value = if at_end { task.end } else { panel.at(local) };
            if at_end && value == 0.0 {
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
                    notice(Notice::Touch(Touch { theta, margin: value * power(theta, order) }));
                }
                if value.abs() * power(theta, order) <= accuracy.noise_on(&panel) + hidden {
                    // The value has no sign. The points that follow show whether the guard goes
                    // through.
                    continue;
                }
            }
            if value * side <= 0.0 && !at_end && quotient.at(theta) * value <= 0.0 {
                // The expansion overshoots behind a kink that it does not resolve.
                value = quotient.truth(theta)?;
                if value == 0.0 {
                    continue;
                }
            }
            if value.is_nan() {
                return Ok(None);
            }
            side = value;
            let visited = visit(quotient, (theta, value), notice);
            if visited.is_break() {
                return Ok(Some(visited));
            }
        }
    }
    Ok(Some(ControlFlow::Continue(())))
}

/// Visits both ends of a panel that is as narrow as a point and still unresolved: a kink, a jump or
/// a pole. The result is `None` if the curve has no value there.
fn at_break<B>(
    quotient: &mut Quotient<'_>,
    task: &Task,
    (low, high): (f64, f64),
    notice: &mut dyn FnMut(Notice),
    visit: &mut impl Visit<B>,
) -> Option<ControlFlow<B>> {
    let before = quotient.at(low.max(f64::MIN_POSITIVE));
    let after = if high >= 1.0 { task.end } else { quotient.at(high) };
    if before.is_nan() || after.is_nan() {
        return None;
    }
    for point in [(low, before), (high, after)] {
        if point.1 != 0.0 {
            let visited = visit(quotient, point, notice);
            if visited.is_break() {
                return Some(visited);
            }
        }
    }
    Some(ControlFlow::Continue(()))
}
