//! The first look at a guard on a step, by a quintic through six values that the step already has.
//!
//! Most steps are far from any switch, and most crossings are steep. Both are recognised here for
//! the cost of five guard evaluations, one of them at the end of the step; for black boxes that are
//! not declared to be smooth, three more are compared with them. All other cases go to
//! [`crate::events::isolate`].
//!
//! The step knows the state at its ends and at θ = 1/4, 1/3, 3/5 and 6/7. In the 8(5,3) pair the
//! inner states are stages that satisfy the simplifying conditions to order 5; in the 5(4) pair
//! they come from the dense output. The quintic, in Bernstein form, says that the guard is
//! positive, negative, or falls once and steeply, if it does so by more than its error: the last
//! term of the quintic and a part of the term before.
//!
//! The dense output is not used here: with the 8(5,3) pair it costs three more stages. A first look
//! at six states costs about a fifth of a cheap step.

use crate::lists::{List, Shape};

mod tables;

pub(crate) use tables::NODES;

use tables::{
    BEND, COUNT, LATE_CUBIC_TERM, LATE_QUARTIC_TERM, QUARTIC, QUARTIC_TERM, QUINTIC, QUINTIC_TERM,
};

/// The rounding of a Bernstein coefficient, relative to the largest one.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// What the six values of a guard show about its sign on the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Quick {
    /// The guard is positive throughout.
    Positive,
    /// The guard is negative throughout.
    Negative,
    /// The guard falls through zero once, steeply.
    Falls {
        /// The step fraction of the zero, to about a thousandth of itself. The search by steps of
        /// the method begins there.
        theta: f64,
    },
    /// None of the other cases is certain.
    Unclear,
}

/// Looks at a guard with these `values` at [`NODES`].
///
/// The guard starts the step from a zero of order `zero_order`, which is 0 if there is no known
/// zero. The error of the expansion is its whole last term and the part `trust` of the next-to-last
/// term.
#[inline]
pub(crate) fn look(values: &[f64; COUNT], zero_order: u32, trust: f64) -> Quick {
    if zero_order == 0 {
        let error = last_term(values, &QUINTIC_TERM) + trust * last_term(values, &QUARTIC_TERM);
        return classify(&multiply(&QUINTIC, values), error);
    }
    // After division by the known zero, five values and a quartic remain.
    let mut quotient = [0.0; COUNT - 1];
    for i in 1..COUNT {
        quotient[i - 1] = values[i] / power(NODES[i], zero_order);
    }
    let error =
        last_term(&quotient, &LATE_QUARTIC_TERM) + trust * last_term(&quotient, &LATE_CUBIC_TERM);
    classify(&multiply(&QUARTIC, &quotient), error)
}

/// The coefficients of the quintics through `values` at [`NODES`] for powers of the step fraction,
/// and bounds for their errors, in which the part `trust` of the next-to-last term counts. Each
/// value has `N` components, and there is a quintic for each.
pub(crate) fn expand<F: Shape>(
    n: usize,
    values: impl Fn(usize, usize) -> f64,
    trust: f64,
) -> ([F::Of<f64>; COUNT], F::Of<f64>) {
    // A constant would only bring rounding.
    let none = |_| each::<F>(n, |_| 0.0);
    // The rise at the start is zero.
    let mut bernstein: [F::Of<f64>; COUNT] = std::array::from_fn(none);
    let (mut last, mut before) = (none(0), none(0));
    for node in 1..COUNT {
        let rise = each::<F>(n, |i| values(node, i) - values(0, i));
        for (sum, entry) in bernstein.iter_mut().zip(QUINTIC[node]) {
            for i in 0..n {
                sum[i] += entry * rise[i];
            }
        }
        for i in 0..n {
            last[i] += QUINTIC_TERM[node] * rise[i];
            before[i] += QUARTIC_TERM[node] * rise[i];
        }
    }
    let error = each::<F>(n, |i| {
        let largest =
            bernstein.iter().fold(0.0, |most, b| if b[i].abs() > most { b[i].abs() } else { most });
        last[i].abs() + trust * before[i].abs() + ROUNDING * largest
    });
    // The k-th differences of the coefficients, times the binomial coefficients of 5 over k.
    let mut differences = bernstein;
    let mut terms: [F::Of<f64>; COUNT] = std::array::from_fn(none);
    for (k, term) in terms.iter_mut().enumerate() {
        for i in 0..n {
            term[i] = [1.0, 5.0, 10.0, 10.0, 5.0, 1.0][k] * differences[0][i];
        }
        for j in 0..COUNT - 1 - k {
            let (low, high) = differences.split_at_mut(j + 1);
            for i in 0..n {
                low[j][i] = high[0][i] - low[j][i];
            }
        }
    }
    terms[0] = each::<F>(n, |i| values(0, i));
    (terms, error)
}

