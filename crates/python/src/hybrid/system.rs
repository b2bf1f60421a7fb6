//! What the solver sees: modes as numbers, and functions that cannot fail.

use std::cell::Cell;
use std::sync::Arc;
use std::time::{Duration, Instant};

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use stickslip_solver::{DynamicSystem, Guard, Schedule};

use crate::hybrid::arguments::Clock;
use crate::hybrid::function::{Caller, Code, Function};
use crate::hybrid::modes::{Change, Mode, Source};
use crate::hybrid::numbers::{Problem, read};
use crate::hybrid::trouble::Trouble;

/// Calls after which the clock is looked at.
const CALLS: u64 = 64;
/// The time after which Ctrl-C is looked for.
pub const PAUSE: Duration = Duration::from_millis(50);

/// The highest order of a zero that is looked for.
const HIGHEST_ORDER: u32 = 6;

/// A system of functions that may fail.
pub struct System {
    modes: Arc<Vec<Mode>>,
    caller: Caller,
    trouble: Arc<Trouble>,
    /// Where the system is one of a family.
    at: Option<At>,
    /// The mode in which a function was called last.
    mode: Cell<usize>,
    /// Calls of right-hand sides, and of all functions.
    calls: (Cell<u64>, Cell<u64>),
    /// When Ctrl-C was looked for.
    looked: Cell<Instant>,
}

/// A member of a family of systems.
pub struct At {
    /// The two parameters.
    pub point: [f64; 2],
    /// The parameters of compiled functions.
    pub parameters: Vec<f64>,
}

impl System {
    pub fn new(
        modes: Arc<Vec<Mode>>,
        caller: Caller,
        trouble: Arc<Trouble>,
        at: Option<At>,
    ) -> Self {
        Self {
            modes,
            caller,
            trouble,
            at,
            mode: Cell::new(0),
            calls: (Cell::new(0), Cell::new(0)),
            looked: Cell::new(Instant::now()),
        }
    }

    /// Takes guards that are exactly 0 at the start, and whose zero is to be found out, for simple
    /// zeros. The modes must be those of this system alone.
    pub fn find_zeros(&mut self, mode: usize, t: f64, y: &[f64]) {
        if self.modes[mode].undeclared.is_empty() {
            return;
        }
        let mut values = vec![0.0; self.modes[mode].guards.len()];
        self.guard_values(mode, t, y, &mut values);
        let Some(modes) = Arc::get_mut(&mut self.modes) else { return };
        let Mode { guards, undeclared, .. } = &mut modes[mode];
        undeclared.retain(|&guard| values[guard] == 0.0);
        for &guard in &*undeclared {
            guards[guard] = guards[guard].from_zero(1);
        }
    }

    /// Takes the zero of a guard at the start for one of the next order. Returns whether it may be.
    pub fn raise_zero(&mut self, mode: usize, guard: usize) -> bool {
        let Some(modes) = Arc::get_mut(&mut self.modes) else { return false };
        let Mode { guards, undeclared, .. } = &mut modes[mode];
        let order = guards[guard].zero_order() + 1;
        let may_be = undeclared.contains(&guard) && order <= HIGHEST_ORDER;
        if may_be {
            guards[guard] = guards[guard].from_zero(order);
        }
        may_be
    }

    /// Whether no function needs the interpreter.
    pub fn is_compiled(&self) -> bool {
        self.modes.iter().all(Mode::is_compiled)
    }

    /// The mode in which a function was called last.
    pub fn last_mode(&self) -> usize {
        self.mode.get()
    }

    /// Calls of right-hand sides.
    pub fn calls(&self) -> u64 {
        self.calls.0.get()
    }

    /// What messages call the right-hand side of a mode.
    pub fn field_label(&self, mode: usize) -> &str {
        &self.modes[mode].field.label
    }

    /// What messages call a guard of a mode.
    pub fn guard_label(&self, mode: usize, guard: usize) -> &str {
        self.modes[mode].labels.get(guard).map_or("a guard", |label| label)
    }

    /// What has gone wrong so far, and what will.
    pub fn trouble(&self) -> &Arc<Trouble> {
        &self.trouble
    }

    /// Keeps a failure, with the parameters.
    fn fail(&self, error: PyErr, t: f64) {
        if let Some(At { point: [x, y], .. }) = self.at {
            Python::attach(|py| {
                let note = format!("with the parameters ({x:?}, {y:?}), at t = {t:?}");
                // Without the note it is the same exception.
                let _ = error.value(py).call_method1("add_note", (note,));
            });
        }
        self.trouble.fail(error);
    }

    /// Writes what `function` returns to `out`; NaN if it fails.
    fn evaluate(&self, function: &Function, t: f64, y: &[f64], out: &mut [f64], signed: bool) {
        self.look_for_signals(t);
        if !self.trouble.has_failed() {
            match &function.code {
                Code::Compiled(compiled) => {
                    let parameters = self.at.as_ref().map(|at| &at.parameters[..]);
                    return compiled.call(t, y, out, parameters);
                }
                Code::Python(callable) => {
                    self.call(function, callable, t, y, |result| read(result, out, signed));
                }
            }
        }
        if self.trouble.has_failed() {
            out.fill(f64::NAN);
        }
    }

