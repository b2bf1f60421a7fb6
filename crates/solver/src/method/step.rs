//! One step with a Runge–Kutta pair, as a pure function.
//!
//! A step on an array does not keep its stages. Dense output needs them on one step in a thousand,
//! and computing them again there is cheaper than storing them on all others. A recorded trajectory
//! therefore costs the stages twice. A step on buffers keeps them, since they lie in a buffer
//! anyway: with many components, right-hand sides are what costs.

use nalgebra::ArrayStorage;

use crate::method::dense::{Dense, DenseOf};
use crate::method::state::State;
use crate::method::store::Store;
use crate::method::tableau::{INTERIOR_NODES, MAX_STAGES, Method, Tableau};

/// A right-hand side that is dispatched at run time. It writes the slope at a time and a state.
pub(crate) type Field<'a, V> = dyn FnMut(f64, &V, &mut V) + 'a;

/// A step to be tried.
pub type Trial<'a, const N: usize> = TrialOf<'a, State<N>>;

/// A step of size `h` from `y0` at `s` to `y1`.
pub type Step<const N: usize> = StepOf<State<N>>;

/// A step to be tried, whatever its states are stored in.
#[derive(Clone, Copy, Debug)]
pub struct TrialOf<'a, V> {
    /// The place where the step starts.
    pub s: f64,
    /// The state at the start.
    pub y: &'a V,
    /// The part of the state that rounding has cut off from `y`: [`Step::rest`] of the step before,
    /// or [`Self::NO_REST`].
    pub rest: &'a V,
    /// The derivative of the state at the start.
    pub slope: &'a V,
    /// The size of the step.
    pub h: f64,
    /// The relative and the absolute tolerance that scale the error.
    pub tolerances: (f64, f64),
}

impl<const N: usize> TrialOf<'_, State<N>> {
    /// Nothing that rounding has cut off.
    pub const NO_REST: &'static State<N> = &State::from_array_storage(ArrayStorage([[0.0; N]; 1]));
}

/// A step of size `h` from `y0` at `s` to `y1`, whatever its states are stored in.
#[derive(Clone, Debug)]
pub struct StepOf<V: Store> {
    /// The place where the step starts.
    pub s: f64,
    /// The size of the step.
    pub h: f64,
    /// The state at the start of the step.
    pub y0: V,
    /// The derivative of the state at the start of the step.
    pub slope0: V,
    /// The state at the end of the step.
    pub y1: V,
    /// The part of the state at the end that rounding has cut off from `y1`. With it the errors of
    /// rounding of many short steps do not add up.
    pub rest: V,
    /// The states at [`INTERIOR_NODES`].
    pub interior: [V; 4],
    /// The estimated error of `y1` relative to `atol + rtol·max(|y0|, |y1|)`, as a root mean
    /// square over the components. The step is good if this is below 1. NaN is not below 1.
    pub error: f64,
    /// What rounding has cut off from `y0`.
    rest0: V,
    /// The derivative of the state at the end of the step, once it is known.
    slope1: V,
    finished: bool,
    /// The stages, where they are kept.
    kept: V::Kept,
}

impl<const N: usize> Copy for StepOf<State<N>> {}

impl<const N: usize> StepOf<State<N>> {
    /// A step of size 0, as room for a step to be taken.
    #[must_use]
    pub fn blank() -> Self {
        Self::new(N)
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
    /// tolerances (`rtol`, `atol`) that `tolerances` returns for its index, and not to the
    /// tolerances of the trial.
    #[inline(always)]
    pub fn take_with<M: Method>(
        &mut self,
        field: &mut impl FnMut(f64, &State<N>) -> State<N>,
        trial: &Trial<'_, N>,
        tolerances: impl Fn(usize) -> (f64, f64),
    ) {
        self.take_in_place::<M>(&mut |s, y, slope| *slope = field(s, y), trial, tolerances);
    }

    /// The derivative at the end of the step. It is computed on first use.
    #[inline]
    pub fn finish<M: Method>(
        &mut self,
        field: &mut impl FnMut(f64, &State<N>) -> State<N>,
    ) -> State<N> {
        *self.end_slope(&mut |s, y, slope| *slope = field(s, y))
    }

    /// The dense output over the step.
    ///
    /// This takes the stages of the step again, and then the stages of the dense output. A step
    /// does not keep its stages, because few steps need them.
    pub fn dense<M: Method>(
        &mut self,
        field: &mut impl FnMut(f64, &State<N>) -> State<N>,
    ) -> Dense<N> {
        let mut dense = DenseOf::room(N);
        self.dense_in_place::<M>(&mut |s, y, slope| *slope = field(s, y), &mut dense);
        dense
    }

    /// Makes this the same step in −s, whose right-hand side has the other sign.
    pub(crate) fn reverse(&mut self) {
        self.s = 0.0 - self.s;
        self.h = -self.h;
        self.slope0 = -self.slope0;
        self.slope1 = -self.slope1;
    }
}

impl StepOf<Vec<f64>> {
    /// Takes the step `trial` and stores it here.
    #[inline(never)]
    pub(crate) fn take_buffers<M: Method>(
        &mut self,
        mut field: &mut Field<'_, Vec<f64>>,
        trial: &TrialOf<'_, Vec<f64>>,
        own: &[(f64, f64)],
    ) {
        let tolerances = |i: usize| own.get(i).copied().unwrap_or(trial.tolerances);
        self.take_in_place::<M>(&mut field, trial, tolerances);
    }
}

impl<V: Store> StepOf<V> {
    /// Room for a step of dimension `n`.
    #[inline(always)]
    pub(crate) fn new(n: usize) -> Self {
        let room = || V::room(n);
        Self {
            s: 0.0,
            h: 0.0,
            y0: room(),
            slope0: room(),
            y1: room(),
            rest: room(),
            interior: [room(), room(), room(), room()],
            error: 0.0,
            rest0: room(),
            slope1: room(),
            finished: false,
            kept: V::keep(n),
        }
    }

