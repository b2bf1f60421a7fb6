//! A system with numbers for its parameters, as the solver sees it.

mod whole;

use smallvec::SmallVec;
use stickslip_number::Number;
use stickslip_solver::{
    Direction, DynamicStart, Guard, InvalidTimes, ReadableDynamic, Schedule, Times,
};
use thiserror::Error;

use crate::graph::{Formula, Variable};
use crate::program::{Inputs, Program};
use crate::system::{Next, Rule, System, Trigger};

/// A system that can run.
#[derive(Clone, Debug)]
pub struct Runnable {
    modes: Vec<Mode>,
    first: usize,
    start: f64,
    end: f64,
    state: Vec<f64>,
}

#[derive(Clone, Debug)]
struct Mode {
    slopes: Program,
    guards: Vec<Guard>,
    values: Program,
    /// The components that guards read, none if these are all.
    reads: Vec<usize>,
    reactions: Vec<Reaction>,
}

/// What happens when a guard fires.
#[derive(Clone, Debug)]
struct Reaction {
    schedule: Ticks,
    changed: Vec<usize>,
    changes: Program,
    next: Next,
    condition: Program,
}

#[derive(Clone, Debug)]
enum Ticks {
    Never,
    At(Times),
    Every(f64, f64),
}

/// Why a system cannot run with some parameters.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum InvalidParameters {
    /// There are more or fewer than the system has.
    #[error("there are {found} parameters; expected {expected}: {names}")]
    Count {
        /// How many there are.
        found: usize,
        /// How many the system has.
        expected: usize,
        /// Their names.
        names: String,
    },
    /// A parameter is not a number.
    #[error("{name} = {value}; expected a finite number")]
    NotFinite {
        /// The name of the parameter.
        name: String,
        /// Its value.
        value: f64,
    },
    /// What parameters make is not a number.
    #[error("{what} is {value}; expected {expected}")]
    Value {
        /// What is computed from them.
        what: String,
        /// Its value.
        value: f64,
        /// What it must be.
        expected: &'static str,
    },
}

impl System {
    /// The values that parameters have unless others are given.
    #[must_use]
    pub fn values(&self) -> Vec<f64> {
        self.parameters.iter().map(|parameter| parameter.value).collect()
    }

    /// Whether a rule ends runs.
    #[must_use]
    pub fn ends_itself(&self) -> bool {
        self.modes.iter().flat_map(|mode| &mode.rules).any(|rule| rule.ends_after > 0)
    }

    /// The system with numbers for its parameters.
    ///
    /// # Errors
    /// [`InvalidParameters`] if their number is wrong, if one is not finite, or if a start, an end
    /// or a time of a rule is not a number with them.
    pub fn with(&self, parameters: &[f64]) -> Result<Runnable, InvalidParameters> {
        let names = || self.parameters.iter().map(|it| it.name.as_str()).collect::<Vec<_>>();
        if parameters.len() != self.parameters.len() {
            let (found, expected) = (parameters.len(), self.parameters.len());
            return Err(InvalidParameters::Count { found, expected, names: names().join(", ") });
        }
        if let Some((it, &value)) =
            self.parameters.iter().zip(parameters).find(|(_, value)| !value.is_finite())
        {
            return Err(InvalidParameters::NotFinite { name: it.name.clone(), value });
        }
        whole::require(self)?;
        let compiler = Compiler { system: self, parameters };
        let end = self.end.map(|end| compiler.number(end, || "the end".to_owned()));
        let start = self.start.map(|start| compiler.number(start, || "the start".to_owned()));
        let state = self.components.iter().map(|component| {
            compiler.number(component.start, || format!("the start of `{}`", component.name))
        });
        Ok(Runnable {
            state: state.collect::<Result<_, _>>()?,
            modes: self.modes.iter().map(|mode| compiler.mode(mode)).collect::<Result<_, _>>()?,
            first: self.first,
            start: start.transpose()?.unwrap_or(0.0),
            end: end.transpose()?.unwrap_or(f64::INFINITY),
        })
    }
}

