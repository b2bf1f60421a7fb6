//! What the solver sees: modes as numbers, and functions that cannot fail.

use std::cell::{Cell, RefCell};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use stickslip_solver::{Direction, DynamicSystem, Guard};

use crate::hybrid::arguments::{ChangeArguments, ModeArguments, SourceArguments};
use crate::hybrid::function::{Caller, Code, Function};
use crate::hybrid::numbers::{Problem, read};

/// Calls after which the clock is looked at.
const CALLS: u64 = 64;
/// The time after which Ctrl-C is looked for.
const PAUSE: Duration = Duration::from_millis(50);

/// The highest order of a zero that is looked for.
const HIGHEST_ORDER: u32 = 6;

/// A system of functions that may fail.
///
/// The solver knows no failures. The first one is kept; from then on every value is NaN and nothing
/// is called any more, so that the run ends at once.
pub struct System {
    modes: Vec<Mode>,
    caller: Caller,
    failure: RefCell<Option<PyErr>>,
    failed: Arc<AtomicBool>,
    /// The mode in which a function was called last.
    mode: Cell<usize>,
    /// Calls of right-hand sides, and of all functions.
    calls: (Cell<u64>, Cell<u64>),
    /// When Ctrl-C was looked for.
    looked: Cell<Instant>,
}

struct Mode {
    field: Function,
    guards: Vec<Guard>,
    labels: Vec<String>,
    sources: Vec<Source>,
    changes: Vec<Change>,
    /// The guards that may start from a zero whose order is to be found out.
    undeclared: Vec<usize>,
    /// Whether some of the guards are off.
    gaps: bool,
}

/// A function that returns the values of `count` guards from `first` on.
struct Source {
    function: Function,
    first: usize,
    count: usize,
}

/// What follows when a guard fires.
enum Change {
    /// The state goes on, in this mode or in another one.
    Mode(Option<usize>),
    /// The function returns the state after.
    Reset(Function, Option<usize>),
    /// The function returns the mode, or `None`, and the state, or `None`.
    Both(Function),
}

impl System {
    pub fn new(modes: Vec<ModeArguments>, args: &Bound<'_, PyTuple>) -> PyResult<Self> {
        Ok(Self {
            modes: modes.into_iter().map(Mode::new).collect::<PyResult<_>>()?,
            caller: Caller::new(args),
            failure: RefCell::new(None),
            failed: Arc::new(AtomicBool::new(false)),
            mode: Cell::new(0),
            calls: (Cell::new(0), Cell::new(0)),
            looked: Cell::new(Instant::now()),
        })
    }

    /// Takes guards that are exactly 0 at the start, and whose zero is to be found out, for simple
    /// zeros.
    pub fn find_zeros(&mut self, mode: usize, t: f64, y: &[f64]) {
        if self.modes[mode].undeclared.is_empty() {
            return;
        }
        let mut values = vec![0.0; self.modes[mode].guards.len()];
        self.guard_values(mode, t, y, &mut values);
        let Mode { guards, undeclared, .. } = &mut self.modes[mode];
        undeclared.retain(|&guard| values[guard] == 0.0);
        for &guard in &*undeclared {
            guards[guard] = guards[guard].from_zero(1);
        }
    }

