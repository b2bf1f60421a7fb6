//! Formulas that Python records one by one.

use std::sync::{Mutex, MutexGuard, PoisonError};

use pyo3::prelude::*;
use stickslip_expression::{
    Binary, Component, Condition, Formula, Graph, Inputs, Mode, Next, Parameter, Program, RestRule,
    Rule, System, Trigger, Unary, Variable,
};
use stickslip_solver::Direction;

use crate::failure::bad_input;
use crate::formulas::FormulaSystem;

/// The highest order of a zero that is looked for.
const MOST_ORDERS: u32 = 8;

/// Formulas, which go by their numbers.
#[pyclass(frozen, module = "stickslip._native")]
#[derive(Default)]
pub struct Tape(Mutex<Graph>);

/// A rule of a recorded system.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct RuleRow {
    label: String,
    /// A formula; a clock has none.
    guard: Option<u32>,
    direction: String,
    /// Period and phase of a clock, or else its times.
    period: Option<(f64, f64)>,
    times: Vec<f64>,
    to: Option<usize>,
    /// A formula, the mode where it is 0 or above, and the mode where it is below.
    branch: Option<(u32, usize, usize)>,
    /// The state that follows.
    after: Option<Vec<u32>>,
    /// The mode, and the state if it changes, where events accumulate.
    rest: Option<(usize, Option<Vec<u32>>)>,
    terminal: u32,
    from_zero: u32,
    priority: i8,
    sees_jumps: bool,
}

/// The first mode, the time and the state at the start, what chooses another first mode where it is
/// negative, and what must not be negative for a start.
type StartRow = (usize, f64, Vec<u32>, Option<(u32, usize)>, Vec<u32>);

#[pymethods]
impl Tape {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    fn constant(&self, x: f64) -> u32 {
        self.graph().constant(x).number()
    }

    fn time(&self) -> u32 {
        self.graph().time().number()
    }

    fn component(&self, index: u32) -> u32 {
        self.graph().component(index).number()
    }

    fn parameter(&self, index: u32) -> u32 {
        self.graph().parameter(index).number()
    }

    /// The number that a formula is, if it is constant.
    fn value(&self, formula: u32) -> PyResult<Option<f64>> {
        let graph = self.graph();
        Ok(graph.value(known(&graph, formula)?))
    }

    fn unary(&self, name: &str, a: u32) -> PyResult<u32> {
        let mut graph = self.graph();
        let a = known(&graph, a)?;
        let function = unary(name).ok_or_else(|| bad_input(format!("no function {name}")))?;
        Ok(graph.unary(function, a).number())
    }

    fn binary(&self, name: &str, a: u32, b: u32) -> PyResult<u32> {
        let mut graph = self.graph();
        let (a, b) = (known(&graph, a)?, known(&graph, b)?);
        let function = match name {
            "add" => Binary::Add,
            "sub" => Binary::Sub,
            "mul" => Binary::Mul,
            "div" => Binary::Div,
            "min" => Binary::Min,
            "max" => Binary::Max,
            "atan2" => Binary::Atan2,
            "power" => return Ok(graph.power(a, b).number()),
            "mod" => return Ok(graph.modulo(a, b).number()),
            _ => return Err(bad_input(format!("no function {name}"))),
        };
        Ok(graph.binary(function, a, b).number())
    }

    fn select(&self, condition: u32, above: u32, below: u32) -> PyResult<u32> {
        let mut graph = self.graph();
        let [condition, above, below] = [condition, above, below].map(|it| known(&graph, it));
        Ok(graph.select(condition?, above?, below?).number())
    }

    /// The values of formulas with parameters, at each of some times and states.
    fn evaluate(
        &self,
        formulas: Vec<u32>,
        places: Vec<(f64, Vec<f64>)>,
        parameters: Vec<f64>,
    ) -> PyResult<Vec<Vec<f64>>> {
        let graph = self.graph();
        let formulas = all_known(&graph, &formulas)?;
        let components = places.iter().map(|(_, y)| y.len()).min().unwrap_or_default();
        let program = program(&graph, &formulas, [components, parameters.len()])?;
        let fixed = program.with(&parameters);
        let at = |(t, y): &(f64, Vec<f64>)| {
            let mut values = vec![f64::NAN; formulas.len()];
            fixed.run(*t, &y[..components], &mut values);
            values
        };
        Ok(places.iter().map(at).collect())
    }

