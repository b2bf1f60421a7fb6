//! A smooth ODE as a hybrid system of one mode and no guards.

use crate::error::RunError;
use crate::hybrid::{Guard, HybridSystem, Observer, Run, Start};
use crate::method::{Method, State};
use crate::options::Options;
use crate::runs::runner::run;

/// A right-hand side without guards.
#[derive(Clone, Copy, Debug)]
struct Smooth<F>(F);

impl<F: Fn(f64, &State<N>) -> State<N>, const N: usize> HybridSystem<N, 0> for Smooth<F> {
    type Mode = ();

    fn field(&self, (): (), s: f64, y: &State<N>) -> State<N> {
        (self.0)(s, y)
    }

    fn guards(&self, (): ()) -> [Guard; 0] {
        []
    }

    fn guard_values(&self, (): (), _s: f64, _y: &State<N>) -> [f64; 0] {
        []
    }
}

/// Integrates the smooth ODE y' = `field`(s, y) from (`s`, `y`) to `end`.
///
/// ```
/// use stickslip_solver::{Dop853, Options, State, integrate};
///
/// let decay = |_s: f64, y: &State<1>| -y;
/// let end = integrate(Dop853, decay, 0.0, State::from([1.0]), 1.0, &Options::default(), &mut ())?;
/// assert!((end.state[0] - (-1.0_f64).exp()).abs() < 1e-11);
/// # Ok::<(), stickslip_solver::RunError>(())
/// ```
///
/// # Errors
/// Those of [`run`].
pub fn integrate<M: Method, O: Observer<(), N>, const N: usize>(
    method: M,
    field: impl Fn(f64, &State<N>) -> State<N>,
    s: f64,
    y: State<N>,
    end: f64,
    options: &Options,
    observer: &mut O,
) -> Result<Run<(), N>, RunError> {
    run(method, &Smooth(field), Start { mode: (), s, state: y }, end, options, observer)
}
