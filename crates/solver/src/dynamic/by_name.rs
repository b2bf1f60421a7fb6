//! Runs of dynamic systems with a pair that is chosen at run time.

use crate::dynamic::results::{DynamicObserver, DynamicRun};
use crate::dynamic::runner::run_dynamic;
use crate::dynamic::system::{DynamicStart, DynamicSystem};
use crate::error::RunError;
use crate::method::{Dop853, Dopri5, EmbeddedPair};
use crate::options::Options;

/// As [`run_dynamic`], with a pair that is chosen at run time. Results are the same, bit for bit.
///
/// ```
/// use stickslip_solver::{EmbeddedPair, Guard, Options};
/// use stickslip_solver::dynamic::{DynamicStart, DynamicSystem, run_dynamic_with};
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
/// let start = DynamicStart { mode: (), s: 0.0, state: &[1.0; 1000] };
/// for name in ["dopri5", "dop853"] {
///     let pair: EmbeddedPair = name.parse()?;
///     let end = run_dynamic_with(pair, &Decay, start, 1.0, &Options::default(), &mut ())?;
///     assert!((end.state[999] - (-1.0_f64).exp()).abs() < 1e-9);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Those of [`run_dynamic`].
pub fn run_dynamic_with<S, O>(
    pair: EmbeddedPair,
    system: &S,
    start: DynamicStart<'_, S::Mode>,
    end: f64,
    options: &Options,
    observer: &mut O,
) -> Result<DynamicRun<S::Mode>, RunError>
where
    S: DynamicSystem,
    O: DynamicObserver<S::Mode>,
{
    match pair {
        EmbeddedPair::Dopri5 => run_dynamic(Dopri5, system, start, end, options, observer),
        EmbeddedPair::Dop853 => run_dynamic(Dop853, system, start, end, options, observer),
    }
}