    /// Formulas of a state with n components as text.
    fn text(&self, formulas: Vec<u32>, n: usize) -> PyResult<Vec<String>> {
        let graph = self.graph();
        let formulas = all_known(&graph, &formulas)?;
        let names: Vec<String> = (0..n).map(|place| format!("y{place}")).collect();
        Ok(graph.texts(&formulas, &names))
    }

    /// The order of the zero that a formula has at a time, a state and parameters, along the flow
    /// with these slopes: 0 if it is no zero.
    #[pyo3(signature = (formula, slopes, t, y, parameters=Vec::new()))]
    fn zero_order(
        &self,
        formula: u32,
        slopes: Vec<u32>,
        t: f64,
        y: Vec<f64>,
        parameters: Vec<f64>,
    ) -> PyResult<u32> {
        let mut graph = self.graph();
        let mut formula = known(&graph, formula)?;
        let slopes = all_known(&graph, &slopes)?;
        let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
        for order in 0..MOST_ORDERS {
            let mut value = [f64::NAN];
            let program = program(&graph, &[formula], [y.len(), parameters.len()])?;
            program.with(&parameters).run(t, &y, &mut value);
            if value[0] != 0.0 {
                return Ok(order);
            }
            formula = graph.slope(formula, &mut |_, variable| match variable {
                Variable::Time => one,
                Variable::Component(place) => slopes.get(place as usize).copied().unwrap_or(zero),
                Variable::Parameter(_) => zero,
            });
        }
        Ok(MOST_ORDERS)
    }

    /// A system of formulas of this tape: names of parameters; the first mode, the time and the
    /// state at the start, what chooses another first mode where it is negative, and what must not
    /// be negative for a start; and modes with
    /// slopes and rules. Only rules change the `held` last components, which have these names. All
    /// modes slide along surfaces with names.
    fn system(
        &self,
        parameters: Vec<String>,
        start: StartRow,
        modes: Vec<(String, Vec<u32>, Vec<RuleRow>)>,
        held: Vec<String>,
        surfaces: Vec<(String, u32)>,
    ) -> PyResult<FormulaSystem> {
        let mut graph = self.graph().clone();
        let (first, time, start, otherwise, required) = start;
        let required = all_known(&graph, &required)?.into_iter();
        let required = required.map(|formula| Condition { formula, below: false }).collect();
        let otherwise = otherwise.map(|(formula, mode)| Ok((known(&graph, formula)?, mode)));
        let otherwise = otherwise.into_iter().collect::<PyResult<_>>()?;
        let start = all_known(&graph, &start)?;
        let n = start.len().saturating_sub(held.len());
        let component = |(place, &start): (usize, &Formula)| match place.checked_sub(n) {
            None => Component { name: format!("y{place}"), start, discrete: false },
            Some(place) => Component { name: held[place].clone(), start, discrete: true },
        };
        let components = start.iter().enumerate().map(component).collect();
        let parameter = |name| Parameter { name, value: 0.0, range: None };
        let parameters = parameters.into_iter().map(parameter).collect();
        let (names, surfaces): (Vec<_>, Vec<_>) = surfaces.into_iter().unzip();
        let surfaces = all_known(&graph, &surfaces)?;
        let begin = Some(graph.constant(time));
        let sizes = (modes.len(), start.len());
        let mut read = Vec::new();
        for (name, slopes, rows) in modes {
            let slopes = all_known(&graph, &slopes)?;
            if slopes.len() != start.len() {
                return Err(bad_input("a mode has another number of components"));
            }
            let rules = rows.into_iter().map(|row| rule(&mut graph, row, sizes));
            read.push(Mode { name, slopes, rules: rules.collect::<PyResult<_>>()? });
        }
        let end = None;
        let system = System {
            graph,
            parameters,
            components,
            modes: read,
            first,
            otherwise,
            required,
            start: begin,
            end,
            ..System::default()
        };
        let system = if surfaces.is_empty() {
            system
        } else {
            system.sliding_on(&surfaces, &names).map_err(bad_input)?
        };
        Ok(FormulaSystem::of(system))
    }
}