struct Compiler<'a> {
    system: &'a System,
    parameters: &'a [f64],
}

impl Compiler<'_> {
    fn program(&self, formulas: &[Formula]) -> Program {
        let (components, parameters) = (self.system.components.len(), self.parameters.len());
        let inputs = Inputs { components, parameters, fixed: true };
        Program::compile(&self.system.graph, formulas, inputs).with(self.parameters)
    }

    /// A number that parameters make.
    fn number(
        &self,
        formula: Formula,
        what: impl FnOnce() -> String,
    ) -> Result<f64, InvalidParameters> {
        let mut value = [f64::NAN];
        let (components, parameters) = (0, self.parameters.len());
        let inputs = Inputs { components, parameters, fixed: true };
        let program = Program::compile(&self.system.graph, &[formula], inputs);
        program.with(self.parameters).run(f64::NAN, &[], &mut value);
        if value[0].is_finite() {
            return Ok(value[0]);
        }
        Err(InvalidParameters::Value { what: what(), value: value[0], expected: "a finite number" })
    }

    fn mode(&self, mode: &crate::system::Mode) -> Result<Mode, InvalidParameters> {
        let nothing = |rule: &Rule| match rule.trigger {
            Trigger::When(guard, _) => guard,
            // Clocks have no value.
            _ => mode.slopes.first().copied().unwrap_or(Formula(0)),
        };
        let values: Vec<Formula> = mode.rules.iter().map(nothing).collect();
        let guards = mode.rules.iter().filter_map(|rule| match rule.trigger {
            Trigger::When(guard, _) => Some(guard),
            _ => None,
        });
        let reads = self.system.graph.reads(&guards.collect::<Vec<_>>());
        let mut reads: Vec<usize> = reads
            .into_iter()
            .filter_map(|it| match it {
                Variable::Component(component) => Some(component as usize),
                _ => None,
            })
            .collect();
        // An empty list would mean all.
        if reads.is_empty() && !self.system.components.is_empty() {
            reads.push(0);
        }
        Ok(Mode {
            slopes: self.program(&mode.slopes),
            guards: mode.rules.iter().map(guard).collect(),
            values: self.program(&values),
            reads,
            reactions: mode
                .rules
                .iter()
                .map(|rule| self.reaction(rule, &mode.name))
                .collect::<Result<_, _>>()?,
        })
    }

    fn reaction(&self, rule: &Rule, mode: &str) -> Result<Reaction, InvalidParameters> {
        let what = |what: &str| format!("{what} of a rule of mode `{mode}`");
        let schedule = match &rule.trigger {
            Trigger::When(..) => Ticks::Never,
            Trigger::At(times) => {
                let times = times.iter().map(|&time| self.number(time, || what("a time")));
                let mut times = times.collect::<Result<Vec<_>, _>>()?;
                times.sort_by(f64::total_cmp);
                let finite = |_: InvalidTimes| InvalidParameters::Value {
                    what: what("a time"),
                    value: f64::NAN,
                    expected: "a finite number",
                };
                Ticks::At(Times::new(times).map_err(finite)?)
            }
            &Trigger::Every { period, phase } => {
                let value = self.number(period, || what("the period"))?;
                if value <= 0.0 {
                    let what = what("the period");
                    let expected = "a number above 0";
                    return Err(InvalidParameters::Value { what, value, expected });
                }
                Ticks::Every(value, self.number(phase, || what("the phase"))?)
            }
        };
        let condition: &[Formula] = match &rule.next {
            Next::Branch(condition, ..) => &[*condition],
            _ => &[],
        };
        let (changed, changes): (_, Vec<_>) = rule.changes.iter().copied().unzip();
        let (changes, condition) = (self.program(&changes), self.program(condition));
        Ok(Reaction { schedule, changed, changes, next: rule.next.clone(), condition })
    }
}