/// A component for each entry.
#[inline(always)]
pub(crate) fn each<F: Shape>(n: usize, mut value: impl FnMut(usize) -> f64) -> F::Of<f64> {
    // `from_fn` is not always compiled into its caller.
    let mut all = F::Of::<f64>::of(n, 0.0);
    for (i, entry) in all.parts_mut().iter_mut().enumerate() {
        *entry = value(i);
    }
    all
}

/// Step fractions in the gaps between the [`NODES`].
pub(crate) const BETWEEN: [f64; 3] = [0.11, 0.47, 0.74];

/// The weights of the values at the [`NODES`] in the quintic at [`BETWEEN`], by Lagrange's formula.
const WEIGHTS: [[f64; COUNT]; BETWEEN.len()] = {
    let mut weights = [[1.0; COUNT]; BETWEEN.len()];
    let (mut place, mut node, mut other) = (0, 0, 0);
    while place < BETWEEN.len() {
        if node != other {
            weights[place][node] *= (BETWEEN[place] - NODES[other]) / (NODES[node] - NODES[other]);
        }
        other += 1;
        if other == COUNT {
            (other, node) = (0, node + 1);
        }
        if node == COUNT {
            (node, place) = (0, place + 1);
        }
    }
    weights
};

/// The value at one of the places [`BETWEEN`] that the values at the [`NODES`] predict.
#[inline]
pub(crate) fn between(place: usize, values: &[f64; COUNT]) -> f64 {
    values.iter().zip(WEIGHTS[place]).map(|(value, weight)| value * weight).sum()
}

/// A first test that settles most guards: a guard has one sign throughout if it is far from zero
/// compared with the distance of its values from their chord. The result is false if a value is
/// NaN.
#[inline(always)]
pub(crate) fn clearly_away(values: [f64; COUNT]) -> bool {
    let [start, .., end] = values;
    let rise = end - start;
    let mut bend = 0.0;
    for i in 1..5 {
        bend += BEND[i] * (values[i] - (start + NODES[i] * rise)).abs();
    }
    let least = if start.abs() < end.abs() { start.abs() } else { end.abs() };
    least > bend && (start > 0.0) == (end > 0.0)
}

/// About where a guard that falls through zero once on a step does so, if it follows the quintic
/// through its `values` closely. It may start from zero, and rise first.
pub(crate) fn only_root(values: &[f64; COUNT], trust: f64) -> Option<f64> {
    let bernstein = multiply(&QUINTIC, values);
    let error = last_term(values, &QUINTIC_TERM) + trust * last_term(values, &QUARTIC_TERM);
    let largest = values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    (error <= 1e-3 * largest).then(|| falling_root(&bernstein, first_guess(values)))
}

/// Where the search for the zero of a guard begins that falls once through zero.
fn first_guess(values: &[f64; COUNT]) -> f64 {
    let [start, .., end] = *values;
    if start > 0.0 { start / (start - end) } else { 1.0 }
}

#[inline]
fn power(theta: f64, order: u32) -> f64 {
    (0..order).fold(1.0, |product, _| product * theta)
}

