//! Dense output: the state between the ends of a step.

use crate::method::state::State;
use crate::method::store::Store;

/// The dense output (continuous extension) of one step: a polynomial in the step fraction
/// θ ∈ [0, 1], r₀ + θ(r₁ + (1−θ)(r₂ + θ(r₃ + (1−θ)(r₄ + …)))).
pub type Dense<const N: usize> = DenseOf<State<N>>;

/// The dense output, whatever its states are stored in.
#[derive(Clone, Copy, Debug)]
pub struct DenseOf<V> {
    pub(crate) s: f64,
    pub(crate) h: f64,
    pub(crate) r: [V; 8],
    pub(crate) degree: usize,
}

impl<const N: usize> DenseOf<State<N>> {
    /// The state at step fraction `theta`.
    #[must_use]
    pub fn at(&self, theta: f64) -> State<N> {
        let mut y = State::zeros();
        self.write(theta, &mut y);
        y
    }

    /// The state at step fraction `theta` without the last term of the polynomial. The size of that
    /// term bounds the error of [`Self::at`].
    #[must_use]
    pub fn coarse_at(&self, theta: f64) -> State<N> {
        let mut y = State::zeros();
        self.write_coarse(theta, &mut y);
        y
    }

    /// The same states, as a step in −s.
    pub(crate) fn reversed(&self) -> Self {
        Self { s: 0.0 - self.s, h: -self.h, ..*self }
    }
}

impl<V: Store> DenseOf<V> {
    /// Room for the dense output of a step of dimension `n`.
    #[inline(always)]
    pub(crate) fn room(n: usize) -> Self {
        let r = || V::room(n);
        Self { s: 0.0, h: 0.0, r: [r(), r(), r(), r(), r(), r(), r(), r()], degree: 0 }
    }

    /// The place where the step starts.
    #[must_use]
    pub fn start(&self) -> f64 {
        self.s
    }

    /// The size of the step. It is negative if the run goes backwards.
    #[must_use]
    pub fn size(&self) -> f64 {
        self.h
    }

    /// Writes the state at step fraction `theta`.
    pub fn write(&self, theta: f64, state: &mut V) {
        self.truncated(theta, self.degree, state);
    }

    /// Writes the state without the last term of the polynomial.
    pub(crate) fn write_coarse(&self, theta: f64, state: &mut V) {
        self.truncated(theta, self.degree - 1, state);
    }

    /// The coefficients of component `i` for powers of the step fraction, and the largest size of
    /// its last term on the step.
    pub(crate) fn terms(&self, i: usize) -> ([f64; 8], f64) {
        let mut terms = [0.0; 8];
        terms[0] = self.r[self.degree][i];
        for k in (0..self.degree).rev() {
            // Times θ, or times 1 − θ.
            for power in (0..7).rev() {
                let raised = terms[power];
                let kept = if k % 2 == 0 { 0.0 } else { terms[power + 1] };
                terms[power + 1] = if k % 2 == 0 { raised } else { kept - raised };
            }
            terms[0] = self.r[k][i] + if k % 2 == 0 { 0.0 } else { terms[0] };
        }
        // The maximum of θ^a (1 − θ)^b.
        let (a, b) = (self.degree.div_ceil(2), self.degree / 2);
        let part = |power: usize| {
            let base = power as f64 / self.degree as f64;
            (0..power).fold(1.0, |product, _| product * base)
        };
        let most = part(a) * part(b);
        (terms, most * self.r[self.degree][i].abs())
    }

    fn truncated(&self, theta: f64, degree: usize, sum: &mut V) {
        sum.set(&self.r[degree]);
        for i in (0..degree).rev() {
            let factor = if i % 2 == 0 { theta } else { 1.0 - theta };
            for (sum, r) in sum.parts_mut().iter_mut().zip(self.r[i].parts()) {
                *sum = r + *sum * factor;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_terms_are_those_of_the_polynomial() {
        for degree in [4, 7] {
            let r = std::array::from_fn(|i| State::from([1.0 / (1.0 + i as f64) - 0.3]));
            let dense = Dense { s: 0.0, h: 1.0, r, degree };
            let (terms, last) = dense.terms(0);
            let mut most = 0.0_f64;
            for j in 0..=1000 {
                let theta = f64::from(j) / 1000.0;
                let value = terms.iter().rev().fold(0.0, |sum, term| sum * theta + term);
                assert!((value - dense.at(theta)[0]).abs() < 1e-14);
                most = most.max((dense.at(theta) - dense.coarse_at(theta))[0].abs());
            }
            assert!(most <= last * (1.0 + 1e-14) && most > 0.999 * last);
        }
    }
}
