//! Tolerances of their own for each component.

use stickslip_number::{Enclosure, Interval, InvalidValue};

use crate::hybrid::{Guard, HybridSystem, Schedule};
use crate::method::{Method, State, Step, Trial};

/// A system with a relative and an absolute tolerance for each component of the state.
///
/// They replace [`Options::rtol`](crate::Options::rtol) and `atol` in the error of a step, which is
/// still a root mean square over the components. Only the size of the very first step is estimated
/// with the tolerances of the options. Everything else is taken from the system, except its own
/// [`step`](HybridSystem::step), which is not used.
///
/// ```
/// use stickslip_solver::{Closures, Dop853, Options, Start, State, Weighted, run};
///
/// // A slow component of size 1e-9, beside a fast one whose digits do not matter.
/// let field = |_: f64, y: &State<3>| State::from([-y[0], 50.0 * y[2], -50.0 * y[1]]);
/// let system = Closures::new(field);
/// let start = Start { mode: (), s: 0.0, state: State::from([1e-9, 0.0, 1.0]) };
/// let options = Options::default();
/// let all = run(Dop853, &system, start, 1.0, &options, &mut ())?;
/// let weighted = Weighted::new(&system, [(1e-10, 1e-20), (1e-2, 1e-2), (1e-2, 1e-2)])?;
/// let one = run(Dop853, &weighted, start, 1.0, &options, &mut ())?;
/// assert!((one.state[0] / 1e-9 - (-1.0_f64).exp()).abs() < 1e-9);
/// assert!(one.statistics.accepted < all.statistics.accepted / 2);
/// # Ok::<(), stickslip_solver::RunError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Weighted<'a, S, const N: usize> {
    system: &'a S,
    tolerances: [(f64, f64); N],
}

impl<'a, S, const N: usize> Weighted<'a, S, N> {
    /// The `system` with a relative and an absolute tolerance for each component, in this order.
    ///
    /// # Errors
    /// [`InvalidValue`] names the first relative tolerance that is not between 1e-15 and 0.1, or
    /// the first absolute one that is not finite and above 0.
    pub fn new(system: &'a S, tolerances: [(f64, f64); N]) -> Result<Self, InvalidValue> {
        for (rtol, atol) in tolerances {
            let accepted = (1e-15..=0.1).contains(&rtol);
            InvalidValue::check("rtol of a component", rtol, "1e-15 to 0.1", accepted)?;
            let accepted = atol > 0.0 && atol.is_finite();
            InvalidValue::check("atol of a component", atol, "a finite number above 0", accepted)?;
        }
        Ok(Self { system, tolerances })
    }
}

impl<S, const N: usize, const G: usize> HybridSystem<N, G> for Weighted<'_, S, N>
where
    S: HybridSystem<N, G>,
{
    type Mode = S::Mode;

    const READABLE: bool = S::READABLE;

    #[inline]
    fn field(&self, mode: S::Mode, s: f64, y: &State<N>) -> State<N> {
        self.system.field(mode, s, y)
    }

    #[inline]
    fn guards(&self, mode: S::Mode) -> [Guard; G] {
        self.system.guards(mode)
    }

    #[inline]
    fn guard_values(&self, mode: S::Mode, s: f64, y: &State<N>) -> [f64; G] {
        self.system.guard_values(mode, s, y)
    }

    fn guard_rates(&self, mode: S::Mode, s: f64, y: &State<N>) -> [f64; G] {
        self.system.guard_rates(mode, s, y)
    }

    fn enclose_guards(&self, mode: S::Mode, s: Enclosure, y: &[Enclosure; N]) -> [Enclosure; G] {
        self.system.enclose_guards(mode, s, y)
    }

    fn enclose_rates(&self, mode: S::Mode, s: Interval, y: &[Interval; N]) -> [Interval; G] {
        self.system.enclose_rates(mode, s, y)
    }

    fn longest_first_step(&self, mode: S::Mode, s: f64, y: &State<N>) -> f64 {
        self.system.longest_first_step(mode, s, y)
    }

    fn settle(&self, mode: S::Mode, y: &State<N>) -> S::Mode {
        self.system.settle(mode, y)
    }

    fn step<M: Method>(&self, mode: S::Mode, trial: &Trial<'_, N>, step: &mut Step<N>) {
        let mut field = |s: f64, y: &State<N>| self.system.field(mode, s, y);
        step.take_with::<M>(&mut field, trial, |component| self.tolerances[component]);
    }

    fn counter(&self, mode: S::Mode, guard: usize) -> usize {
        self.system.counter(mode, guard)
    }

    fn schedule(&self, mode: S::Mode, guard: usize) -> Schedule<'_> {
        self.system.schedule(mode, guard)
    }

    fn rest(
        &self,
        mode: S::Mode,
        guard: usize,
        s: f64,
        y: &State<N>,
    ) -> Option<(S::Mode, State<N>)> {
        self.system.rest(mode, guard, s, y)
    }

    fn transition(&self, mode: S::Mode, guard: usize, s: f64, y: &State<N>) -> (S::Mode, State<N>) {
        self.system.transition(mode, guard, s, y)
    }
}
