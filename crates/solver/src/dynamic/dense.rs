//! Dense output of a dynamic step.

/// The dense output of one step: a polynomial in the step fraction θ ∈ [0, 1] for every component,
/// as in [`Dense`](crate::method::Dense). It borrows the buffers of the run.
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

impl<'a> DynamicDense<'a> {
    /// The coefficients of the polynomial: of each component the first one, then of each the second
    /// one, and so on. [`Self::from_coefficients`] makes the same dense output of them, so that it
    /// can be kept.
    ///
    /// ```
    /// use stickslip_solver::{Dop853, Guard, Options};
    /// use stickslip_solver::dynamic::{
    ///     DynamicDense, DynamicObserver, DynamicStart, DynamicSystem, run_dynamic,
    /// };
    ///
    /// struct Decay;
    ///
    /// impl DynamicSystem for Decay {
    ///     type Mode = ();
    ///
    ///     fn field(&self, (): (), _s: f64, y: &[f64], slope: &mut [f64]) {
    ///         slope.iter_mut().zip(y).for_each(|(slope, y)| *slope = -y);
    ///     }
    ///     fn guards(&self, (): ()) -> &[Guard] {
    ///         &[]
    ///     }
    ///     fn guard_values(&self, (): (), _s: f64, _y: &[f64], _values: &mut [f64]) {}
    /// }
    ///
    /// /// Starts, sizes and coefficients of all steps.
    /// #[derive(Default)]
    /// struct Kept(Vec<(f64, f64, Vec<f64>)>);
    ///
    /// impl DynamicObserver<()> for Kept {
    ///     const WANTS_SEGMENTS: bool = true;
    ///
    ///     fn on_segment(&mut self, (): (), dense: &DynamicDense<'_>) {
    ///         self.0.push((dense.start(), dense.size(), dense.coefficients().to_vec()));
    ///     }
    /// }
    ///
    /// let start = DynamicStart { mode: (), s: 0.0, state: &[1.0, 2.0] };
    /// let mut kept = Kept::default();
    /// let end = run_dynamic(Dop853, &Decay, start, 1.0, &Options::default(), &mut kept)?;
    /// let (s, h, coefficients) = kept.0.last().expect("it has steps");
    /// let last = DynamicDense::from_coefficients(*s, *h, 2, coefficients).expect("two
    /// components"); assert!((last.at(1.0)[1] - end.state[1]).abs() < 1e-15);
    /// let half = s + 0.5 * h;
    /// assert!((last.at(0.5)[1] - 2.0 * (-half).exp()).abs() < 1e-9);
    /// # Ok::<(), stickslip_solver::RunError>(())
    /// ```
    #[must_use]
    pub fn coefficients(&self) -> &'a [f64] {
        &self.r[..(self.degree + 1) * self.n]
    }

    /// The dense output of the step from `start` of this size, whose [`Self::coefficients`] were
    /// kept. It is `None` if their number is not a multiple of the dimension, or 0 though there are
    /// components.
    ///
    /// ```
    /// use stickslip_solver::dynamic::DynamicDense;
    ///
    /// // 1 + 4θ and 2 + 5θ.
    /// let line = DynamicDense::from_coefficients(0.0, 0.5, 2, &[1.0, 2.0, 4.0, 5.0]);
    /// assert_eq!(line.map(|line| line.at(0.5)), Some(vec![3.0, 4.5]));
    /// assert!(DynamicDense::from_coefficients(0.0, 0.5, 2, &[1.0, 2.0, 4.0]).is_none());
    /// assert!(DynamicDense::from_coefficients(0.0, 0.5, 2, &[]).is_none());
    /// assert!(DynamicDense::from_coefficients(0.0, 0.5, 0, &[]).is_some());
    /// ```
    #[must_use]
    pub fn from_coefficients(
        start: f64,
        size: f64,
        dimension: usize,
        coefficients: &'a [f64],
    ) -> Option<Self> {
        let terms = coefficients.len().checked_div(dimension).unwrap_or(1);
        let fits = terms > 0 && terms * dimension == coefficients.len();
        fits.then(|| Self { s: start, h: size, n: dimension, degree: terms - 1, r: coefficients })
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
        let row = |i: usize| &self.r[i * self.n..(i + 1) * self.n];
        for (sum, &r) in state.iter_mut().zip(row(self.degree)) {
            *sum = r;
        }
        for i in (0..self.degree).rev() {
            let factor = factor(i, theta);
            for (sum, &r) in state.iter_mut().zip(row(i)) {
                *sum = r + *sum * factor;
            }
        }
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

    /// The same states, as a step in −s.
    pub(super) fn reversed(&self) -> Self {
        Self { s: 0.0 - self.s, h: -self.h, ..*self }
    }
}

fn factor(i: usize, theta: f64) -> f64 {
    if i.is_multiple_of(2) { theta } else { 1.0 - theta }
}
