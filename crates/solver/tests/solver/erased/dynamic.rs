//! Systems and observers of any dimension.

use std::fmt::Debug;

use stickslip_solver::{
    DynamicDense, DynamicEvent, DynamicObserver, DynamicRun, DynamicStart, DynamicSystem, Grazing,
    Guard, Method, Options, Pole, RunError,
};

/// As [`stickslip_solver::run_dynamic`].
pub fn run_dynamic<M: Method, S: DynamicSystem, O: DynamicObserver<S::Mode>>(
    method: M,
    system: &S,
    start: DynamicStart<'_, S::Mode>,
    end: f64,
    options: &Options,
    observer: &mut O,
) -> Result<DynamicRun<S::Mode>, RunError> {
    let system = Erased::<S::Mode>(system);
    if O::WANTS_SEGMENTS {
        let observer = &mut Watching::<S::Mode, true>(observer);
        stickslip_solver::run_dynamic(method, &system, start, end, options, observer)
    } else {
        let observer = &mut Watching::<S::Mode, false>(observer);
        stickslip_solver::run_dynamic(method, &system, start, end, options, observer)
    }
}

/// As [`stickslip_solver::run_dynamic_backwards`].
pub fn run_dynamic_backwards<M: Method, S: DynamicSystem, O: DynamicObserver<S::Mode>>(
    method: M,
    system: &S,
    start: DynamicStart<'_, S::Mode>,
    end: f64,
    options: &Options,
    observer: &mut O,
) -> Result<DynamicRun<S::Mode>, RunError> {
    let system = Erased::<S::Mode>(system);
    if O::WANTS_SEGMENTS {
        let observer = &mut Watching::<S::Mode, true>(observer);
        stickslip_solver::run_dynamic_backwards(method, &system, start, end, options, observer)
    } else {
        let observer = &mut Watching::<S::Mode, false>(observer);
        stickslip_solver::run_dynamic_backwards(method, &system, start, end, options, observer)
    }
}

/// What a system consists of.
trait Parts<Mode> {
    fn field(&self, mode: Mode, s: f64, y: &[f64], slope: &mut [f64]);
    fn guards(&self, mode: Mode) -> &[Guard];
    fn guard_values(&self, mode: Mode, s: f64, y: &[f64], values: &mut [f64]);
    fn transition(&self, mode: Mode, guard: usize, s: f64, y: &mut [f64]) -> Mode;
}

impl<S: DynamicSystem> Parts<S::Mode> for S {
    fn field(&self, mode: S::Mode, s: f64, y: &[f64], slope: &mut [f64]) {
        DynamicSystem::field(self, mode, s, y, slope);
    }

    fn guards(&self, mode: S::Mode) -> &[Guard] {
        DynamicSystem::guards(self, mode)
    }

    fn guard_values(&self, mode: S::Mode, s: f64, y: &[f64], values: &mut [f64]) {
        DynamicSystem::guard_values(self, mode, s, y, values);
    }

    fn transition(&self, mode: S::Mode, guard: usize, s: f64, y: &mut [f64]) -> S::Mode {
        DynamicSystem::transition(self, mode, guard, s, y)
    }
}

/// Any system of modes of one type.
struct Erased<'a, Mode>(&'a dyn Parts<Mode>);

impl<Mode: Copy + PartialEq + Debug> DynamicSystem for Erased<'_, Mode> {
    type Mode = Mode;

    fn field(&self, mode: Mode, s: f64, y: &[f64], slope: &mut [f64]) {
        self.0.field(mode, s, y, slope);
    }

    fn guards(&self, mode: Mode) -> &[Guard] {
        self.0.guards(mode)
    }

    fn guard_values(&self, mode: Mode, s: f64, y: &[f64], values: &mut [f64]) {
        self.0.guard_values(mode, s, y, values);
    }

    fn transition(&self, mode: Mode, guard: usize, s: f64, y: &mut [f64]) -> Mode {
        self.0.transition(mode, guard, s, y)
    }
}

/// What an observer does.
trait Sees<Mode> {
    fn on_switch(&mut self, event: &DynamicEvent<'_, Mode>);
    fn on_grazing(&mut self, grazing: &Grazing<Mode>);
    fn on_pole(&mut self, pole: &Pole<Mode>);
    fn stops(&self) -> bool;
    fn on_segment(&mut self, mode: Mode, dense: &DynamicDense<'_>);
    fn on_end(&mut self, mode: Mode, s: f64, state: &[f64]);
}

/// Passes calls of a trait on to what stands behind a reference.
macro_rules! tell {
    ([$($to:tt)+], |$self:ident| $inner:expr) => {
        fn on_switch(&mut $self, event: &DynamicEvent<'_, Mode>) {
            <$($to)+>::on_switch($inner, event);
        }

        fn on_grazing(&mut $self, grazing: &Grazing<Mode>) {
            <$($to)+>::on_grazing($inner, grazing);
        }

        fn on_pole(&mut $self, pole: &Pole<Mode>) {
            <$($to)+>::on_pole($inner, pole);
        }

        fn stops(&$self) -> bool {
            <$($to)+>::stops($inner)
        }

        fn on_segment(&mut $self, mode: Mode, dense: &DynamicDense<'_>) {
            <$($to)+>::on_segment($inner, mode, dense);
        }

        fn on_end(&mut $self, mode: Mode, s: f64, state: &[f64]) {
            <$($to)+>::on_end($inner, mode, s, state);
        }
    };
}

impl<O: DynamicObserver<Mode>, Mode> Sees<Mode> for O {
    tell!([O as DynamicObserver<Mode>], |self| self);
}

/// Any observer of modes of one type.
struct Watching<'a, Mode, const WANTS_SEGMENTS: bool>(&'a mut dyn Sees<Mode>);

impl<Mode, const WANTS_SEGMENTS: bool> DynamicObserver<Mode>
    for Watching<'_, Mode, WANTS_SEGMENTS>
{
    const WANTS_SEGMENTS: bool = WANTS_SEGMENTS;

    tell!([dyn Sees<Mode>], |self| self.0);
}
