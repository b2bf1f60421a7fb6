//! Runs of dynamic systems that go backwards, as runs forwards in τ = −s.

use crate::dynamic::dense::DynamicDense;
use crate::dynamic::results::{DynamicEvent, DynamicObserver, DynamicRun};
use crate::dynamic::runner::run_dynamic;
use crate::dynamic::system::{DynamicStart, DynamicSystem};
use crate::error::RunError;
use crate::hybrid::{Grazing, Guard, Pole, Preempted, Rest, Schedule};
use crate::method::Method;
use crate::options::Options;
use crate::runs::backwards::{original, reverse};

/// Integrates `system` from `start` down to `end` < `start.s`, through every switch on the way.
///
/// It is to [`run_dynamic`] what [`run_backwards`](crate::run_backwards) is to [`run`](crate::run):
/// directions of guards hold in the direction of integration, transitions are not inverted, and
/// every reported s is the original one.
///
/// # Errors
/// Those of [`run_dynamic`], and [`RunError::Span`] unless `end` < `start.s`.
pub fn run_dynamic_backwards<M, S, O>(
    method: M,
    system: &S,
    start: DynamicStart<'_, S::Mode>,
    end: f64,
    options: &Options,
    observer: &mut O,
) -> Result<DynamicRun<S::Mode>, RunError>
where
    M: Method,
    S: DynamicSystem,
    O: DynamicObserver<S::Mode>,
{
    let reversed = DynamicStart { s: reverse(start.s), ..start };
    let mut observer = Reversed(observer);
    match run_dynamic(method, &Reversed(system), reversed, reverse(end), options, &mut observer) {
        Ok(run) => Ok(DynamicRun { s: reverse(run.s), outcome: original(run.outcome), ..run }),
        Err(error) => Err(error.reversed()),
    }
}

/// A system as a function of τ = −s, or the observer of a run in τ that passes s on.
struct Reversed<T>(T);

impl<S: DynamicSystem> DynamicSystem for Reversed<&S> {
    type Mode = S::Mode;

    fn field(&self, mode: S::Mode, tau: f64, y: &[f64], slope: &mut [f64]) {
        self.0.field(mode, reverse(tau), y, slope);
        for slope in slope {
            *slope = -*slope;
        }
    }

    fn tolerances(&self) -> &[(f64, f64)] {
        self.0.tolerances()
    }

    fn guards(&self, mode: S::Mode) -> &[Guard] {
        self.0.guards(mode)
    }

    fn guard_values(&self, mode: S::Mode, tau: f64, y: &[f64], values: &mut [f64]) {
        self.0.guard_values(mode, reverse(tau), y, values);
    }

    fn counter(&self, mode: S::Mode, guard: usize) -> usize {
        self.0.counter(mode, guard)
    }

    fn schedule(&self, mode: S::Mode, guard: usize) -> Schedule<'_> {
        self.0.schedule(mode, guard).reversed()
    }

    fn rest(&self, mode: S::Mode, guard: usize, tau: f64, y: &mut [f64]) -> Option<S::Mode> {
        self.0.rest(mode, guard, reverse(tau), y)
    }

    fn transition(&self, mode: S::Mode, guard: usize, tau: f64, y: &mut [f64]) -> S::Mode {
        self.0.transition(mode, guard, reverse(tau), y)
    }
}

impl<O: DynamicObserver<Mode>, Mode: Copy> DynamicObserver<Mode> for Reversed<&mut O> {
    const WANTS_SEGMENTS: bool = O::WANTS_SEGMENTS;

    fn on_switch(&mut self, event: &DynamicEvent<'_, Mode>) {
        self.0.on_switch(&DynamicEvent { s: reverse(event.s), ..*event });
    }

    fn on_grazing(&mut self, grazing: &Grazing<Mode>) {
        self.0.on_grazing(&Grazing { s: reverse(grazing.s), ..*grazing });
    }

    fn on_pole(&mut self, pole: &Pole<Mode>) {
        self.0.on_pole(&Pole { s: reverse(pole.s), ..*pole });
    }

    fn on_preempted(&mut self, preempted: &Preempted<Mode>) {
        self.0.on_preempted(&Preempted { s: reverse(preempted.s), ..*preempted });
    }

    fn on_rest(&mut self, rest: &Rest<Mode>) {
        self.0.on_rest(&Rest { s: reverse(rest.s), ..*rest });
    }

    fn forget(&mut self, switches: usize) {
        self.0.forget(switches);
    }

    fn stops(&self, tau: f64) -> bool {
        self.0.stops(reverse(tau))
    }

    fn on_segment(&mut self, mode: Mode, dense: &DynamicDense<'_>) {
        self.0.on_segment(mode, &dense.reversed());
    }

    fn on_end(&mut self, mode: Mode, tau: f64, state: &[f64]) {
        self.0.on_end(mode, reverse(tau), state);
    }
}