    /// Takes the zero of a guard at the start for one of the next order. Returns whether it may be.
    pub fn raise_zero(&mut self, mode: usize, guard: usize) -> bool {
        let Mode { guards, undeclared, .. } = &mut self.modes[mode];
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

    /// Becomes true as soon as a function has failed.
    pub fn failed(&self) -> Arc<AtomicBool> {
        self.failed.clone()
    }

    /// The first failure.
    pub fn take_failure(&self) -> Option<PyErr> {
        self.failure.borrow_mut().take()
    }

    fn has_failed(&self) -> bool {
        self.failed.load(Ordering::Relaxed)
    }

    fn fail(&self, error: PyErr) {
        if !self.failed.swap(true, Ordering::Relaxed) {
            *self.failure.borrow_mut() = Some(error);
        }
    }

    /// Writes what `function` returns to `out`; NaN if it fails.
    fn evaluate(&self, function: &Function, t: f64, y: &[f64], out: &mut [f64], signed: bool) {
        self.look_for_signals();
        if !self.has_failed() {
            match &function.code {
                Code::Compiled(compiled) => return compiled.call(t, y, out),
                Code::Python(callable) => Python::attach(|py| {
                    let read = |result: &Bound<'_, PyAny>| read(result, out, signed);
                    if let Err(problem) = self.caller.call(callable.bind(py), t, y, read) {
                        self.fail(problem.exception(&function.label, t));
                    }
                }),
            }
        }
        if self.has_failed() {
            out.fill(f64::NAN);
        }
    }

    /// Fails if Ctrl-C was pressed, and lets other threads run. Callables that are not written in
    /// Python do neither. It is done only now and then.
    fn look_for_signals(&self) {
        let calls = self.calls.1.get() + 1;
        self.calls.1.set(calls);
        if calls.is_multiple_of(CALLS) && self.looked.get().elapsed() >= PAUSE {
            let looked = Python::attach(|py| {
                py.detach(std::thread::yield_now);
                py.check_signals()
            });
            if let Err(error) = looked {
                self.fail(error);
            }
            self.looked.set(Instant::now());
        }
    }

    /// The mode after a guard has fired, with the state written to `y`.
    fn change(&self, mode: usize, change: &Change, t: f64, y: &mut [f64]) -> usize {
        let (function, to) = match change {
            Change::Mode(to) => return to.unwrap_or(mode),
            Change::Reset(function, to) => {
                let before = y.to_vec();
                self.evaluate(function, t, &before, y, false);
                (function, to.unwrap_or(mode))
            }
            Change::Both(function) => (function, self.call_transition(function, mode, t, y)),
        };
        if !self.has_failed()
            && let Some(component) = y.iter().position(|value| !value.is_finite())
        {
            self.fail(PyValueError::new_err(format!(
                "{}, at t = {t:?}: component {component} of the state after is {:?}; expected a \
                 finite number",
                function.label, y[component]
            )));
        }
        if self.has_failed() {
            y.fill(f64::NAN);
            return mode;
        }
        to
    }

    fn call_transition(&self, function: &Function, mode: usize, t: f64, y: &mut [f64]) -> usize {
        let Code::Python(callable) = &function.code else { return mode };
        if self.has_failed() {
            return mode;
        }
        let found = Python::attach(|py| {
            let before = y.to_vec();
            self.caller.call(callable.bind(py), t, &before, |result| {
                let (to, after): (Option<usize>, Option<Bound<'_, PyAny>>) = result.extract()?;
                after.map_or(Ok(()), |after| read(&after, y, false))?;
                Ok::<_, Problem>(to)
            })
        });
        match found {
            Ok(to) => to.unwrap_or(mode),
            Err(problem) => {
                Python::attach(|_| self.fail(problem.exception(&function.label, t)));
                mode
            }
        }
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

    fn transition(&self, mode: usize, guard: usize, t: f64, y: &mut [f64]) -> usize {
        self.change(mode, &self.modes[mode].changes[guard], t, y)
    }
}

impl Mode {
    fn new(ModeArguments(field, guards, sources): ModeArguments) -> PyResult<Self> {
        let mut mode = Self {
            field: Function::new(field)?,
            guards: Vec::new(),
            labels: Vec::new(),
            sources: Vec::new(),
            changes: Vec::new(),
            undeclared: Vec::new(),
            gaps: false,
        };
        for arguments in guards {
            let guard = arguments.guard()?;
            mode.gaps |= guard.direction() == Direction::Off;
            if arguments.2.is_none() {
                mode.undeclared.push(mode.guards.len());
            }
            mode.guards.push(guard);
            mode.labels.push(arguments.0);
            mode.changes.push(Change::new(arguments.6)?);
        }
        for SourceArguments(function, first, count) in sources {
            mode.sources.push(Source { function: Function::new(function)?, first, count });
        }
        Ok(mode)
    }

    fn is_compiled(&self) -> bool {
        let changes = self.changes.iter().all(|change| match change {
            Change::Mode(_) => true,
            Change::Reset(function, _) | Change::Both(function) => function.is_compiled(),
        });
        changes
            && self.field.is_compiled()
            && self.sources.iter().all(|source| source.function.is_compiled())
    }
}

impl Change {
    fn new(ChangeArguments(to, function, both): ChangeArguments) -> PyResult<Self> {
        Ok(match function {
            None => Self::Mode(to),
            Some(function) if both => Self::Both(Function::new(function)?),
            Some(function) => Self::Reset(Function::new(function)?, to),
        })
    }
}
