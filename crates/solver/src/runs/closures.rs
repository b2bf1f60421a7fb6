//! Systems made of closures.

use std::fmt::Debug;
use std::marker::PhantomData;

use crate::hybrid::{Guard, HybridSystem};
use crate::method::State;

/// The guards of a system without guards, and their values.
type NoGuards<M> = fn(M) -> [Guard; 0];
type NoValues<M, const N: usize> = fn(M, f64, &State<N>) -> [f64; 0];

/// A transition that changes nothing.
type NoTransition<M, const N: usize> = fn(M, usize, f64, &State<N>) -> (M, State<N>);

/// A hybrid system whose parts are closures, for quick problems.
///
/// `F` is the right-hand side, `L` lists the guards of a mode, `V` returns their values, and `T` is
/// the transition. The solver cannot read closures ([`HybridSystem::READABLE`]): guards are
/// sampled. Guards on a scale much shorter than the solution's need
/// [`Options::guard_scale`](crate::Options::guard_scale) or a
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
/// run(Dop853, &ball, start, 2.0, &Options::default(), &mut bounces)?.finished()?;
/// let fall = (2.0_f64 / 9.81).sqrt();
/// assert!((bounces[1].s - (1.0 + 2.0 * 0.9) * fall).abs() < 1e-12);
/// # Ok::<(), stickslip_solver::RunError>(())
/// ```
///
/// A heater is on below 19 degrees, and off above 21:
///
/// ```
/// use stickslip_solver::{Closures, Direction, Dop853, Guard, Options, Start, State, run};
///
/// let room = Closures::with_modes(|on: bool, _time, y: &State<1>| {
///     State::from([if on { 30.0 - y[0] } else { 10.0 - y[0] }])
/// })
/// .guards_of_modes(
///     |_on| [Guard::new(Direction::Below)],
///     |on, _time, y| [if on { 21.0 - y[0] } else { y[0] - 19.0 }],
/// )
/// .transition_of_modes(|on, _guard, _time, y| (!on, *y));
/// let start = Start { mode: true, s: 0.0, state: State::from([20.0]) };
/// let mut switches = Vec::new();
/// run(Dop853, &room, start, 2.0, &Options::default(), &mut switches)?.finished()?;
/// // From 20 to 21 degrees, and down to 19.
/// assert!((switches[0].s - (10.0_f64 / 9.0).ln()).abs() < 1e-9);
/// assert!((switches[1].s - switches[0].s - (11.0_f64 / 9.0).ln()).abs() < 1e-9);
/// # Ok::<(), stickslip_solver::RunError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Closures<M, F, L, V, T, const N: usize, const G: usize> {
    field: F,
    guards: L,
    values: V,
    transition: T,
    modes: PhantomData<fn(M)>,
}

impl<const N: usize> Closures<(), (), (), (), (), N, 0> {
    /// The system of one mode y' = `field`(s, y), without guards.
    #[must_use]
    #[expect(clippy::type_complexity, reason = "types of closures have no names")]
    pub fn new<F>(
        field: F,
    ) -> Closures<
        (),
        impl Fn((), f64, &State<N>) -> State<N>,
        NoGuards<()>,
        NoValues<(), N>,
        NoTransition<(), N>,
        N,
        0,
    >
    where
        F: Fn(f64, &State<N>) -> State<N>,
    {
        Closures::with_modes(move |(), s, y: &State<N>| field(s, y))
    }

    /// The system y' = `field`(mode, s, y), without guards.
    #[must_use]
    pub fn with_modes<M, F>(
        field: F,
    ) -> Closures<M, F, NoGuards<M>, NoValues<M, N>, NoTransition<M, N>, N, 0>
    where
        F: Fn(M, f64, &State<N>) -> State<N>,
    {
        Closures {
            field,
            guards: |_| [],
            values: |_, _, _| [],
            transition: |mode, _, _, y| (mode, *y),
            modes: PhantomData,
        }
    }
}

