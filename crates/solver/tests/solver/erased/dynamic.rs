//! Systems and observers of any dimension.

use stickslip_solver::dynamic::{
    DynamicDense, DynamicEvent, DynamicObserver, DynamicRun, DynamicStart, DynamicSystem,
};
use stickslip_solver::{Grazing, Guard, Method, Options, RunError, Schedule, hybrid::Pole};

use super::modes::Modes;

/// Calls a function with an erased system, start and observer, and gives the end its mode back.
macro_rules! with_numbers {
    ($run:path, $method:ident, $system:ident, $start:ident, $end:ident, $options:ident, $observer:ident) => {{
        let modes = &Modes::default();
        let system = &Erased(&Numbered { system: $system, modes });
        let DynamicStart { mode, s, state } = $start;
        let start = DynamicStart { mode: modes.number(mode), s, state };
        let told = &mut Told { observer: $observer, modes };
        let run = if O::WANTS_SEGMENTS {
            $run($method, system, start, $end, $options, &mut Watching::<true>(told))
        } else {
            $run($method, system, start, $end, $options, &mut Watching::<false>(told))
        };
        run.map(|run| {
            let DynamicRun { outcome, s, mode, state, decided, statistics } = run;
            DynamicRun { outcome, s, mode: modes.mode(mode), state, decided, statistics }
        })
    }};
}

/// As [`stickslip_solver::dynamic::run_dynamic`].
pub fn run_dynamic<M: Method, S: DynamicSystem, O: DynamicObserver<S::Mode>>(
    method: M,
    system: &S,
    start: DynamicStart<'_, S::Mode>,
    end: f64,
    options: &Options,
    observer: &mut O,
) -> Result<DynamicRun<S::Mode>, RunError> {
    with_numbers!(
        stickslip_solver::dynamic::run_dynamic,
        method,
        system,
        start,
        end,
        options,
        observer
    )
}

/// As [`stickslip_solver::dynamic::run_dynamic_backwards`].
pub fn run_dynamic_backwards<M: Method, S: DynamicSystem, O: DynamicObserver<S::Mode>>(
    method: M,
    system: &S,
    start: DynamicStart<'_, S::Mode>,
    end: f64,
    options: &Options,
    observer: &mut O,
) -> Result<DynamicRun<S::Mode>, RunError> {
    with_numbers!(
        stickslip_solver::dynamic::run_dynamic_backwards,
        method,
        system,
        start,
        end,
        options,
        observer
    )
}

/// What a system consists of, with numbers for its modes.
trait Parts {
    fn field(&self, mode: usize, s: f64, y: &[f64], slope: &mut [f64]);
    fn guards(&self, mode: usize) -> &[Guard];
    fn guard_values(&self, mode: usize, s: f64, y: &[f64], values: &mut [f64]);
    fn transition(&self, mode: usize, guard: usize, s: f64, y: &mut [f64]) -> usize;
    fn schedule(&self, mode: usize, guard: usize) -> Schedule<'_>;
    fn rest(&self, mode: usize, guard: usize, s: f64, y: &mut [f64]) -> Option<usize>;
}

/// A system whose modes have numbers.
struct Numbered<'a, S: DynamicSystem> {
    system: &'a S,
    modes: &'a Modes<S::Mode>,
}

impl<S: DynamicSystem> Parts for Numbered<'_, S> {
    fn field(&self, mode: usize, s: f64, y: &[f64], slope: &mut [f64]) {
        self.system.field(self.modes.mode(mode), s, y, slope);
    }

    fn guards(&self, mode: usize) -> &[Guard] {
        self.system.guards(self.modes.mode(mode))
    }

    fn guard_values(&self, mode: usize, s: f64, y: &[f64], values: &mut [f64]) {
        self.system.guard_values(self.modes.mode(mode), s, y, values);
    }

    fn transition(&self, mode: usize, guard: usize, s: f64, y: &mut [f64]) -> usize {
        self.modes.number(self.system.transition(self.modes.mode(mode), guard, s, y))
    }

    fn schedule(&self, mode: usize, guard: usize) -> Schedule<'_> {
        self.system.schedule(self.modes.mode(mode), guard)
    }

    fn rest(&self, mode: usize, guard: usize, s: f64, y: &mut [f64]) -> Option<usize> {
        self.system.rest(self.modes.mode(mode), guard, s, y).map(|mode| self.modes.number(mode))
    }
}

