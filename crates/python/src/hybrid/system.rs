//! What the solver sees: modes as numbers, and functions that cannot fail.

use std::cell::{Cell, RefCell};
use std::sync::Arc;
use std::time::Instant;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use stickslip_solver::sliding::{SampledFilippov, SwitchedDynamic};
use stickslip_solver::{Guard, Schedule};

use crate::hybrid::arguments::Clock;
use crate::hybrid::function::{Caller, Code, Function, Input};
use crate::hybrid::modes::{After, Change, Mode, Parts, Source};
use crate::hybrid::numbers::{Problem, read};
use crate::hybrid::regimes::Regimes;
use crate::hybrid::trouble::Trouble;
use crate::parallel::PAUSE;

/// Calls after which the clock is looked at.
const CALLS: u64 = 64;
/// The highest order of a zero that is looked for.
const HIGHEST_ORDER: u32 = 6;

/// What the solver runs: without surfaces, it is the system itself.
pub type Sliding = SampledFilippov<System>;

/// A system of functions that may fail.
pub struct System {
    parts: Arc<Parts>,
    /// What the solver takes for modes.
    regimes: RefCell<Regimes>,
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
    /// Tolerances of components, if these have their own.
    tolerances: Vec<(f64, f64)>,
}

/// A member of a family of systems.
pub struct At {
    /// The two parameters.
    pub point: [f64; 2],
    /// The parameters of compiled functions.
    pub parameters: Vec<f64>,
}

impl System {
    pub fn new(parts: Arc<Parts>, caller: Caller, trouble: Arc<Trouble>, at: Option<At>) -> Self {
        let regimes = RefCell::new(Regimes::new(parts.variables.len()));
        Self {
            parts,
            regimes,
            caller,
            trouble,
            at,
            mode: Cell::new(0),
            calls: (Cell::new(0), Cell::new(0)),
            looked: Cell::new(Instant::now()),
            tolerances: Vec::new(),
        }
    }

    /// The system with tolerances for its first components.
    pub fn with_tolerances(self, tolerances: Vec<(f64, f64)>) -> Self {
        Self { tolerances, ..self }
    }

    /// The regime at the start of a run in `mode`.
    pub fn first(&self, mode: usize) -> usize {
        self.regimes.borrow_mut().number(mode, &self.parts.variables)
    }

    /// The mode of a regime, and the values of its variables.
    pub fn regime(&self, regime: usize) -> (usize, Vec<f64>) {
        let regimes = self.regimes.borrow();
        (regimes.mode(regime), regimes.values(regime).to_vec())
    }

    /// The mode of a regime.
    fn mode_of(&self, regime: usize) -> &Mode {
        &self.parts.modes[self.regimes.borrow().mode(regime)]
    }

    /// Takes guards that are exactly 0 at the start, and whose zero is to be found out, for simple
    /// zeros. The modes must be those of this system alone.
    pub fn find_zeros(&mut self, mode: usize, t: f64, y: &[f64]) {
        if self.parts.modes[mode].undeclared.is_empty() {
            return;
        }
        let mut values = vec![0.0; self.parts.modes[mode].guards.len()];
        self.guard_values(self.first(mode), t, y, &mut values);
        let Some(parts) = Arc::get_mut(&mut self.parts) else { return };
        let Mode { guards, undeclared, .. } = &mut parts.modes[mode];
        undeclared.retain(|&guard| values[guard] == 0.0);
        for &guard in &*undeclared {
            guards[guard] = guards[guard].from_zero(1);
        }
    }

    /// Takes the zero of a guard at the start for one of the next order. Returns whether it may be.
    pub fn raise_zero(&mut self, mode: usize, guard: usize) -> bool {
        let Some(parts) = Arc::get_mut(&mut self.parts) else { return false };
        let Mode { guards, undeclared, .. } = &mut parts.modes[mode];
        let order = guards[guard].zero_order() + 1;
        let may_be = undeclared.contains(&guard) && order <= HIGHEST_ORDER;
        if may_be {
            guards[guard] = guards[guard].from_zero(order);
        }
        may_be
    }