/// The guard of a rule.
fn guard(rule: &Rule) -> Guard {
    let guard = match rule.trigger {
        Trigger::When(_, direction) => Guard::new(direction),
        _ => Guard::new(Direction::Clock),
    };
    let guard = guard.priority(rule.priority).from_zero(rule.from_zero);
    let guard = guard.terminal_after(rule.ends_after);
    if rule.sees_jumps { guard.sees_jumps() } else { guard }
}

impl Runnable {
    /// Where a run starts, in the first mode.
    #[must_use]
    pub fn start(&self) -> DynamicStart<'_, usize> {
        DynamicStart { mode: self.first, s: self.start, state: &self.state }
    }

    /// The same system with another start, where one is given: mode, time and state.
    ///
    /// # Errors
    /// [`InvalidParameters`] if there is no such mode, or if the state has another length or is not
    /// finite.
    pub fn starting(
        mut self,
        mode: Option<usize>,
        s: Option<f64>,
        state: Option<&[f64]>,
    ) -> Result<Self, InvalidParameters> {
        let wrong = |what: &str, value: f64, expected| InvalidParameters::Value {
            what: what.to_owned(),
            value,
            expected,
        };
        if let Some(mode) = mode {
            if mode >= self.modes.len() {
                return Err(wrong("the first mode", mode as f64, "a mode of the system"));
            }
            self.first = mode;
        }
        if let Some(s) = s {
            if !s.is_finite() {
                return Err(wrong("the start", s, "a finite number"));
            }
            self.start = s;
        }
        if let Some(state) = state {
            if state.len() != self.state.len() {
                let length = state.len() as f64;
                return Err(wrong("the number of components", length, "that of the system"));
            }
            if let Some(&value) = state.iter().find(|value| !value.is_finite()) {
                return Err(wrong("a component of the state", value, "a finite number"));
            }
            self.state = state.to_vec();
        }
        Ok(self)
    }

    /// Where a run ends; infinite if the system does not say.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.end
    }
}

impl ReadableDynamic for Runnable {
    type Mode = usize;
    const ON_FIXED_STATES: bool = true;

    fn most_guards(&self) -> usize {
        self.modes.iter().map(|mode| mode.guards.len()).max().unwrap_or(0)
    }
    #[inline]
    fn field<T: Number>(&self, mode: usize, s: T, y: &[T], slope: &mut [T]) {
        self.modes[mode].slopes.run(s, y, slope);
    }
    fn guards(&self, mode: usize) -> &[Guard] {
        &self.modes[mode].guards
    }
    #[inline]
    fn guard_values<T: Number>(&self, mode: usize, s: T, y: &[T], values: &mut [T]) {
        self.modes[mode].values.run(s, y, values);
    }
    fn reads(&self, mode: usize) -> &[usize] {
        &self.modes[mode].reads
    }
    fn schedule(&self, mode: usize, guard: usize) -> Schedule<'_> {
        match &self.modes[mode].reactions[guard].schedule {
            Ticks::Never => Schedule::NEVER,
            Ticks::At(times) => Schedule::at(times),
            &Ticks::Every(period, phase) => Schedule::every(period, phase),
        }
    }
    fn transition_condition(&self, mode: usize, guard: usize, s: f64, y: &[f64]) -> f64 {
        let mut condition = [f64::NAN];
        self.modes[mode].reactions[guard].condition.run(s, y, &mut condition);
        condition[0]
    }
    fn transition(&self, mode: usize, guard: usize, s: f64, y: &mut [f64]) -> usize {
        let reaction = &self.modes[mode].reactions[guard];
        let mut values: SmallVec<[f64; 16]> = SmallVec::from_elem(0.0, reaction.changed.len());
        reaction.changes.run(s, y, &mut values);
        let next = match reaction.next {
            Next::Stay => mode,
            Next::Mode(next) => next,
            Next::Branch(_, above, below) => {
                let condition = ReadableDynamic::transition_condition(self, mode, guard, s, y);
                if condition >= 0.0 { above } else { below }
            }
        };
        for (&component, value) in reaction.changed.iter().zip(values) {
            y[component] = value;
        }
        next
    }
}