    /// Calls a callable and gives what it returns to `read`. `None` if it fails. An interruption
    /// that only asks for an end does not spoil the call, which is repeated.
    fn call<T>(
        &self,
        function: &Function,
        callable: &Py<PyAny>,
        t: f64,
        y: &[f64],
        mut read: impl FnMut(&Bound<'_, PyAny>) -> Result<T, Problem>,
    ) -> Option<T> {
        Python::attach(|py| {
            loop {
                let problem = match self.caller.call(callable.bind(py), t, y, &mut read) {
                    Ok(found) => return Some(found),
                    Err(Problem::Raised(error)) => {
                        let Some(error) = self.trouble.postpone(error) else { continue };
                        Problem::Raised(error)
                    }
                    Err(problem) => problem,
                };
                self.fail(problem.exception(&function.label, t), t);
                return None;
            }
        })
    }

    /// Fails if Ctrl-C was pressed, and lets other threads run. Callables that are not written in
    /// Python do neither. It is done only now and then.
    fn look_for_signals(&self, t: f64) {
        let calls = self.calls.1.get() + 1;
        self.calls.1.set(calls);
        if calls.is_multiple_of(CALLS) && self.looked.get().elapsed() >= PAUSE {
            let looked = Python::attach(|py| {
                py.detach(std::thread::yield_now);
                py.check_signals()
            });
            if let Err(error) = looked
                && let Some(error) = self.trouble.postpone(error)
            {
                self.fail(error, t);
            }
            self.looked.set(Instant::now());
        }
    }

    /// The mode after `change` in `mode`, with the state written to `y`.
    pub fn change(&self, mode: usize, change: &Change, t: f64, y: &mut [f64]) -> usize {
        let (function, to) = match change {
            Change::Mode(to) => return to.unwrap_or(mode),
            Change::Reset(function, to) => {
                let before = y.to_vec();
                self.evaluate(function, t, &before, y, false);
                (function, to.unwrap_or(mode))
            }
            Change::Both(function) => (function, self.call_transition(function, mode, t, y)),
        };
        // A run of a family fails there, and others go on.
        if self.at.is_none()
            && !self.trouble.has_failed()
            && let Some(component) = y.iter().position(|value| !value.is_finite())
        {
            let error = PyValueError::new_err(format!(
                "{}, at t = {t:?}: component {component} of the state after is {:?}; expected a \
                 finite number",
                function.label, y[component]
            ));
            self.fail(error, t);
        }
        if self.trouble.has_failed() {
            y.fill(f64::NAN);
            return mode;
        }
        to
    }

    fn call_transition(&self, function: &Function, mode: usize, t: f64, y: &mut [f64]) -> usize {
        let Code::Python(callable) = &function.code else { return mode };
        if self.trouble.has_failed() {
            return mode;
        }
        let before = y.to_vec();
        let found = self.call(function, callable, t, &before, |result| {
            let (to, after): (Option<usize>, Option<Bound<'_, PyAny>>) = result.extract()?;
            after.map_or(Ok(()), |after| read(&after, y, false))?;
            Ok(to)
        });
        found.flatten().unwrap_or(mode)
    }

    /// The condition of the transition at a guard; NaN if it has none.
    pub fn condition(&self, mode: usize, guard: usize, t: f64, y: &[f64]) -> f64 {
        let mut value = [f64::NAN];
        if let Some(function) = &self.modes[mode].conditions[guard] {
            self.evaluate(function, t, y, &mut value, true);
        }
        value[0]
    }
}

impl DynamicSystem for System {
    type Mode = usize;

    fn field(&self, mode: usize, t: f64, y: &[f64], slope: &mut [f64]) {
        self.calls.0.set(self.calls.0.get() + 1);
        self.mode.set(mode);
        self.evaluate(&self.modes[mode].field, t, y, slope, false);
    }

    fn guards(&self, mode: usize) -> &[Guard] {
        &self.modes[mode].guards
    }

    fn guard_values(&self, mode: usize, t: f64, y: &[f64], values: &mut [f64]) {
        self.mode.set(mode);
        let mode = &self.modes[mode];
        if mode.gaps {
            values.fill(1.0);
        }
        for Source { function, first, count } in &mode.sources {
            self.evaluate(function, t, y, &mut values[*first..first + count], true);
        }
    }

    fn schedule(&self, mode: usize, guard: usize) -> Schedule<'_> {
        self.modes[mode].clocks[guard].as_ref().map_or(Schedule::NEVER, Clock::schedule)
    }

    fn rest(&self, mode: usize, guard: usize, t: f64, y: &mut [f64]) -> Option<usize> {
        let change = self.modes[mode].rests[guard].as_ref()?;
        Some(self.change(mode, change, t, y))
    }

    fn transition(&self, mode: usize, guard: usize, t: f64, y: &mut [f64]) -> usize {
        self.change(mode, &self.modes[mode].changes[guard], t, y)
    }
}
