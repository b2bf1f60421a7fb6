//! Chebyshev expansions of degree 8 on [−1, 1].

/// The number of terms of an expansion.
pub(crate) const TERMS: usize = 9;

/// cos(10° m) for m = 0 … 9. The nodes of degree 8 are at 10°, 30°, …, 170°. None of them is an end
/// of the interval, where a quotient may have no value.
pub(crate) const COSINES: [f64; 10] = [
    1.0,
    0.984807753012208,
    0.9396926207859083,
    0.8660254037844386,
    0.766044443118978,
    0.6427876096865393,
    0.5,
    0.3420201433256688,
    0.1736481776669304,
    0.0,
];

fn cosine(tens_of_degrees: usize) -> f64 {
    match tens_of_degrees % 36 {
        m @ 0..=9 => COSINES[m],
        m @ 10..=18 => -COSINES[18 - m],
        m @ 19..=27 => -COSINES[m - 18],
        m => COSINES[36 - m],
    }
}

/// The Chebyshev coefficients of the interpolant of degree 8 on [−1, 1].
pub(crate) fn expand(mut function: impl FnMut(f64) -> f64) -> [f64; TERMS] {
    let values: [f64; TERMS] = std::array::from_fn(|j| function(cosine(2 * j + 1)));
    std::array::from_fn(|k| {
        let sum: f64 =
            values.iter().enumerate().map(|(j, value)| value * cosine(k * (2 * j + 1))).sum();
        sum * if k == 0 { 1.0 / 9.0 } else { 2.0 / 9.0 }
    })
}

/// The value of an expansion at `t`, by Clenshaw's recurrence.
pub(crate) fn clenshaw(coefficients: &[f64; TERMS], t: f64) -> f64 {
    let (mut b1, mut b2) = (0.0, 0.0);
    for &c in coefficients[1..].iter().rev() {
        (b1, b2) = (c + 2.0 * t * b1 - b2, b1);
    }
    coefficients[0] + t * b1 - b2
}

/// The expansion of the derivative.
pub(crate) fn differentiate(coefficients: &[f64; TERMS]) -> [f64; TERMS] {
    let mut derivative = [0.0; TERMS];
    for k in (0..TERMS - 1).rev() {
        let beyond = if k + 2 < TERMS { derivative[k + 2] } else { 0.0 };
        derivative[k] = beyond + 2.0 * (k + 1) as f64 * coefficients[k + 1];
    }
    derivative[0] *= 0.5;
    derivative
}

/// Whether the constant term is larger than all others together, so that there is no root.
pub(crate) fn dominated(coefficients: &[f64; TERMS]) -> bool {
    coefficients[0].abs() > coefficients[1..].iter().map(|c| c.abs()).sum()
}

/// The root of a monotone expansion whose signs at ±1 differ, found by bisection.
pub(crate) fn monotone_root(coefficients: &[f64; TERMS]) -> f64 {
    let (mut low, mut high) = (-1.0, 1.0);
    let negative_left = clenshaw(coefficients, low) < 0.0;
    for _ in 0..45 {
        let middle = 0.5 * (low + high);
        if (clenshaw(coefficients, middle) < 0.0) == negative_left {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}
