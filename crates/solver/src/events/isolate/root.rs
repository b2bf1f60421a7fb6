//! The root of a curve between two places with opposite signs.

/// The root between `low`, where the curve is ≥ 0, and `high`, where it is < 0, by the rule of
/// Illinois. Where that is slow, as for steep curves, the interval is halved.
pub(crate) fn root(mut curve: impl FnMut(f64) -> f64, low: (f64, f64), high: (f64, f64)) -> f64 {
    let (mut a, mut b) = (low, high);
    let mut theta = b.0;
    for round in 1..200 {
        let secant = a.0 + (b.0 - a.0) * (a.1 / (a.1 - b.1));
        let inside = secant > a.0 && secant < b.0;
        // A dozen rounds are enough unless the curve is steep.
        let next =
            if inside && (round < 12 || round % 2 != 0) { secant } else { 0.5 * (a.0 + b.0) };
        if !next.is_finite() || (next - theta).abs() <= 1e-9 * next || next <= a.0 || next >= b.0 {
            break;
        }
        theta = next;
        let value = curve(theta);
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

/// The places, in widths, that are tried beside a place without a value.
const BESIDE: [f64; 8] = [1.0, -1.0, 16.0, -16.0, 256.0, -256.0, FARTHEST, -FARTHEST];
const FARTHEST: f64 = 4096.0;

/// The zero between `low`, where the curve is ≥ 0, and `high`, where it is < 0, between two places
/// that are at most `width` apart, each with its value.
pub(crate) fn narrow(
    mut curve: impl FnMut(f64) -> f64,
    low: (f64, f64),
    high: (f64, f64),
    width: f64,
) -> ((f64, f64), (f64, f64)) {
    let (mut a, mut b) = (low, high);
    // The values with which the rule of Illinois computes.
    let (mut weight_a, mut weight_b) = (a.1, b.1);
    for round in 0..400 {
        if b.0 - a.0 <= width {
            break;
        }
        let secant = a.0 + (b.0 - a.0) * (weight_a / (weight_a - weight_b));
        // The secant converges from one side. A little more than its step passes the zero.
        let middle = 0.5 * (a.0 + b.0);
        let next = match round % 3 {
            0 => secant,
            1 => secant + 0.25 * width * (middle - secant).signum(),
            _ => middle,
        };
        let next = if next > a.0 && next < b.0 { next } else { middle };
        if next <= a.0 || next >= b.0 {
            break;
        }
        let (mut next, mut value) = (next, curve(next));
        if value.is_nan() {
            // The value beside it counts. Time may be resolved less finely than `width`.
            let places = BESIDE.map(|widths| next + widths * width).into_iter();
            let inside = places.filter(|&place| place > a.0 && place < b.0);
            let known =
                inside.map(|place| (place, curve(place))).find(|(_, value)| !value.is_nan());
            if known.is_none() && b.0 - a.0 <= FARTHEST * width {
                break;
            }
            (next, value) = known.unwrap_or((next, value));
        }
        if value < 0.0 {
            b = (next, value);
            (weight_a, weight_b) = (0.5 * weight_a, value);
        } else {
            a = (next, value);
            (weight_a, weight_b) = (value, 0.5 * weight_b);
        }
    }
    (a, b)
}
