//! Systems that are written once, generic in their numbers.

use std::fmt;

use num_dual::Dual64;

use crate::hybrid::{Guard, HybridSystem, Schedule};
use crate::method::{Method, State, Step, Trial};
use stickslip_number::{Enclosure, Interval, Number};

/// A piecewise-smooth ODE of `N` components with at most `G` guards in a mode, whose formulas the
/// solver can read.
///
/// It is a [`HybridSystem`] by itself. Its guards are not sampled: on every step the solver bounds
/// them with [`Enclosure`]s, so that it *decides* whether they cross zero, however steep, fast or
/// kinked they are. Rates of guards come from dual numbers.
///
/// Formulas are written with a number first and a constant behind it: `-y[0] * 2.0 + 19.0` and not
/// `19.0 - 2.0 * y[0]`, since Rust has no operators of `f64` with a type of somebody else on its
/// right. `T::from(c)` is a constant that stands alone.
///
/// ```
/// use stickslip_solver::{
///     Direction, Dop853, Guard, Number, Options, ReadableSystem, Start, State, run,
/// };
///
/// /// A stone falls on a table that shakes at 100 Hz.
/// struct Stone;
///
/// impl ReadableSystem<2, 1> for Stone {
///     type Mode = ();
///
///     fn field<T: Number>(&self, (): (), _time: T, y: &[T; 2]) -> [T; 2] {
///         [y[1], T::from(-9.81)]
///     }
///     fn guards(&self, (): ()) -> [Guard; 1] {
///         [Guard::new(Direction::Below).terminal()]
///     }
///     fn guard_values<T: Number>(&self, (): (), time: T, y: &[T; 2]) -> [T; 1] {
///         [y[0] - (time * 628.3).sin() * 0.01]
///     }
/// }
///
/// let start = Start { mode: (), s: 0.0, state: State::from([1.0, 0.0]) };
/// let end = run(Dop853, &Stone, start, 1.0, &Options::default(), &mut ())?;
/// let table = 0.01 * (628.3 * end.s).sin();
/// assert!((end.state[0] - table).abs() < 1e-12);
/// # Ok::<(), stickslip_solver::RunError>(())
/// ```
pub trait ReadableSystem<const N: usize, const G: usize> {
    /// A smooth regime, with everything besides time and state that its right-hand side and its
    /// guards depend on.
    type Mode: Copy + PartialEq + fmt::Debug;

    /// The derivative of the state in `mode`.
    fn field<T: Number>(&self, mode: Self::Mode, s: T, y: &[T; N]) -> [T; N];

    /// The guards of `mode`. [`Guard::OFF`] fills unused places.
    fn guards(&self, mode: Self::Mode) -> [Guard; G];

    /// The values of the guards of `mode`. Values in unused places are ignored.
    fn guard_values<T: Number>(&self, mode: Self::Mode, s: T, y: &[T; N]) -> [T; G];

    /// As [`HybridSystem::guard_rates`]. The provided version is exact.
    fn guard_rates(&self, mode: Self::Mode, s: f64, y: &State<N>) -> [f64; G] {
        let slope = self.field(mode, s, array(y));
        let along = std::array::from_fn(|i| Dual64::new(y[i], slope[i]));
        self.guard_values(mode, Dual64::new(s, 1.0), &along).map(|value| value.eps)
    }

    /// As [`HybridSystem::enclose_rates`]. A system that multiplies its rates by something
    /// multiplies these bounds by it too.
    fn enclose_rates(&self, mode: Self::Mode, s: Interval, y: &[Interval; N]) -> [Interval; G] {
        let slope = self.field(mode, constant(s), &y.map(constant));
        let along = std::array::from_fn(|i| Enclosure { slope: slope[i].value, ..constant(y[i]) });
        self.guard_values(mode, Enclosure::variable(s), &along).map(|value| value.slope)
    }

    /// As [`HybridSystem::longest_first_step`].
    #[inline]
    fn longest_first_step(&self, _mode: Self::Mode, _s: f64, _y: &State<N>) -> f64 {
        f64::INFINITY
    }

    /// As [`HybridSystem::settle`].
    #[inline]
    fn settle(&self, mode: Self::Mode, _y: &State<N>) -> Self::Mode {
        mode
    }

