//! Dense output of a dynamic step.

/// The dense output of one step: a polynomial in the step fraction θ ∈ [0, 1] for every component,
/// as in [`Dense`](crate::Dense). It borrows the buffers of the run.
#[derive(Clone, Copy, Debug)]
pub struct DynamicDense<'a> {
    pub(super) s: f64,
    pub(super) h: f64,
    /// The number of components.
    pub(super) n: usize,
    pub(super) degree: usize,
    /// The coefficients, one after another, each with all its components.
    pub(super) r: &'a [f64],
}

impl DynamicDense<'_> {
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

    /// The number of components of the state.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.n
    }

    /// The state at step fraction `theta`, in memory of its own.
    #[must_use]
    pub fn at(&self, theta: f64) -> Vec<f64> {
        let mut state = vec![0.0; self.n];
        self.write(theta, &mut state);
        state
    }

    /// Writes the state at step fraction `theta` to `state`. If `state` is shorter than the
    /// dimension, only the first components are written; what lies beyond the dimension stays.
    pub fn write(&self, theta: f64, state: &mut [f64]) {
        self.truncated(theta, self.degree, state);
    }

    /// Component `index` of the state at step fraction `theta`, or `None` if there is no such
    /// component.
    #[must_use]
    pub fn component(&self, theta: f64, index: usize) -> Option<f64> {
        (index < self.n).then(|| {
            let mut sum = self.r[self.degree * self.n + index];
            for i in (0..self.degree).rev() {
                sum = self.r[i * self.n + index] + sum * factor(i, theta);
            }
            sum
        })
    }

    /// Writes the state without the last term of the polynomial. The size of that term bounds the
    /// error of [`Self::write`].
    pub(super) fn write_coarse(&self, theta: f64, state: &mut [f64]) {
        self.truncated(theta, self.degree - 1, state);
    }

    /// The same states, as a step in −s.
    pub(super) fn reversed(&self) -> Self {
        Self { s: 0.0 - self.s, h: -self.h, ..*self }
    }

    fn truncated(&self, theta: f64, degree: usize, state: &mut [f64]) {
        let row = |i: usize| &self.r[i * self.n..(i + 1) * self.n];
        for (sum, &r) in state.iter_mut().zip(row(degree)) {
            *sum = r;
        }
        for i in (0..degree).rev() {
            let factor = factor(i, theta);
            for (sum, &r) in state.iter_mut().zip(row(i)) {
                *sum = r + *sum * factor;
            }
        }
    }
}

fn factor(i: usize, theta: f64) -> f64 {
    if i.is_multiple_of(2) { theta } else { 1.0 - theta }
}