impl Tape {
    fn graph(&self) -> MutexGuard<'_, Graph> {
        // A graph is whole between calls.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A formula of the tape.
fn known(graph: &Graph, number: u32) -> PyResult<Formula> {
    graph.formula(number).ok_or_else(|| bad_input(format!("there is no formula {number}")))
}

fn all_known(graph: &Graph, numbers: &[u32]) -> PyResult<Vec<Formula>> {
    numbers.iter().map(|&number| known(graph, number)).collect()
}

/// What computes formulas of so many components and parameters.
fn program(
    graph: &Graph,
    formulas: &[Formula],
    [components, parameters]: [usize; 2],
) -> PyResult<Program> {
    let is_beyond = |variable: &Variable| match variable {
        Variable::Time => false,
        Variable::Component(place) => *place as usize >= components,
        Variable::Parameter(place) => *place as usize >= parameters,
    };
    if graph.reads(formulas).iter().any(is_beyond) {
        return Err(bad_input("a formula reads another component"));
    }
    let inputs = Inputs { components, parameters, fixed: true };
    Ok(Program::compile(graph, formulas, inputs))
}

fn rule(graph: &mut Graph, row: RuleRow, (modes, n): (usize, usize)) -> PyResult<Rule> {
    let trigger = match (row.guard, row.period) {
        (Some(guard), _) => {
            let direction = match row.direction.as_str() {
                "below" => Direction::Below,
                "falling" => Direction::Falling,
                "rising" => Direction::Rising,
                _ => Direction::Either,
            };
            Trigger::When(known(graph, guard)?, direction)
        }
        (None, Some((period, phase))) => {
            Trigger::Every { period: graph.constant(period), phase: graph.constant(phase) }
        }
        (None, None) => Trigger::At(row.times.iter().map(|&time| graph.constant(time)).collect()),
    };
    let next = match (row.branch, row.to) {
        (Some((condition, above, below)), _) => {
            Next::Branch(known(graph, condition)?, above, below)
        }
        (None, Some(mode)) => Next::Mode(mode),
        (None, None) => Next::Stay,
    };
    let (one, other) = match next {
        Next::Branch(_, above, below) => (above, below),
        Next::Mode(mode) => (mode, mode),
        Next::Stay | Next::Slide { .. } => (0, 0),
    };
    if one.max(other) >= modes {
        return Err(bad_input(format!("there is no mode {}", one.max(other))));
    }
    let here: Vec<Formula> = (0..).take(n).map(|place| graph.component(place)).collect();
    let changes = |after: Option<Vec<u32>>| -> PyResult<Vec<(usize, Formula)>> {
        let after = all_known(graph, &after.unwrap_or_default())?;
        if after.len() > n {
            return Err(bad_input("a reset has another number of components"));
        }
        let changed = |&(place, formula): &(usize, Formula)| formula != here[place];
        Ok(after.into_iter().enumerate().filter(changed).collect())
    };
    let rest = match row.rest {
        Some((next, _)) if next >= modes => {
            return Err(bad_input(format!("there is no mode {next}")));
        }
        Some((next, after)) => Some(RestRule { next, changes: changes(after)? }),
        None => None,
    };
    Ok(Rule {
        trigger,
        label: Some(row.label),
        priority: row.priority,
        sees_jumps: row.sees_jumps,
        ends_after: row.terminal,
        from_zero: row.from_zero,
        changes: changes(row.after)?,
        next,
        rest,
    })
}

#[rustfmt::skip]
fn unary(name: &str) -> Option<Unary> {
    Some(match name {
        "neg" => Unary::Neg, "abs" => Unary::Abs, "floor" => Unary::Floor,
        "square" => Unary::Square, "sqrt" => Unary::Sqrt, "exp" => Unary::Exp,
        "expm1" => Unary::ExpM1, "log" => Unary::Ln, "log1p" => Unary::Ln1p,
        "sin" => Unary::Sin, "cos" => Unary::Cos, "tan" => Unary::Tan, "asin" => Unary::Asin,
        "acos" => Unary::Acos, "atan" => Unary::Atan, "sinh" => Unary::Sinh,
        "cosh" => Unary::Cosh, "tanh" => Unary::Tanh, "asinh" => Unary::Asinh,
        "acosh" => Unary::Acosh, "atanh" => Unary::Atanh, "erf" => Unary::Erf,
        _ => return None,
    })
}