/// Decides from the Bernstein coefficients of a polynomial that is within `error` of the guard.
#[inline]
fn classify<const K: usize>(bernstein: &[f64; K], error: f64) -> Quick {
    let (mut least, mut most) = (bernstein[0], bernstein[0]);
    for &b in &bernstein[1..] {
        least = least.min(b);
        most = most.max(b);
    }
    // The coefficients are combinations of the values with weights up to about 20.
    let error = error + ROUNDING * most.max(-least);
    // These comparisons are false for NaN, which spreads to the coefficients and the error.
    if least > error {
        return Quick::Positive;
    }
    if most < -error {
        return Quick::Negative;
    }
    // A term of degree K and of size `error` has a slope of at most 2K² times `error` (Markov).
    let slope_error = 2.0 * (K * K) as f64 * error;
    let falls =
        bernstein.windows(2).all(|pair| (pair[1] - pair[0]) * (K as f64 - 1.0) < -slope_error);
    if falls && bernstein[0] > error && bernstein[K - 1] < -error {
        let chord = bernstein[0] / (bernstein[0] - bernstein[K - 1]);
        return Quick::Falls { theta: falling_root(bernstein, chord) };
    }
    Quick::Unclear
}

/// The root of a polynomial that falls through zero once. Newton's method from `theta` on, kept
/// inside a bracket, goes on until the root moves by less than a thousandth of itself.
fn falling_root<const K: usize>(bernstein: &[f64; K], mut theta: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..30 {
        let (value, derivative) = de_casteljau(bernstein, theta);
        if value > 0.0 {
            low = theta;
        } else {
            high = theta;
        }
        let next = theta - value / derivative;
        let next = if next > low && next < high { next } else { 0.5 * (low + high) };
        let moved = (next - theta).abs();
        theta = next;
        if moved <= 1e-3 * theta {
            break;
        }
    }
    theta
}

/// The value and the derivative of a polynomial at `theta`.
fn de_casteljau<const K: usize>(bernstein: &[f64; K], theta: f64) -> (f64, f64) {
    let mut b = *bernstein;
    for last in (2..K).rev() {
        for i in 0..last {
            b[i] += theta * (b[i + 1] - b[i]);
        }
    }
    let degree = (K - 1) as f64;
    (b[0] + theta * (b[1] - b[0]), degree * (b[1] - b[0]))
}

#[inline]
fn multiply<const K: usize>(matrix: &[[f64; K]; K], values: &[f64; K]) -> [f64; K] {
    // This goes column by column, so that the products run over neighbours in memory.
    let mut product = [0.0; K];
    for (column, value) in matrix.iter().zip(values) {
        for (sum, entry) in product.iter_mut().zip(column) {
            *sum += entry * value;
        }
    }
    product
}

#[inline]
fn last_term<const K: usize>(values: &[f64; K], weights: &[f64; K]) -> f64 {
    values.iter().zip(weights).map(|(value, weight)| value * weight).sum::<f64>().abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampled(guard: impl Fn(f64) -> f64) -> [f64; COUNT] {
        NODES.map(guard)
    }

    #[test]
    fn a_polynomial_of_degree_five_is_recovered() {
        let guard = |t: f64| 1.0 + t * (2.0 - t * (3.0 - t * (4.0 + t * (5.0 - 6.0 * t))));
        let coefficients = multiply(&QUINTIC, &sampled(guard));
        for theta in [0.0, 0.1, 0.47, 0.9, 1.0] {
            assert!((de_casteljau(&coefficients, theta).0 - guard(theta)).abs() < 1e-14);
        }
    }

    #[test]
    fn a_steep_fall_is_located() {
        let values = sampled(|t: f64| (-(0.1 * t)).exp() - 0.95);
        let Quick::Falls { theta } = look(&values, 0, 0.1) else { panic!("not found") };
        let root = -10.0 * 0.95_f64.ln();
        assert!((theta - root).abs() < 1e-8);
    }

    #[test]
    fn a_double_zero_at_the_start_is_not_a_crossing() {
        let values = sampled(|t: f64| t * t * (1.0 + 0.1 * t).ln_1p());
        assert_eq!(look(&values, 2, 0.1), Quick::Positive);
        let values = sampled(|t: f64| -t * t * (1.0 + 0.1 * t));
        assert_eq!(look(&values, 2, 0.1), Quick::Negative);
    }

    #[test]
    fn a_close_pair_is_left_to_isolation() {
        let values = sampled(|t: f64| (t - 0.5) * (t - 0.501));
        assert_eq!(look(&values, 0, 0.1), Quick::Unclear);
    }

    #[test]
    fn not_a_number_is_never_clear() {
        let mut values = sampled(|_| 1.0);
        values[3] = f64::NAN;
        assert_eq!(look(&values, 0, 0.1), Quick::Unclear);
    }
}