    /// Takes the step `trial` and stores it here.
    #[inline(always)]
    pub(crate) fn take_in_place<M: Method>(
        &mut self,
        field: &mut impl FnMut(f64, &V, &mut V),
        trial: &TrialOf<'_, V>,
        tolerances: impl Fn(usize) -> (f64, f64),
    ) {
        let &TrialOf { s, y: y0, h, .. } = trial;
        let n = y0.size();
        let tableau: &'static Tableau = const { &M::TABLEAU };
        let mut k = V::lend_stages(&mut self.kept);
        let mut y = V::lend_room(&mut self.kept, 0);
        take_stages::<M, V>(field, trial, &mut self.interior, &mut k, &mut y);
        self.s = s;
        self.h = h;
        self.y0.set(y0);
        self.rest0.set(trial.rest);
        self.slope0.set(trial.slope);
        let mut y1 = self.y1.lend();
        V::end((&mut y1, &mut self.rest), (y0, trial.rest), (&tableau.b, M::STAGES), &k, h);
        self.finished = false;
        if M::ERROR_USES_END {
            field(s + h, &y1, &mut k[M::STAGES]);
            self.slope1.set(&k[M::STAGES]);
            self.finished = true;
        }
        let used = M::STAGES + usize::from(M::ERROR_USES_END);
        let mut fine = V::lend_room(&mut self.kept, 1);
        let mut coarse = V::lend_room(&mut self.kept, 2);
        V::weighted(&mut fine, &tableau.error, &k, used);
        V::weighted(&mut coarse, &tableau.coarse_error, &k, used);
        let (mut fine_sum, mut coarse_sum) = (0.0, 0.0);
        for i in 0..n {
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
        let size = n as f64;
        // Hairer, Nørsett and Wanner, Solving Ordinary Differential Equations I, section II.10:
        // the coarse estimate corrects the fine one where that is accidentally small.
        let blend = fine_sum + 0.01 * coarse_sum;
        self.error = if blend == 0.0 {
            0.0
        } else if blend < f64::INFINITY {
            h.abs() * fine_sum / (size * blend).sqrt()
        } else {
            largest_error(&fine, y0, &y1, h, tolerances)
        };
        self.y1 = y1;
        if M::INTERIOR_STAGES.is_none() {
            let r = V::lend_dense(&mut self.kept);
            let mut dense = DenseOf { s, h, r, degree: 0 };
            self.extend::<M>(field, &mut k, &mut y, &mut dense);
            for (state, theta) in self.interior.iter_mut().zip(INTERIOR_NODES) {
                dense.write(theta, state);
            }
            V::dense_back(&mut self.kept, dense.r);
        }
        V::stages_back(&mut self.kept, k);
        V::room_back(&mut self.kept, 0, y);
        V::room_back(&mut self.kept, 1, fine);
        V::room_back(&mut self.kept, 2, coarse);
    }

    /// A trial step of size `h` from the same start, whose error does not matter.
    pub(crate) fn shortened(&self, h: f64) -> TrialOf<'_, V> {
        let (y, rest) = (&self.y0, &self.rest0);
        TrialOf { s: self.s, y, rest, slope: &self.slope0, h, tolerances: (1.0, 1.0) }
    }

    /// Makes this the step of size 0 from the start of `trial`.
    pub(crate) fn stand(&mut self, trial: &TrialOf<'_, V>) {
        (self.s, self.h, self.error, self.finished) = (trial.s, 0.0, 0.0, true);
        for y in [&mut self.y0, &mut self.y1].into_iter().chain(&mut self.interior) {
            y.set(trial.y);
        }
        for rest in [&mut self.rest, &mut self.rest0] {
            rest.set(trial.rest);
        }
        for slope in [&mut self.slope0, &mut self.slope1] {
            slope.set(trial.slope);
        }
    }