/// Any system.
struct Erased<'a>(&'a dyn Parts);

impl DynamicSystem for Erased<'_> {
    type Mode = usize;

    fn field(&self, mode: usize, s: f64, y: &[f64], slope: &mut [f64]) {
        self.0.field(mode, s, y, slope);
    }

    fn guards(&self, mode: usize) -> &[Guard] {
        self.0.guards(mode)
    }

    fn guard_values(&self, mode: usize, s: f64, y: &[f64], values: &mut [f64]) {
        self.0.guard_values(mode, s, y, values);
    }

    fn transition(&self, mode: usize, guard: usize, s: f64, y: &mut [f64]) -> usize {
        self.0.transition(mode, guard, s, y)
    }

    fn schedule(&self, mode: usize, guard: usize) -> Schedule<'_> {
        self.0.schedule(mode, guard)
    }

    fn rest(&self, mode: usize, guard: usize, s: f64, y: &mut [f64]) -> Option<usize> {
        self.0.rest(mode, guard, s, y)
    }
}

/// What an observer does, with numbers for modes.
trait Sees {
    fn on_switch(&mut self, event: &DynamicEvent<'_, usize>);
    fn on_grazing(&mut self, grazing: &Grazing<usize>);
    fn on_pole(&mut self, pole: &Pole<usize>);
    fn forget(&mut self, switches: usize);
    fn stops(&self, s: f64) -> bool;
    fn on_segment(&mut self, mode: usize, dense: &DynamicDense<'_>);
    fn on_end(&mut self, mode: usize, s: f64, state: &[f64]);
}

/// An observer that is told of modes with numbers.
struct Told<'a, O, Mode> {
    observer: &'a mut O,
    modes: &'a Modes<Mode>,
}

impl<O: DynamicObserver<Mode>, Mode: Copy + PartialEq> Sees for Told<'_, O, Mode> {
    fn on_switch(&mut self, event: &DynamicEvent<'_, usize>) {
        let DynamicEvent { s, guard, simultaneous, flatness, jump, from, to, before, after } =
            *event;
        let [from, to] = [from, to].map(|mode| self.modes.mode(mode));
        self.observer.on_switch(&DynamicEvent {
            s,
            guard,
            simultaneous,
            flatness,
            jump,
            from,
            to,
            before,
            after,
        });
    }

    fn on_grazing(&mut self, grazing: &Grazing<usize>) {
        self.observer.on_grazing(&self.modes.grazing(grazing));
    }

    fn on_pole(&mut self, pole: &Pole<usize>) {
        self.observer.on_pole(&self.modes.pole(pole));
    }

    fn forget(&mut self, switches: usize) {
        self.observer.forget(switches);
    }

    fn stops(&self, s: f64) -> bool {
        self.observer.stops(s)
    }

    fn on_segment(&mut self, mode: usize, dense: &DynamicDense<'_>) {
        self.observer.on_segment(self.modes.mode(mode), dense);
    }

    fn on_end(&mut self, mode: usize, s: f64, state: &[f64]) {
        self.observer.on_end(self.modes.mode(mode), s, state);
    }
}

/// Any observer.
struct Watching<'a, const WANTS_SEGMENTS: bool>(&'a mut dyn Sees);

impl<const WANTS_SEGMENTS: bool> DynamicObserver<usize> for Watching<'_, WANTS_SEGMENTS> {
    const WANTS_SEGMENTS: bool = WANTS_SEGMENTS;

    fn on_switch(&mut self, event: &DynamicEvent<'_, usize>) {
        self.0.on_switch(event);
    }

    fn on_grazing(&mut self, grazing: &Grazing<usize>) {
        self.0.on_grazing(grazing);
    }

    fn on_pole(&mut self, pole: &Pole<usize>) {
        self.0.on_pole(pole);
    }

    fn forget(&mut self, switches: usize) {
        self.0.forget(switches);
    }

    fn stops(&self, s: f64) -> bool {
        self.0.stops(s)
    }

    fn on_segment(&mut self, mode: usize, dense: &DynamicDense<'_>) {
        self.0.on_segment(mode, dense);
    }

    fn on_end(&mut self, mode: usize, s: f64, state: &[f64]) {
        self.0.on_end(mode, s, state);
    }
}
