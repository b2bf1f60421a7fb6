//! A hybrid system of one mode, from closures.

use crate::hybrid::{Guard, HybridSystem};
use crate::method::State;

/// The values of no guards.
type NoValues<const N: usize> = fn(f64, &State<N>) -> [f64; 0];

/// A transition that changes nothing.
type NoTransition<const N: usize> = fn(usize, f64, &State<N>) -> State<N>;

/// A hybrid system of one mode whose parts are closures, for quick problems.
///
/// `F` is the right-hand side, `V` returns the values of the guards, and `T` is the transition. The
/// mode is `()`. Systems with several modes implement [`HybridSystem`] themselves. The solver
/// cannot read closures ([`HybridSystem::READABLE`]): guards are sampled. Guards on a scale much
/// shorter than the solution's need [`Options::guard_scale`](crate::Options::guard_scale) or a
/// [`ReadableSystem`](crate::ReadableSystem).
///
/// A ball bounces and keeps nine tenths of its speed:
///
/// ```
/// use stickslip_solver::{Closures, Direction, Dop853, Guard, Options, Start, State, run};
///
/// let ball = Closures::new(|_time, y: &State<2>| State::from([y[1], -9.81]))
///     .guards([Guard::new(Direction::Below)], |_time, y| [y[0]])
///     .transition(|_guard, _time, y| State::from([0.0, -0.9 * y[1]]));
/// let start = Start { mode: (), s: 0.0, state: State::from([1.0, 0.0]) };
/// let mut bounces = Vec::new();
/// run(Dop853, &ball, start, 2.0, &Options::default(), &mut bounces)?;
/// let fall = (2.0_f64 / 9.81).sqrt();
/// assert!((bounces[1].s - (1.0 + 2.0 * 0.9) * fall).abs() < 1e-12);
/// # Ok::<(), stickslip_solver::RunError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Closures<F, V, T, const N: usize, const G: usize> {
    field: F,
    guards: [Guard; G],
    values: V,
    transition: T,
}

impl<F, const N: usize> Closures<F, NoValues<N>, NoTransition<N>, N, 0>
where
    F: Fn(f64, &State<N>) -> State<N>,
{
    /// The system y' = `field`(s, y) without guards.
    #[must_use]
    pub fn new(field: F) -> Self {
        Self { field, guards: [], values: |_, _| [], transition: |_, _, y| *y }
    }
}

impl<F, V0, T, const N: usize, const G0: usize> Closures<F, V0, T, N, G0> {
    /// The same system with these guards, whose values are `values`(s, y). They replace earlier
    /// ones.
    ///
    /// Without a transition, guards only report: give them [`Direction::Falling`], `Rising` or
    /// `Either`, or make them [`terminal`](Guard::terminal).
    ///
    /// [`Direction::Falling`]: crate::Direction::Falling
    #[must_use]
    pub fn guards<V, const G: usize>(self, guards: [Guard; G], values: V) -> Closures<F, V, T, N, G>
    where
        V: Fn(f64, &State<N>) -> [f64; G],
    {
        Closures { field: self.field, guards, values, transition: self.transition }
    }
}

impl<F, V, T0, const N: usize, const G: usize> Closures<F, V, T0, N, G> {
    /// The same system in which the state `transition`(guard, s, y) follows when a guard fires at
    /// `y`.
    #[must_use]
    pub fn transition<T>(self, transition: T) -> Closures<F, V, T, N, G>
    where
        T: Fn(usize, f64, &State<N>) -> State<N>,
    {
        Closures { field: self.field, guards: self.guards, values: self.values, transition }
    }
}

impl<F, V, T, const N: usize, const G: usize> HybridSystem<N, G> for Closures<F, V, T, N, G>
where
    F: Fn(f64, &State<N>) -> State<N>,
    V: Fn(f64, &State<N>) -> [f64; G],
    T: Fn(usize, f64, &State<N>) -> State<N>,
{
    type Mode = ();

    #[inline]
    fn field(&self, (): (), s: f64, y: &State<N>) -> State<N> {
        (self.field)(s, y)
    }

    #[inline]
    fn guards(&self, (): ()) -> [Guard; G] {
        self.guards
    }

    #[inline]
    fn guard_values(&self, (): (), s: f64, y: &State<N>) -> [f64; G] {
        (self.values)(s, y)
    }

    fn transition(&self, (): (), guard: usize, s: f64, y: &State<N>) -> ((), State<N>) {
        ((), (self.transition)(guard, s, y))
    }
}