impl<M, F, L0, V0, T, const N: usize, const G0: usize> Closures<M, F, L0, V0, T, N, G0> {
    /// The same system with the guards `guards`(mode), whose values are `values`(mode, s, y). They
    /// replace earlier ones. [`Guard::OFF`] fills unused places.
    ///
    /// Without a transition, guards only report: give them [`Direction::Falling`], `Rising` or
    /// `Either`, or make them [`terminal`](Guard::terminal).
    ///
    /// [`Direction::Falling`]: crate::Direction::Falling
    #[must_use]
    pub fn guards_of_modes<L, V, const G: usize>(
        self,
        guards: L,
        values: V,
    ) -> Closures<M, F, L, V, T, N, G>
    where
        L: Fn(M) -> [Guard; G],
        V: Fn(M, f64, &State<N>) -> [f64; G],
    {
        let Self { field, transition, modes, .. } = self;
        Closures { field, guards, values, transition, modes }
    }

    /// The same system in which the mode and the state `transition`(mode, guard, s, y) follow when
    /// a guard fires at `y`.
    #[must_use]
    pub fn transition_of_modes<T1>(self, transition: T1) -> Closures<M, F, L0, V0, T1, N, G0>
    where
        T1: Fn(M, usize, f64, &State<N>) -> (M, State<N>),
    {
        let Self { field, guards, values, modes, .. } = self;
        Closures { field, guards, values, transition, modes }
    }
}

impl<F, L0, V0, T0, const N: usize, const G0: usize> Closures<(), F, L0, V0, T0, N, G0> {
    /// As [`Self::guards_of_modes`], of a system of one mode.
    #[must_use]
    #[expect(clippy::type_complexity, reason = "types of closures have no names")]
    pub fn guards<V, const G: usize>(
        self,
        guards: [Guard; G],
        values: V,
    ) -> Closures<(), F, impl Fn(()) -> [Guard; G], impl Fn((), f64, &State<N>) -> [f64; G], T0, N, G>
    where
        V: Fn(f64, &State<N>) -> [f64; G],
    {
        self.guards_of_modes(move |()| guards, move |(), s, y: &State<N>| values(s, y))
    }

    /// As [`Self::transition_of_modes`], of a system of one mode.
    #[must_use]
    #[expect(clippy::type_complexity, reason = "types of closures have no names")]
    pub fn transition<T>(
        self,
        transition: T,
    ) -> Closures<(), F, L0, V0, impl Fn((), usize, f64, &State<N>) -> ((), State<N>), N, G0>
    where
        T: Fn(usize, f64, &State<N>) -> State<N>,
    {
        self.transition_of_modes(move |(), guard, s, y: &State<N>| ((), transition(guard, s, y)))
    }
}

impl<M, F, L, V, T, const N: usize, const G: usize> HybridSystem<N, G>
    for Closures<M, F, L, V, T, N, G>
where
    M: Copy + PartialEq + Debug,
    F: Fn(M, f64, &State<N>) -> State<N>,
    L: Fn(M) -> [Guard; G],
    V: Fn(M, f64, &State<N>) -> [f64; G],
    T: Fn(M, usize, f64, &State<N>) -> (M, State<N>),
{
    type Mode = M;

    #[inline]
    fn field(&self, mode: M, s: f64, y: &State<N>) -> State<N> {
        (self.field)(mode, s, y)
    }

    #[inline]
    fn guards(&self, mode: M) -> [Guard; G] {
        (self.guards)(mode)
    }

    #[inline]
    fn guard_values(&self, mode: M, s: f64, y: &State<N>) -> [f64; G] {
        (self.values)(mode, s, y)
    }

    #[inline]
    fn transition(&self, mode: M, guard: usize, s: f64, y: &State<N>) -> (M, State<N>) {
        (self.transition)(mode, guard, s, y)
    }
}
