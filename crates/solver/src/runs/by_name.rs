//! Runs with a pair that is chosen at run time.

use crate::error::RunError;
use crate::hybrid::{HybridSystem, Observer, Run, Start};
use crate::method::{Dop853, Dopri5, EmbeddedPair};
use crate::options::Options;
use crate::runs::runner::run;

/// As [`run`](crate::run), with a pair that is chosen at run time. Results are the same, bit for
/// bit; the code for both pairs is compiled.
///
/// ```
/// use stickslip_solver::{Closures, EmbeddedPair, Options, Start, State, run_with};
///
/// let decay = Closures::new(|_s, y: &State<1>| -y);
/// let start = Start { mode: (), s: 0.0, state: State::from([1.0]) };
/// for name in ["dopri5", "dop853"] {
///     let pair: EmbeddedPair = name.parse()?;
///     let end = run_with(pair, &decay, start, 1.0, &Options::default(), &mut ())?;
///     assert!((end.state[0] - (-1.0_f64).exp()).abs() < 1e-9);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Those of [`run`](crate::run).
pub fn run_with<S, O, const N: usize, const G: usize>(
    pair: EmbeddedPair,
    system: &S,
    start: Start<S::Mode, N>,
    end: f64,
    options: &Options,
    observer: &mut O,
) -> Result<Run<S::Mode, N>, RunError>
where
    S: HybridSystem<N, G>,
    O: Observer<S::Mode, N>,
{
    match pair {
        EmbeddedPair::Dopri5 => run(Dopri5, system, start, end, options, observer),
        EmbeddedPair::Dop853 => run(Dop853, system, start, end, options, observer),
    }
}
