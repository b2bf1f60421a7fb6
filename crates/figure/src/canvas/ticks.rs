//! Ticks of axes: round values with their labels.

use stickslip_model::text::{minus, number};

/// A round value on an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// The value.
    pub value: f64,
    /// The label, as [markup](super::markup).
    pub label: String,
}

/// About `count` ticks of a linear axis. They are 1, 2 or 5 times a power of ten apart, and their
/// labels are in units of 10^[`exponent`]. An axis whose range is not finite and rising has none.
pub fn linear(range: (f64, f64), count: f64) -> Vec<Tick> {
    if !rises(range) {
        return Vec::new();
    }
    // NaN counts as 1.
    let count = if count > 1.0 { count.min(1000.0) } else { 1.0 };
    let finest = (range.1 - range.0) / unit(range) / count;
    let power = finest.log10().floor();
    let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * 10_f64.powf(power));
    let step = steps.into_iter().find(|&step| step >= finest * (1.0 - 1e-9)).unwrap_or(finest);
    multiples(range, step)
}

/// The ticks of a linear axis at all multiples of `step`, with labels in units of 10^[`exponent`].
/// There are none if the range is not finite and rising, or would have more than a thousand.
pub fn every(step: f64, range: (f64, f64)) -> Vec<Tick> {
    // Written so that NaN has none.
    let few = step > 0.0 && (range.1 - range.0) / step <= 1000.0;
    if !(rises(range) && few) {
        return Vec::new();
    }
    multiples(range, step / unit(range))
}

/// The ticks of a linear axis at all multiples of `step`, which is in units of 10^[`exponent`].
fn multiples(range: (f64, f64), step: f64) -> Vec<Tick> {
    let unit = unit(range);
    let (low, high) = (range.0 / unit, range.1 / unit);
    let decimals = decimals(step);
    #[allow(clippy::cast_possible_truncation)]
    let indices = (low / step - 1e-9).ceil() as i64..=(high / step + 1e-9).floor() as i64;
    let label = |value: f64| {
        if value == 0.0 { "0".to_owned() } else { minus(&format!("{value:.decimals$}")) }
    };
    let values = indices.map(|index| index as f64 * step);
    values.map(|value| Tick { value: value * unit, label: label(value) }).collect()
}

/// Digits after the point that multiples of `step` need.
fn decimals(step: f64) -> usize {
    let whole = |digits: &i32| {
        let shifted = step * 10_f64.powi(*digits);
        (shifted - shifted.round()).abs() <= 1e-6 * shifted
    };
    (0..17).find(whole).and_then(|digits| usize::try_from(digits).ok()).unwrap_or(17)
}

/// At most about `count` ticks of a logarithmic axis, all values above 0, at 1, 2 and 5 times
/// powers of ten or at powers of ten alone.
///
/// All labels of an axis are written alike: as decimals if all values are from 10^−3 to 10^4,
/// otherwise as powers of ten. An axis whose range is not finite, rising and above 0 has no ticks.
pub fn logarithmic(range: (f64, f64), count: f64) -> Vec<Tick> {
    if !(rises(range) && range.0 > 0.0) {
        return Vec::new();
    }
    let decades = range.1.log10() - range.0.log10();
    // Values 1, 2 and 5 times a power of ten lie closer together than three ticks of a decade that
    // are evenly spread, and powers are wider than decimals.
    let most_decades = if are_plain(&decade_values(range, &[1.0, 2.0, 5.0], 1)) {
        count / 3.0
    } else {
        count / 4.5
    };
    let (factors, apart): (&[f64], f64) = if decades <= most_decades {
        (&[1.0, 2.0, 5.0], 1.0)
    } else {
        (&[1.0], (decades / count.max(1.0)).ceil().max(1.0))
    };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let values = decade_values(range, factors, apart as usize);
    let plain = are_plain(&values);
    let label = |DecadeValue { factor, power, value }| {
        let power_of_ten = minus(&format!("10^{{{power}}}"));
        let label = match (plain, factor == 1.0) {
            (true, _) => number(value, 3),
            (false, true) => power_of_ten,
            (false, false) => format!("{factor}×{power_of_ten}"),
        };
        Tick { value, label }
    };
    values.into_iter().map(label).collect()
}

/// A factor times a power of ten.
#[derive(Clone, Copy, Debug)]
struct DecadeValue {
    factor: f64,
    power: i32,
    value: f64,
}

/// `factors` times powers of ten in `range`, with exponents that are `apart` from each other.
fn decade_values((low, high): (f64, f64), factors: &[f64], apart: usize) -> Vec<DecadeValue> {
    #[allow(clippy::cast_possible_truncation)]
    let [first, last] = [low, high].map(|end| end.log10().floor() as i32);
    let within = |value: &f64| (low * (1.0 - 1e-9)..=high * (1.0 + 1e-9)).contains(value);
    let powers = (first..=last).step_by(apart);
    let values = powers.flat_map(|power| {
        factors.iter().filter_map(move |&factor| {
            // Parsed, because powers computed are not always the nearest doubles.
            let value = format!("{factor}e{power}").parse().ok()?;
            Some(DecadeValue { factor, power, value })
        })
    });
    values.filter(|decade| within(&decade.value)).collect()
}

