//! One step with a Runge–Kutta pair, as a pure function.

use nalgebra::ArrayStorage;

use crate::method::dense::Dense;
use crate::method::state::{State, add_multiple, combine};
use crate::method::tableau::{INTERIOR_NODES, MAX_STAGES, Method};

/// A step to be tried.
#[derive(Clone, Copy, Debug)]
pub struct Trial<'a, const N: usize> {
    /// The place where the step starts.
    pub s: f64,
    /// The state at the start.
    pub y: &'a State<N>,
    /// The part of the state that rounding has cut off from `y`: [`Step::rest`] of the step before,
    /// or [`Self::NO_REST`].
    pub rest: &'a State<N>,
    /// The derivative of the state at the start.
    pub slope: &'a State<N>,
    /// The size of the step.
    pub h: f64,
    /// The relative and the absolute tolerance that scale the error.
    pub tolerances: (f64, f64),
}

impl<const N: usize> Trial<'_, N> {
    /// Nothing that rounding has cut off.
    pub const NO_REST: &'static State<N> = &State::from_array_storage(ArrayStorage([[0.0; N]; 1]));
}

/// A step of size `h` from `y0` at `s` to `y1`.
#[derive(Clone, Copy, Debug)]
pub struct Step<const N: usize> {
    /// The place where the step starts.
    pub s: f64,
    /// The size of the step.
    pub h: f64,
    /// The state at the start of the step.
    pub y0: State<N>,
    /// The derivative of the state at the start of the step.
    pub slope0: State<N>,
    /// The state at the end of the step.
    pub y1: State<N>,
    /// The part of the state at the end that rounding has cut off from `y1`. With it the errors of
    /// rounding of many short steps do not add up.
    pub rest: State<N>,
    /// The states at [`INTERIOR_NODES`].
    pub interior: [State<N>; 4],
    /// The estimated error of `y1` relative to `atol + rtol·max(|y0|, |y1|)`, as a root mean
    /// square over the components. The step is good if this is below 1. NaN is not below 1.
    pub error: f64,
    /// What rounding has cut off from `y0`.
    rest0: State<N>,
    /// The derivative of the state at the end of the step, once it is known.
    slope1: Option<State<N>>,
}

impl<const N: usize> Step<N> {
    /// A step of size 0, as room for a step to be taken.
    #[must_use]
    pub fn blank() -> Self {
        let zero = State::zeros();
        Self {
            s: 0.0,
            h: 0.0,
            y0: zero,
            slope0: zero,
            y1: zero,
            rest: zero,
            interior: [zero; 4],
            error: 0.0,
            rest0: zero,
            slope1: None,
        }
    }

    /// Takes the step `trial` and stores it here.
    #[inline]
    pub fn take<M: Method>(
        &mut self,
        field: &mut impl FnMut(f64, &State<N>) -> State<N>,
        trial: &Trial<'_, N>,
    ) {
        self.take_with::<M>(field, trial, |_| trial.tolerances);
    }

    /// Takes the step `trial` and stores it here. The error of each component is relative to the
    /// tolerances (`rtol`, `atol`) that `tolerances` returns for its index, and not to those of the
    /// trial.
    #[inline(always)]
    pub fn take_with<M: Method>(
        &mut self,
        field: &mut impl FnMut(f64, &State<N>) -> State<N>,
        trial: &Trial<'_, N>,
        tolerances: impl Fn(usize) -> (f64, f64),
    ) {
        let &Trial { s, y: y0, slope, h, .. } = trial;
        let mut k = stages::<M, N>(field, trial, &mut self.interior);
        self.s = s;
        self.h = h;
        (self.y0, self.rest0) = (*y0, *trial.rest);
        self.slope0 = *slope;
        let rise = add_multiple(trial.rest, &combine(&M::TABLEAU.b, &k, M::STAGES), h);
        let y1 = y0 + rise;
        self.y1 = y1;
        self.rest = rise - (y1 - y0);
        self.slope1 = None;
        if M::ERROR_USES_END {
            k[M::STAGES] = field(s + h, &y1);
            self.slope1 = Some(k[M::STAGES]);
        }
        let used = M::STAGES + usize::from(M::ERROR_USES_END);
        let fine = combine(&M::TABLEAU.error, &k, used);
        let coarse = combine(&M::TABLEAU.coarse_error, &k, used);
        let (mut fine_sum, mut coarse_sum) = (0.0, 0.0);
        for i in 0..N {
            // A component without error adds nothing. Compiled for a mode in which it is constant,
            // it costs nothing either.
            if fine[i] == 0.0 && coarse[i] == 0.0 {
                continue;
            }
            let (rtol, atol) = tolerances(i);
            let (start, end) = (y0[i].abs(), y1[i].abs());
            let weight = 1.0 / (atol + rtol * if start > end { start } else { end });
            fine_sum += (fine[i] * weight) * (fine[i] * weight);
            coarse_sum += (coarse[i] * weight) * (coarse[i] * weight);
        }
        let n = N as f64;
        // Hairer, Nørsett and Wanner, Solving Ordinary Differential Equations I, section II.10:
        // the coarse estimate corrects the fine one where that is accidentally small.
        let blend = fine_sum + 0.01 * coarse_sum;
        self.error = if blend == 0.0 {
            0.0
        } else if blend < f64::INFINITY {
            h.abs() * fine_sum / (n * blend).sqrt()
        } else {
            largest_error(&fine, y0, &y1, h, tolerances)
        };
        if M::INTERIOR_STAGES.is_none() {
            let dense = self.extend::<M>(field, k);
            for (state, theta) in self.interior.iter_mut().zip(INTERIOR_NODES) {
                *state = dense.at(theta);
            }
        }
    }