    /// The step of size 0 from the same start.
    pub(crate) fn shrunk_to_start(&self) -> Self {
        let y = || self.y0.clone();
        let (y1, rest, interior) = (y(), self.rest0.clone(), [y(), y(), y(), y()]);
        let slope1 = self.slope0.clone();
        Self { h: 0.0, y1, rest, interior, slope1, finished: true, ..self.clone() }
    }

    /// The derivative at the end of the step. It is computed on first use.
    #[inline(always)]
    pub(crate) fn end_slope(&mut self, field: &mut impl FnMut(f64, &V, &mut V)) -> &V {
        if !self.finished {
            field(self.s + self.h, &self.y1, &mut self.slope1);
            self.finished = true;
        }
        &self.slope1
    }

    /// Writes the dense output over the step.
    #[inline(always)]
    pub(crate) fn dense_in_place<M: Method>(
        &mut self,
        field: &mut impl FnMut(f64, &V, &mut V),
        dense: &mut DenseOf<V>,
    ) {
        let mut k = V::lend_stages(&mut self.kept);
        let mut y = V::lend_room(&mut self.kept, 0);
        if !V::KEEPS {
            let room = || V::room(self.y0.size());
            let interior = &mut [room(), room(), room(), room()];
            take_stages::<M, V>(field, &self.shortened(self.h), interior, &mut k, &mut y);
        }
        self.extend::<M>(field, &mut k, &mut y, dense);
        V::stages_back(&mut self.kept, k);
        V::room_back(&mut self.kept, 0, y);
    }

    #[inline(always)]
    fn extend<M: Method>(
        &mut self,
        field: &mut impl FnMut(f64, &V, &mut V),
        k: &mut [V; MAX_STAGES],
        y: &mut V,
        dense: &mut DenseOf<V>,
    ) {
        let tableau: &'static Tableau = const { &M::TABLEAU };
        let n = self.y0.size();
        let h = self.h;
        self.end_slope(field);
        let (y0, y1, f1) = (&self.y0, &self.y1, &self.slope1);
        k[M::STAGES].set(f1);
        for i in M::STAGES + 1..M::DENSE_STAGES {
            V::scaled_sums(y, Some(y0), (&tableau.a[i], i), k, h);
            field(self.s + tableau.c[i] * h, y, &mut k[i]);
        }
        let r = &mut dense.r;
        for c in 0..n {
            let rise = y1[c] - y0[c];
            let bend = k[0][c] * h - rise;
            r[0][c] = y0[c];
            r[1][c] = rise;
            r[2][c] = bend;
            r[3][c] = rise - f1[c] * h - bend;
        }
        for (i, row) in tableau.dense.iter().enumerate().take(M::DENSE_DEGREE - 3) {
            V::scaled_sums(&mut r[4 + i], None, (row, M::DENSE_STAGES), k, h);
        }
        (dense.s, dense.h, dense.degree) = (self.s, h, M::DENSE_DEGREE);
    }
}

/// The largest error of a component relative to its tolerance, where the root mean square is out of
/// the range of doubles.
#[cold]
fn largest_error<V: Store>(
    fine: &V,
    y0: &V,
    y1: &V,
    h: f64,
    tolerances: impl Fn(usize) -> (f64, f64),
) -> f64 {
    (0..y0.size()).filter(|&i| fine[i] != 0.0).fold(0.0, |most, i| {
        let (rtol, atol) = tolerances(i);
        let error = fine[i].abs() * h.abs() / (atol + rtol * y0[i].abs().max(y1[i].abs()));
        // NaN stays.
        if error <= most { most } else { error }
    })
}

/// The derivatives at the stages of the step `trial`. The states at [`INTERIOR_NODES`] are written
/// to `interior`.
///
/// Stages of fixed dimension are a local array everywhere, so that the compiler can keep it in
/// registers and drop components that the right-hand side does not use.
#[inline(always)]
fn take_stages<M: Method, V: Store>(
    field: &mut impl FnMut(f64, &V, &mut V),
    trial: &TrialOf<'_, V>,
    interior: &mut [V; 4],
    k: &mut [V; MAX_STAGES],
    y: &mut V,
) {
    let &TrialOf { s, y: y0, slope, h, .. } = trial;
    let tableau: &'static Tableau = const { &M::TABLEAU };
    k[0].set(slope);
    macro_rules! stages {
        ($($i:literal)*) => {$(
            if $i < M::STAGES {
                // The newest stage is added last, by few operations, since each stage waits for the
                // one before it.
                let weights = &tableau.a[$i];
                V::stage::<$i>(y, y0, weights, k, h);
                if let Some(stages) = M::INTERIOR_STAGES {
                    for (interior, stage) in interior.iter_mut().zip(stages) {
                        if stage == $i {
                            interior.set(y);
                        }
                    }
                }
                field(s + tableau.c[$i] * h, y, &mut k[$i]);
            }
        )*};
    }
    stages!(1 2 3 4 5 6 7 8 9 10 11);
}