    /// Whether no function needs the interpreter.
    pub fn is_compiled(&self) -> bool {
        self.parts.is_compiled()
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
        &self.parts.modes[mode].field.label
    }

    /// What messages call a guard of a mode, where those of surfaces come first.
    pub fn guard_label(&self, mode: usize, guard: usize) -> &str {
        let surfaces = &self.parts.surfaces;
        let label = match guard.checked_sub(2 * surfaces.len()) {
            Some(guard) => self.parts.modes[mode].labels.get(guard),
            None => Some(&surfaces[guard / 2].label),
        };
        label.map_or("a guard", |label| label)
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

    /// Writes what `function` returns in a regime to `out`; NaN if it fails.
    fn evaluate(
        &self,
        function: &Function,
        regime: usize,
        (t, y): (f64, &[f64]),
        out: &mut [f64],
        signed: bool,
    ) {
        self.evaluate_with(function, regime, &[], (t, y), out, signed);
    }

    /// As [`Self::evaluate`], with signs of surfaces.
    fn evaluate_with(
        &self,
        function: &Function,
        regime: usize,
        signs: &[f64],
        (t, y): (f64, &[f64]),
        out: &mut [f64],
        signed: bool,
    ) {
        self.look_for_signals(t);
        if !self.trouble.has_failed() {
            match &function.code {
                Code::Compiled(compiled) => {
                    let parameters = self.at.as_ref().map(|at| &at.parameters[..]);
                    let regimes = self.regimes.borrow();
                    let variables = regimes.values(regime);
                    if variables.is_empty() && signs.is_empty() {
                        compiled.call(t, y, out, parameters);
                    } else {
                        compiled.call(t, &[y, variables, signs].concat(), out, parameters);
                    }
                    return;
                }
                Code::Python(callable) => {
                    let at = (regime, signs, t, y);
                    self.call(function, callable, at, |result| read(result, out, signed));
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
        (regime, signs, t, y): (usize, &[f64], f64, &[f64]),
        mut read: impl FnMut(&Bound<'_, PyAny>) -> Result<T, Problem>,
    ) -> Option<T> {
        // A callable may run this system again, so that nothing stays borrowed.
        let variables = match self.parts.names.variables {
            Some(_) => self.regimes.borrow().values(regime).to_vec(),
            None => Vec::new(),
        };
        let input = Input { t, y, variables: (regime, &variables), signs };
        Python::attach(|py| {
            loop {
                let called =
                    self.caller.call(callable.bind(py), &self.parts.names, input, &mut read);
                let problem = match called {
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

    /// The number that a condition returns; NaN if it fails.
    pub fn number(&self, condition: &Function, regime: usize, t: f64, y: &[f64]) -> f64 {
        let mut value = [f64::NAN];
        self.evaluate(condition, regime, (t, y), &mut value, true);
        value[0]
    }

    /// The regime after `change` in `regime`, with the state written to `y`.
    pub fn change(&self, regime: usize, change: &Change, t: f64, y: &mut [f64]) -> usize {
        let mode = self.regimes.borrow().mode(regime);
        let before = y.to_vec();
        let mut variables = self.regimes.borrow().values(regime).to_vec();
        if let Some(sets) = &change.sets {
            self.evaluate(sets, regime, (t, &before), &mut variables, false);
            self.expect_finite(sets, t, ("variables", &variables));
        }
        let to = match &change.after {
            After::Mode(to) => to.unwrap_or(mode),
            After::Reset(function, to) => {
                self.evaluate(function, regime, (t, &before), y, false);
                self.expect_finite(function, t, ("state", y));
                to.unwrap_or(mode)
            }
            After::Both(function) => {
                let to = self.call_transition(function, (regime, mode), t, y);
                self.expect_finite(function, t, ("state", y));
                to
            }
        };
        if self.trouble.has_failed() {
            y.fill(f64::NAN);
            return regime;
        }
        self.regimes.borrow_mut().number(to, &variables)
    }

    /// Fails if a number that a transition has returned is not finite. A run of a family fails
    /// there, and others go on.
    fn expect_finite(&self, function: &Function, t: f64, (what, values): (&str, &[f64])) {
        if self.at.is_none()
            && !self.trouble.has_failed()
            && let Some(component) = values.iter().position(|value| !value.is_finite())
        {
            let error = PyValueError::new_err(format!(
                "{}, at t = {t:?}: component {component} of the {what} after is {:?}; expected a \
                 finite number",
                function.label, values[component]
            ));
            self.fail(error, t);
        }
    }

    fn call_transition(
        &self,
        function: &Function,
        (regime, mode): (usize, usize),
        t: f64,
        y: &mut [f64],
    ) -> usize {
        let Code::Python(callable) = &function.code else { return mode };
        if self.trouble.has_failed() {
            return mode;
        }
        let before = y.to_vec();
        let found = self.call(function, callable, (regime, &[], t, &before), |result| {
            let (to, after): (Option<usize>, Option<Bound<'_, PyAny>>) = result.extract()?;
            after.map_or(Ok(()), |after| read(&after, y, false))?;
            Ok(to)
        });
        found.flatten().unwrap_or(mode)
    }
}

impl SwitchedDynamic for System {
    /// A regime.
    type Mode = usize;

    fn count(&self) -> usize {
        self.parts.surfaces.len()
    }

    fn tolerances(&self) -> &[(f64, f64)] {
        &self.tolerances
    }

    fn field(&self, regime: usize, signs: &[f64], t: f64, y: &[f64], slope: &mut [f64]) {
        self.calls.0.set(self.calls.0.get() + 1);
        self.mode.set(self.regimes.borrow().mode(regime));
        let field = &self.mode_of(regime).field;
        self.evaluate_with(field, regime, signs, (t, y), slope, false);
    }

    fn surfaces(&self, regime: usize, t: f64, y: &[f64], values: &mut [f64]) {
        for (surface, value) in self.parts.surfaces.iter().zip(values.chunks_exact_mut(1)) {
            self.evaluate(surface, regime, (t, y), value, true);
        }
    }

    fn guards(&self, regime: usize) -> &[Guard] {
        &self.mode_of(regime).guards
    }

    fn guard_values(&self, regime: usize, t: f64, y: &[f64], values: &mut [f64]) {
        self.mode.set(self.regimes.borrow().mode(regime));
        let mode = self.mode_of(regime);
        if mode.gaps {
            values.fill(1.0);
        }
        for Source { function, places } in &mode.sources {
            match places[..] {
                // The usual case needs no copy.
                [first, .., last] if last + 1 == first + places.len() => {
                    self.evaluate(function, regime, (t, y), &mut values[first..=last], true);
                }
                [place] => {
                    self.evaluate(function, regime, (t, y), &mut values[place..=place], true);
                }
                _ => {
                    let mut found = vec![1.0; places.len()];
                    self.evaluate(function, regime, (t, y), &mut found, true);
                    for (&place, value) in places.iter().zip(found) {
                        values[place] = value;
                    }
                }
            }
        }
    }

    fn schedule(&self, regime: usize, guard: usize) -> Schedule<'_> {
        self.mode_of(regime).clocks[guard].as_ref().map_or(Schedule::NEVER, Clock::schedule)
    }

    fn rest(&self, regime: usize, guard: usize, t: f64, y: &mut [f64]) -> Option<usize> {
        let change = self.mode_of(regime).rests[guard].as_ref()?;
        Some(self.change(regime, change, t, y))
    }

    fn transition(&self, regime: usize, guard: usize, t: f64, y: &mut [f64]) -> usize {
        self.change(regime, &self.mode_of(regime).changes[guard], t, y)
    }

    /// The condition of the transition at a guard; NaN if it has none.
    fn transition_condition(&self, regime: usize, guard: usize, t: f64, y: &[f64]) -> f64 {
        let condition = &self.mode_of(regime).conditions[guard];
        condition.as_ref().map_or(f64::NAN, |function| self.number(function, regime, t, y))
    }
}