    /// A trial step of size `h` from the same start, whose error does not matter.
    pub(crate) fn shortened(&self, h: f64) -> Trial<'_, N> {
        let (y, rest) = (&self.y0, &self.rest0);
        Trial { s: self.s, y, rest, slope: &self.slope0, h, tolerances: (1.0, 1.0) }
    }

    /// The step of size 0 from the same start.
    pub(crate) fn shrunk_to_start(&self) -> Self {
        let (h, y1, rest, interior) = (0.0, self.y0, self.rest0, [self.y0; 4]);
        Self { h, y1, rest, interior, slope1: Some(self.slope0), ..*self }
    }

    /// Makes this the same step in −s, whose right-hand side has the other sign.
    pub(crate) fn reverse(&mut self) {
        self.s = 0.0 - self.s;
        self.h = -self.h;
        self.slope0 = -self.slope0;
        self.slope1 = self.slope1.map(|slope| -slope);
    }

    /// The derivative at the end of the step. It is computed on first use.
    #[inline]
    pub fn finish<M: Method>(
        &mut self,
        field: &mut impl FnMut(f64, &State<N>) -> State<N>,
    ) -> State<N> {
        *self.slope1.get_or_insert_with(|| field(self.s + self.h, &self.y1))
    }

    /// The dense output over the step.
    ///
    /// This takes the stages of the step again, and then those of the dense output. A step does not
    /// keep its stages, because few steps need them.
    pub fn dense<M: Method>(
        &mut self,
        field: &mut impl FnMut(f64, &State<N>) -> State<N>,
    ) -> Dense<N> {
        let k = stages::<M, N>(field, &self.shortened(self.h), &mut [State::zeros(); 4]);
        self.extend::<M>(field, k)
    }

    fn extend<M: Method>(
        &mut self,
        field: &mut impl FnMut(f64, &State<N>) -> State<N>,
        mut k: [State<N>; MAX_STAGES],
    ) -> Dense<N> {
        let f1 = self.finish::<M>(field);
        k[M::STAGES] = f1;
        for i in M::STAGES + 1..M::DENSE_STAGES {
            let y = self.y0 + combine(&M::TABLEAU.a[i], &k, i) * self.h;
            k[i] = field(self.s + M::TABLEAU.c[i] * self.h, &y);
        }
        let mut r = [State::zeros(); 8];
        let rise = self.y1 - self.y0;
        let bend = k[0] * self.h - rise;
        r[0] = self.y0;
        r[1] = rise;
        r[2] = bend;
        r[3] = rise - f1 * self.h - bend;
        for (i, row) in M::TABLEAU.dense.iter().enumerate().take(M::DENSE_DEGREE - 3) {
            r[4 + i] = combine(row, &k, M::DENSE_STAGES) * self.h;
        }
        Dense { s: self.s, h: self.h, r, degree: M::DENSE_DEGREE }
    }
}

/// The largest error of a component relative to its tolerance, where the root mean square is out of
/// the range of doubles.
#[cold]
fn largest_error<const N: usize>(
    fine: &State<N>,
    y0: &State<N>,
    y1: &State<N>,
    h: f64,
    tolerances: impl Fn(usize) -> (f64, f64),
) -> f64 {
    (0..N).filter(|&i| fine[i] != 0.0).fold(0.0, |most, i| {
        let (rtol, atol) = tolerances(i);
        let error = fine[i].abs() * h.abs() / (atol + rtol * y0[i].abs().max(y1[i].abs()));
        // NaN stays.
        if error <= most { most } else { error }
    })
}

/// The derivatives at the stages of the step `trial`. The states at [`INTERIOR_NODES`] are written
/// to `interior`.
///
/// The stages are a local array everywhere, so that the compiler can keep it in registers and drop
/// components that the right-hand side does not use.
#[inline(always)]
fn stages<M: Method, const N: usize>(
    field: &mut impl FnMut(f64, &State<N>) -> State<N>,
    trial: &Trial<'_, N>,
    interior: &mut [State<N>; 4],
) -> [State<N>; MAX_STAGES] {
    let &Trial { s, y: y0, slope, h, .. } = trial;
    let mut k = [State::zeros(); MAX_STAGES];
    k[0] = *slope;
    macro_rules! stages {
        ($($i:literal)*) => {$(
            if $i < M::STAGES {
                // The newest stage is added last, by few operations, since each stage waits for the
                // one before it.
                let weights = &M::TABLEAU.a[$i];
                let early = y0 + combine(weights, &k, $i - 1) * h;
                let y = add_multiple(&early, &k[$i - 1], h * weights[$i - 1]);
                if let Some(stages) = M::INTERIOR_STAGES {
                    for (interior, stage) in interior.iter_mut().zip(stages) {
                        if stage == $i {
                            *interior = y;
                        }
                    }
                }
                k[$i] = field(s + M::TABLEAU.c[$i] * h, &y);
            }
        )*};
    }
    stages!(1 2 3 4 5 6 7 8 9 10 11);
    k
}