/// Whether decimals are short enough for all `values`.
fn are_plain(values: &[DecadeValue]) -> bool {
    values.iter().all(|decade| (1e-3..=1e4).contains(&decade.value))
}

/// Whether an axis with this range shows anything.
pub(crate) fn rises((low, high): (f64, f64)) -> bool {
    low < high && (high - low).is_finite()
}

/// The power of ten that the labels of a linear axis leave out: 0 if the numbers are short enough.
pub fn exponent(range: (f64, f64)) -> i32 {
    if !rises(range) {
        return 0;
    }
    let (low, high) = range;
    #[allow(clippy::cast_possible_truncation)]
    let exponent = low.abs().max(high.abs()).log10().floor() as i32;
    // Below, 10^−exponent is beyond the range of doubles.
    if (-2..5).contains(&exponent) { 0 } else { exponent.max(-300) }
}

fn unit(range: (f64, f64)) -> f64 {
    10_f64.powi(exponent(range))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(ticks: Vec<Tick>) -> Vec<String> {
        ticks.into_iter().map(|tick| tick.label).collect()
    }

    #[test]
    fn linear_ticks_are_round_and_inside() {
        let labels = |range, count| labels(linear(range, count));
        assert_eq!(labels((0.0, 3.218), 8.0), ["0", "0.5", "1.0", "1.5", "2.0", "2.5", "3.0"]);
        assert_eq!(labels((-1.2, 1.2), 6.0), ["−1.0", "−0.5", "0", "0.5", "1.0"]);
        assert_eq!(labels((0.0, 20.0), 5.0), ["0", "5", "10", "15", "20"]);
        assert_eq!(labels((17.9, 18.1), 3.0), ["17.9", "18.0", "18.1"]);
        assert_eq!(labels((0.0, 3e4), 3.0), ["0", "10000", "20000", "30000"]);
    }

    #[test]
    fn ticks_at_given_steps_have_the_digits_that_they_need() {
        let labels = |step, range| labels(every(step, range));
        assert_eq!(labels(0.25, (-0.5, 0.5)), ["−0.50", "−0.25", "0", "0.25", "0.50"]);
        assert_eq!(labels(0.005, (0.0, 0.025)), ["0", "0.005", "0.010", "0.015", "0.020", "0.025"]);
        assert_eq!(labels(5e-6, (0.0, 2e-5)), ["0", "0.5", "1.0", "1.5", "2.0"]);
    }

    #[test]
    fn logarithmic_ticks_are_written_in_one_way() {
        let labels = |range, count| labels(logarithmic(range, count));
        assert_eq!(labels((5.0, 100.0), 20.0), ["5", "10", "20", "50", "100"]);
        assert_eq!(labels((0.05, 1.5), 20.0), ["0.05", "0.1", "0.2", "0.5", "1"]);
        assert_eq!(labels((1e-3, 1e3), 8.0), ["0.001", "0.01", "0.1", "1", "10", "100", "1000"]);
        assert_eq!(labels((1e-3, 1e4), 8.0).last().unwrap(), "10000");
        assert_eq!(
            labels((1.0, 1e5), 6.0),
            ["10^{0}", "10^{1}", "10^{2}", "10^{3}", "10^{4}", "10^{5}"]
        );
        assert_eq!(
            labels((5e-5, 1e-3), 20.0),
            ["5×10^{−5}", "10^{−4}", "2×10^{−4}", "5×10^{−4}", "10^{−3}"]
        );
        assert_eq!(labels((1.0, 1e9), 4.0), ["10^{0}", "10^{3}", "10^{6}", "10^{9}"]);
    }

    #[test]
    fn powers_with_factors_need_more_room_than_decimals() {
        let count = |range| logarithmic(range, 10.0).len();
        assert_eq!(count((1.0, 1e3)), 10);
        assert_eq!(count((1e-6, 1e-3)), 4);
        assert_eq!(count((1e-5, 1e-3)), 7);
    }

    #[test]
    fn very_large_and_small_numbers_leave_out_a_power_of_ten() {
        for (range, count, power, shown) in [
            ((0.0, 2e6), 4.0, 6, ["0", "0.5", "1.0", "1.5", "2.0"].as_slice()),
            ((-3e-5, 3e-5), 3.0, -5, &["−2", "0", "2"]),
            ((0.0, 2e-300), 4.0, -300, &["0", "0.5", "1.0", "1.5", "2.0"]),
            ((0.0, 99999.0), 2.0, 0, &["0", "50000"]),
        ] {
            assert_eq!(exponent(range), power);
            assert_eq!(labels(linear(range, count)), shown);
        }
        assert!((linear((0.0, 2e6), 4.0)[3].value - 1.5e6).abs() < 1e-6);
    }
}
