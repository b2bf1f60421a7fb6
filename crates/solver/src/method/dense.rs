//! Dense output: the state between the ends of a step.

use crate::method::state::State;

/// The dense output (continuous extension) of one step: a polynomial in the step fraction
/// θ ∈ [0, 1], r₀ + θ(r₁ + (1−θ)(r₂ + θ(r₃ + (1−θ)(r₄ + …)))).
#[derive(Clone, Copy, Debug)]
pub struct Dense<const N: usize> {
    pub(super) s: f64,
    pub(super) h: f64,
    pub(super) r: [State<N>; 8],
    pub(super) degree: usize,
}

impl<const N: usize> Dense<N> {
    /// The place where the step starts.
    #[must_use]
    pub fn start(&self) -> f64 {
        self.s
    }

    /// The size of the step.
    #[must_use]
    pub fn size(&self) -> f64 {
        self.h
    }

    /// The state at step fraction `theta`.
    #[must_use]
    pub fn at(&self, theta: f64) -> State<N> {
        self.truncated(theta, self.degree)
    }

    /// The state at step fraction `theta` without the last term of the polynomial. The size of that
    /// term bounds the error of [`Self::at`].
    #[must_use]
    pub fn coarse_at(&self, theta: f64) -> State<N> {
        self.truncated(theta, self.degree - 1)
    }

    fn truncated(&self, theta: f64, degree: usize) -> State<N> {
        let mut sum = self.r[degree];
        for i in (0..degree).rev() {
            sum = self.r[i] + sum * if i % 2 == 0 { theta } else { 1.0 - theta };
        }
        sum
    }
}
