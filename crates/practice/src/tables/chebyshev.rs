//! Polynomials in one and two variables on [0, 1] that interpolate at Chebyshev's places.
//!
//! They are kept in powers of x from −1 to 1, which are quickest to sum. Sums have a fixed order
//! and no product is fused with a sum, so that a table has the same bits in Rust and in C.

use std::f64::consts::PI;

use wide::f64x4;

/// The number of coefficients along the first axis, at most.
pub const ALONG: usize = 8;
/// The number of coefficients across it.
pub const ACROSS: usize = 12;

/// A number rounded to `places` decimal places. Files are shorter with such numbers.
pub fn rounded(value: f64, places: i32) -> f64 {
    let scale = 10_f64.powi(places);
    // 0.0 takes the sign from a zero. Large scales leave no place for another digit anyway.
    if places > 15 { value } else { (value * scale).round() / scale + 0.0 }
}

/// The value of a polynomial at `place` in [0, 1].
#[inline(always)]
pub fn value(c: &[f64; ALONG], place: f64) -> f64 {
    let x = 2.0 * place - 1.0;
    let x2 = x * x;
    let low = (c[0] + c[1] * x) + (c[2] + c[3] * x) * x2;
    let high = (c[4] + c[5] * x) + (c[6] + c[7] * x) * x2;
    low + high * (x2 * x2)
}

/// The value of a polynomial in two variables. Each of its `rows` has the twelve coefficients
/// across for one power along the first axis.
#[inline(always)]
pub fn double_value(rows: &[[f64; ACROSS]], along: f64, across: f64) -> f64 {
    let x = 2.0 * along - 1.0;
    let y = 2.0 * across - 1.0;
    let (xs, y2) = (f64x4::splat(x), y * y);
    let y4 = f64x4::splat(y2 * y2);
    // Four at once have the bits of one after the other.
    let mut sums = [f64x4::ZERO; ACROSS / 4];
    for row in rows.iter().rev() {
        for (sums, c) in sums.iter_mut().zip(row.as_chunks::<4>().0) {
            *sums = *sums * xs + f64x4::from(*c);
        }
    }
    let [low, middle, high] = sums;
    let four = ((high * y4 + middle) * y4 + low).to_array();
    (four[0] + four[2] * y2) + (four[1] + four[3] * y2) * y
}

/// The places of an interpolation: the zeros of the first term that it leaves out, on [0, 1].
pub fn nodes<const N: usize>() -> [f64; N] {
    std::array::from_fn(|k| 0.5 - 0.5 * (PI * (k as f64 + 0.5) / N as f64).cos())
}

/// The extrema of the first term that an interpolation of `order` places leaves out, on [0, 1],
/// both ends included: there its error is largest.
pub fn extrema(order: usize) -> impl Iterator<Item = f64> {
    (0..=order).map(move |k| 0.5 - 0.5 * (PI * k as f64 / order as f64).cos())
}

/// The coefficients in Chebyshev's basis of the polynomial with `values` at the [`nodes`].
pub fn coefficients<const N: usize>(values: &[f64; N]) -> [f64; N] {
    let angle = |i: usize, k: usize| PI * (i * (2 * k + 1)) as f64 / (2 * N) as f64;
    // T at node k of [0, 1] is the cosine of the angle from the other end.
    let sign = |i: usize| if i.is_multiple_of(2) { 1.0 } else { -1.0 };
    std::array::from_fn(|i| {
        let products = values.iter().enumerate().map(|(k, value)| value * angle(i, k).cos());
        sign(i) * products.sum::<f64>() * if i == 0 { 1.0 } else { 2.0 } / N as f64
    })
}

/// The coefficients in powers of a polynomial in Chebyshev's basis.
pub fn powers<const N: usize>(c: &[f64; N]) -> [f64; N] {
    // T of two successive orders: each next one is 2xT − T of the one before.
    let (mut before, mut now) = ([0.0; N], [0.0; N]);
    let mut sums = [0.0; N];
    now[0] = 1.0;
    for (order, c) in c.iter().enumerate() {
        for (sum, t) in sums.iter_mut().zip(now) {
            *sum += c * t;
        }
        let factor = if order == 0 { 1.0 } else { 2.0 };
        let next = std::array::from_fn(|i| {
            let raised = if i == 0 { 0.0 } else { factor * now[i - 1] };
            raised - before[i]
        });
        (before, now) = (now, next);
    }
    sums
}

/// The coefficients in Chebyshev's basis of the polynomial in two variables with `values[k][l]` at
/// the k-th node along the first axis and the l-th across.
pub fn double_coefficients(values: &[[f64; ACROSS]; ALONG]) -> [[f64; ACROSS]; ALONG] {
    columns(&values.each_ref().map(coefficients), coefficients)
}

/// The rows of coefficients in powers of a polynomial in Chebyshev's basis. Only the first `rows`
/// are not 0.
pub fn double_powers(c: &[[f64; ACROSS]; ALONG], rows: usize) -> Vec<[f64; ACROSS]> {
    let kept = std::array::from_fn(|i| if i < rows { powers(&c[i]) } else { [0.0; ACROSS] });
    columns(&kept, powers)[..rows].to_vec()
}

/// Changes each column.
fn columns(
    rows: &[[f64; ACROSS]; ALONG],
    change: impl Fn(&[f64; ALONG]) -> [f64; ALONG],
) -> [[f64; ACROSS]; ALONG] {
    let mut all = [[0.0; ACROSS]; ALONG];
    for j in 0..ACROSS {
        let column = change(&rows.map(|row| row[j]));
        for (row, value) in all.iter_mut().zip(column) {
            row[j] = value;
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_reproduced() {
        let f = |x: f64, y: f64| (x - 0.3).powi(7) + 2.0 * x * y.powi(11) - (y - 0.5).powi(3);
        let values = nodes::<ALONG>().map(|x| nodes::<ACROSS>().map(|y| f(x, y)));
        let all = double_powers(&double_coefficients(&values), ALONG);
        let line = powers(&coefficients(&nodes().map(|x| f(x, 0.2))));
        for i in 0..=20 {
            let (x, y) = (f64::from(i) / 20.0, f64::from((7 * i) % 20) / 20.0);
            assert!((double_value(&all, x, y) - f(x, y)).abs() < 2e-14, "{x} {y}");
            assert!((value(&line, x) - f(x, 0.2)).abs() < 1e-14, "{x}");
        }
    }

    #[test]
    fn the_last_coefficients_tell_what_is_left_out() {
        let c = coefficients::<ACROSS>(&nodes().map(|y: f64| (8.0 * y - 4.0).cos()));
        let rest: f64 = extrema(ACROSS)
            .map(|y| {
                let x = 2.0 * y - 1.0;
                let sum = powers(&c).iter().rev().fold(0.0, |sum, c| sum * x + c);
                (sum - (4.0 * x).cos()).abs()
            })
            .fold(0.0, f64::max);
        // The first term that is left out is 2 J₁₂(4).
        assert!((rest / 1.25e-5 - 1.0).abs() < 0.1, "{rest:e}");
    }
}
