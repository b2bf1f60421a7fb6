//! Exponent and constant of the decay, from full collisions alone.

use nalgebra::{DMatrix, DVector};
use serde::Serialize;

use super::maxima::LargestVelocity;

/// The stiffness from which on the terms left out, of order κ^{−15/4}, are below 1e-7.
const STIFF: f64 = 1e3;

/// The fewest stiffnesses for a fit.
const FEWEST: usize = 7;

/// What is fitted.
#[derive(Clone, Debug, Serialize)]
pub struct Fits {
    /// The number of fitted stiffnesses.
    #[serde(rename = "stiffnesses")]
    pub count: usize,
    /// p of |w_final| = C κ^{−p}.
    #[serde(rename = "exponent_plain")]
    pub plain_exponent: FittedConstant,
    /// p of |w_final| = C κ^{−p} exp(b κ^{−5/4} + c κ^{−5/2}).
    pub exponent: FittedConstant,
    /// C of κ^{5/4}|w_final| = C + b κ^{−5/4} + c κ^{−5/2}.
    pub constant: FittedConstant,
    /// b of the same fit.
    pub correction: FittedConstant,
    /// q of κ^{5/4}|w_final| = C + b κ^{−q}, from three stiffnesses at a time.
    #[serde(rename = "power_of_correction")]
    pub power: FittedConstant,
    /// The largest relative difference of |w_final| between values of ψ.
    #[serde(rename = "relative_spread_over_psi")]
    pub spread: f64,
}

/// A value with its uncertainty.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct FittedConstant {
    /// The value.
    pub value: f64,
    /// Its uncertainty.
    pub uncertainty: f64,
}

impl Fits {
    /// The fits to the highest of the tops at each stiffness; `velocities` are by ψ, then by κ.
    pub(super) fn new(velocities: &[Vec<LargestVelocity>]) -> Option<Self> {
        let mut tops: Vec<(f64, f64)> = Vec::new();
        let mut spread = 0.0_f64;
        for (index, LargestVelocity { kappa, .. }) in velocities.first()?.iter().enumerate() {
            let (low, high) = velocities
                .iter()
                .map(|by_kappa| by_kappa[index].crest.velocity)
                .fold((f64::INFINITY, 0.0), |(low, high), v| (f64::min(low, v), f64::max(high, v)));
            if *kappa >= STIFF {
                tops.push((*kappa, high));
                spread = spread.max(high / low - 1.0);
            }
        }
        if tops.len() < FEWEST {
            return None;
        }
        let scaled = |(kappa, velocity): (f64, f64)| velocity * kappa.powf(1.25);
        let logarithm = |(_, velocity): (f64, f64)| velocity.ln();
        let [one, log, first, second]: [Term; 4] =
            [|_| 1.0, |kappa| -kappa.ln(), |kappa| kappa.powf(-1.25), |kappa| kappa.powf(-2.5)];
        let powers: Vec<f64> = tops
            .windows(3)
            .map(|three| {
                let [a, b, c] = [0, 1, 2].map(|i| scaled(three[i]));
                ((b - a) / (c - b)).ln() / (three[2].0 / three[1].0).ln()
            })
            .collect();
        Some(Self {
            count: tops.len(),
            plain_exponent: estimate(&tops, logarithm, &[one, log], 1)?,
            exponent: estimate(&tops, logarithm, &[one, log, first, second], 1)?,
            constant: estimate(&tops, scaled, &[one, first, second], 0)?,
            correction: estimate(&tops, scaled, &[one, first, second], 1)?,
            power: middle(powers)?,
            spread,
        })
    }
}

/// A function of κ; a fit has a coefficient for each.
type Term = fn(f64) -> f64;

/// Coefficient `index` of the least squares. Its uncertainty is the standard error or, if that is
/// larger, the change when only the stiffer half is fitted.
fn estimate(
    tops: &[(f64, f64)],
    value: impl Fn((f64, f64)) -> f64,
    terms: &[Term],
    index: usize,
) -> Option<FittedConstant> {
    let all = least_squares(tops, &value, terms, index)?;
    let stiffer = least_squares(&tops[tops.len() / 2..], &value, terms, index);
    let change = stiffer.map_or(0.0, |stiffer| (stiffer.value - all.value).abs());
    Some(FittedConstant { uncertainty: all.uncertainty.max(change), ..all })
}

/// Coefficient `index` with its standard error; `None` without more points than terms.
fn least_squares(
    tops: &[(f64, f64)],
    value: impl Fn((f64, f64)) -> f64,
    terms: &[Term],
    index: usize,
) -> Option<FittedConstant> {
    let freedom = tops.len().checked_sub(terms.len()).filter(|freedom| *freedom > 0)?;
    let matrix = DMatrix::from_fn(tops.len(), terms.len(), |i, j| terms[j](tops[i].0));
    // Columns of very different size are scaled to length 1.
    let sizes: Vec<f64> = matrix.column_iter().map(|column| column.norm()).collect();
    let matrix = DMatrix::from_fn(tops.len(), terms.len(), |i, j| matrix[(i, j)] / sizes[j]);
    let values = DVector::from_iterator(tops.len(), tops.iter().map(|top| value(*top)));
    let factors = matrix.clone().qr();
    let triangle = factors.r();
    let solution = triangle.solve_upper_triangular(&(factors.q().transpose() * &values))?;
    let variance = (&matrix * &solution - &values).norm_squared() / freedom as f64;
    // Of the inverse of RᵀR the diagonal is wanted.
    let mut axis = DVector::zeros(terms.len());
    axis[index] = 1.0;
    let spread = triangle.tr_solve_upper_triangular(&axis)?.norm();
    Some(FittedConstant {
        value: solution[index] / sizes[index],
        uncertainty: variance.sqrt() * spread / sizes[index],
    })
}

/// The median, and its distance from the farther end of the middle half.
fn middle(mut values: Vec<f64>) -> Option<FittedConstant> {
    values.retain(|value| value.is_finite());
    values.sort_by(f64::total_cmp);
    let value = *values.get(values.len() / 2)?;
    let [low, high] = [values.len() / 4, values.len() * 3 / 4].map(|i| values[i]);
    Some(FittedConstant { value, uncertainty: (value - low).max(high - value) })
}