    /// As [`HybridSystem::step`].
    #[inline]
    fn step<M: Method>(&self, mode: Self::Mode, trial: &Trial<'_, N>, step: &mut Step<N>) {
        step.take::<M>(&mut |s, y| self.field(mode, s, array(y)).into(), trial);
    }

    /// As [`HybridSystem::transition`].
    fn transition(
        &self,
        mode: Self::Mode,
        _guard: usize,
        _s: f64,
        y: &State<N>,
    ) -> (Self::Mode, State<N>) {
        (mode, *y)
    }

    /// As [`HybridSystem::schedule`].
    fn schedule(&self, _mode: Self::Mode, _guard: usize) -> Schedule<'_> {
        Schedule::NEVER
    }

    /// As [`HybridSystem::rest`].
    fn rest(
        &self,
        _mode: Self::Mode,
        _guard: usize,
        _s: f64,
        _y: &State<N>,
    ) -> Option<(Self::Mode, State<N>)> {
        None
    }

    /// As [`HybridSystem::transition_condition`].
    fn transition_condition(
        &self,
        _mode: Self::Mode,
        _guard: usize,
        _s: f64,
        _y: &State<N>,
    ) -> f64 {
        f64::NAN
    }
}

/// Bounds for a number, as an enclosure of a function whose derivatives are not of interest.
pub(crate) fn constant(value: Interval) -> Enclosure {
    Enclosure { value, ..Enclosure::from(0.0) }
}

/// The components of a state.
#[inline(always)]
fn array<const N: usize>(y: &State<N>) -> &[f64; N] {
    &y.data.0[0]
}

impl<S: ReadableSystem<N, G>, const N: usize, const G: usize> HybridSystem<N, G> for S {
    type Mode = S::Mode;

    const READABLE: bool = true;

    #[inline(always)]
    fn field(&self, mode: S::Mode, s: f64, y: &State<N>) -> State<N> {
        ReadableSystem::field(self, mode, s, array(y)).into()
    }

    #[inline(always)]
    fn guards(&self, mode: S::Mode) -> [Guard; G] {
        ReadableSystem::guards(self, mode)
    }

    #[inline(always)]
    fn guard_values(&self, mode: S::Mode, s: f64, y: &State<N>) -> [f64; G] {
        ReadableSystem::guard_values(self, mode, s, array(y))
    }

    fn enclose_guards(&self, mode: S::Mode, s: Enclosure, y: &[Enclosure; N]) -> [Enclosure; G] {
        ReadableSystem::guard_values(self, mode, s, y)
    }

    fn guard_rates(&self, mode: S::Mode, s: f64, y: &State<N>) -> [f64; G] {
        ReadableSystem::guard_rates(self, mode, s, y)
    }

    fn enclose_rates(&self, mode: S::Mode, s: Interval, y: &[Interval; N]) -> [Interval; G] {
        ReadableSystem::enclose_rates(self, mode, s, y)
    }

    #[inline]
    fn longest_first_step(&self, mode: S::Mode, s: f64, y: &State<N>) -> f64 {
        ReadableSystem::longest_first_step(self, mode, s, y)
    }

    #[inline]
    fn settle(&self, mode: S::Mode, y: &State<N>) -> S::Mode {
        ReadableSystem::settle(self, mode, y)
    }

    #[inline]
    fn step<M: Method>(&self, mode: S::Mode, trial: &Trial<'_, N>, step: &mut Step<N>) {
        ReadableSystem::step::<M>(self, mode, trial, step);
    }

    fn transition(&self, mode: S::Mode, guard: usize, s: f64, y: &State<N>) -> (S::Mode, State<N>) {
        ReadableSystem::transition(self, mode, guard, s, y)
    }

    fn schedule(&self, mode: S::Mode, guard: usize) -> Schedule<'_> {
        ReadableSystem::schedule(self, mode, guard)
    }

    fn rest(
        &self,
        mode: S::Mode,
        guard: usize,
        s: f64,
        y: &State<N>,
    ) -> Option<(S::Mode, State<N>)> {
        ReadableSystem::rest(self, mode, guard, s, y)
    }

    #[inline]
    fn transition_condition(&self, mode: S::Mode, guard: usize, s: f64, y: &State<N>) -> f64 {
        ReadableSystem::transition_condition(self, mode, guard, s, y)
    }
}
