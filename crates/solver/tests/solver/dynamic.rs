//! Systems whose dimension is known at run time.
//!
//! | module | content |
//! |---|---|
//! | `same` | what the runs of fixed dimension find is found, at the same places |
//! | `planted` | random guards whose zeros are known |
//! | `large` | 20 000 components, small stacks, no allocation per step |
//! | `answers` | the defined answers, limits, errors, runs backwards |
//! | `chains` | several guards at one instant |
//! | `broken` | inputs that nobody designed for |
//! | `fixed_states` | small systems on states of fixed dimension |

mod answers;
mod broken;
mod chains;
mod fixed_states;
mod large;
mod planted;
mod rooms;
mod same;

use stickslip_solver::dynamic::{
    DynamicObserver, DynamicRun, DynamicStart, DynamicSwitch, DynamicSystem,
};
use stickslip_solver::{Guard, HybridSystem, Method, Options, RunError, State};

use crate::erased::run_dynamic;

/// A system of fixed dimension as one of any dimension. Its modes are listed with their guards.
struct Of<'a, S: HybridSystem<N, G>, const N: usize, const G: usize> {
    system: &'a S,
    modes: Vec<(S::Mode, [Guard; G])>,
}

impl<'a, S: HybridSystem<N, G>, const N: usize, const G: usize> Of<'a, S, N, G> {
    fn new(system: &'a S, modes: &[S::Mode]) -> Self {
        let guards = |mode: &S::Mode| (*mode, system.guards(*mode));
        Self { system, modes: modes.iter().map(guards).collect() }
    }
}

impl<S: HybridSystem<N, G>, const N: usize, const G: usize> DynamicSystem for Of<'_, S, N, G> {
    type Mode = S::Mode;

    fn field(&self, mode: S::Mode, s: f64, y: &[f64], slope: &mut [f64]) {
        let value = self.system.field(mode, s, &State::from_column_slice(y));
        slope.copy_from_slice(value.as_slice());
    }

    fn guards(&self, mode: S::Mode) -> &[Guard] {
        let listed = self.modes.iter().find(|(listed, _)| *listed == mode);
        &listed.expect("a listed mode").1
    }

    fn guard_values(&self, mode: S::Mode, s: f64, y: &[f64], values: &mut [f64]) {
        let found = self.system.guard_values(mode, s, &State::from_column_slice(y));
        values.copy_from_slice(&found);
    }

    fn transition(&self, mode: S::Mode, guard: usize, s: f64, y: &mut [f64]) -> S::Mode {
        let (to, after) = self.system.transition(mode, guard, s, &State::from_column_slice(y));
        y.copy_from_slice(after.as_slice());
        to
    }
}

/// A system of one mode from closures.
pub struct Plain<F, V> {
    pub field: F,
    pub guards: Vec<Guard>,
    pub values: V,
}

impl<'a, F, V> Plain<F, V>
where
    F: Fn(f64, &[f64], &mut [f64]) + 'a,
    V: Fn(f64, &[f64], &mut [f64]) + 'a,
{
    /// The same system as one type for all closures, so that runs are compiled once.
    pub fn boxed(self) -> Boxed<'a> {
        Boxed { field: Box::new(self.field), guards: self.guards, values: Box::new(self.values) }
    }
}

type Function<'a> = Box<dyn Fn(f64, &[f64], &mut [f64]) + 'a>;

/// A system of one mode.
pub struct Boxed<'a> {
    field: Function<'a>,
    guards: Vec<Guard>,
    values: Function<'a>,
}

impl DynamicSystem for Boxed<'_> {
    type Mode = ();

    fn field(&self, (): (), s: f64, y: &[f64], slope: &mut [f64]) {
        (self.field)(s, y, slope);
    }

    fn guards(&self, (): ()) -> &[Guard] {
        &self.guards
    }

    fn guard_values(&self, (): (), s: f64, y: &[f64], values: &mut [f64]) {
        (self.values)(s, y, values);
    }
}

/// A run of a system of one mode from s = 0.
fn go<M: Method, S: DynamicSystem<Mode = ()>>(
    method: M,
    system: &S,
    state: &[f64],
    end: f64,
    options: &Options,
    observer: &mut impl DynamicObserver<()>,
) -> Result<DynamicRun<()>, RunError> {
    let start = DynamicStart { mode: (), s: 0.0, state };
    run_dynamic(method, system, start, end, options, observer)
}

/// The places and guards of switches.
fn places<Mode>(switches: &[DynamicSwitch<Mode>]) -> Vec<(f64, usize)> {
    switches.iter().map(|switch| (switch.s, switch.guard)).collect()
}
