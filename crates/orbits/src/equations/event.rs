//! What happens at the end of a segment: its condition, what its rule changes, and derivatives.

use nalgebra::{DMatrix, DVector};
use stickslip_expression::{
    Binary, Formula, Graph, Inputs, Next, Program, System, Trigger, Variable,
};

use super::flow::narrow;
use crate::itinerary::Leg;

/// The formulas of an event, compiled together.
#[derive(Clone, Debug)]
pub(crate) struct EventFormulas {
    program: Program,
    n: usize,
    columns: usize,
    conditions: usize,
}

/// An event at a place. Columns of derivatives are those of the state, the time and parameters.
#[derive(Clone, Debug)]
pub(crate) struct Event {
    /// The condition, which is 0 on the event.
    pub guard: f64,
    /// Its derivatives.
    pub guard_by: DVector<f64>,
    /// The state behind the event.
    pub after: DVector<f64>,
    /// Its derivatives.
    pub after_by: DMatrix<f64>,
    /// The slopes of the state before the event.
    pub slopes: DVector<f64>,
    /// The slopes behind it, in the mode that follows.
    pub slopes_after: DVector<f64>,
    /// What chooses the mode that follows; NaN if nothing does.
    pub choice: f64,
    /// The rate of the condition in the mode that follows, without the event's changes.
    pub rate_after: f64,
    /// The conditions of all rules of the mode.
    pub conditions: Vec<f64>,
}

impl EventFormulas {
    /// The event at the end of a leg. The tick of a clock has this number.
    pub fn new(
        graph: &mut Graph,
        system: &System,
        leg: Leg,
        tick: Option<f64>,
        active: &[usize],
    ) -> Self {
        let n = system.components.len();
        let (mode, rule) = (&system.modes[leg.mode], leg.rule(system));
        let guard = match rule.trigger {
            Trigger::When(guard, _) => guard,
            Trigger::Every { period, phase } => {
                since_tick(graph, period, phase, tick.unwrap_or(0.0))
            }
            // An itinerary has no such rule.
            Trigger::At(_) => graph.constant(0.0),
        };
        let mut after: Vec<Formula> = (0..n).map(|place| graph.component(narrow(place))).collect();
        for &(place, formula) in &rule.changes {
            after[place] = formula;
        }
        let choice = match rule.next {
            Next::Branch(condition, ..) => condition,
            _ => graph.constant(f64::NAN),
        };
        let next = &system.modes[leg.next].slopes;
        let behind: Vec<Formula> =
            next.iter().map(|&slope| graph.substituted(slope, &after)).collect();
        let rate_after = rate(graph, guard, next);
        let columns = n + 1 + active.len();
        let mut formulas = vec![guard];
        formulas.extend(by_each(graph, guard, n, active));
        formulas.extend(&after);
        for &formula in &after {
            formulas.extend(by_each(graph, formula, n, active));
        }
        formulas.extend(&mode.slopes);
        formulas.extend(&behind);
        formulas.extend([choice, rate_after]);
        let before = formulas.len();
        formulas.extend(mode.rules.iter().filter_map(|rule| match rule.trigger {
            Trigger::When(guard, _) => Some(guard),
            _ => None,
        }));
        let conditions = formulas.len() - before;
        let inputs = Inputs { components: n, parameters: system.parameters.len(), fixed: true };
        Self { program: Program::compile(graph, &formulas, inputs), n, columns, conditions }
    }

    /// The event at a place.
    pub fn at(&self, parameters: &[f64], s: f64, state: &[f64]) -> Event {
        let Self { n, columns, conditions, .. } = *self;
        let count = 1 + columns + n + n * columns + 2 * n + 2 + conditions;
        let mut values = vec![f64::NAN; count];
        self.program.with(parameters).run(s, state, &mut values);
        let mut rest = &values[..];
        let mut take = |count: usize| {
            let (own, others) = rest.split_at(count);
            rest = others;
            own
        };
        Event {
            guard: take(1)[0],
            guard_by: DVector::from_column_slice(take(columns)),
            after: DVector::from_column_slice(take(n)),
            after_by: DMatrix::from_row_slice(n, columns, take(n * columns)),
            slopes: DVector::from_column_slice(take(n)),
            slopes_after: DVector::from_column_slice(take(n)),
            choice: take(1)[0],
            rate_after: take(1)[0],
            conditions: take(conditions).to_vec(),
        }
    }
}

impl Event {
    /// The rate of the condition along the solution before the event.
    pub fn rate(&self) -> f64 {
        let n = self.slopes.len();
        self.guard_by.rows(0, n).dot(&self.slopes) + self.guard_by[n]
    }

    /// What the event makes of small differences: not finite at a graze.
    pub fn saltation(&self) -> DMatrix<f64> {
        let n = self.slopes.len();
        let by = self.guard_by.rows(0, n).transpose();
        let reset = self.after_by.columns(0, n);
        let jump = &self.slopes_after - reset * &self.slopes - self.after_by.column(n);
        // A clock acts at its time, and a rule that changes nothing leaves differences as they are.
        let plain = by.amax() == 0.0 || jump.amax() == 0.0;
        // A rate that rounding makes has no digit.
        let rate = if self.rate().abs() <= STILL * self.rate_size() { 0.0 } else { self.rate() };
        reset + if plain { DMatrix::zeros(n, n) } else { jump * by / rate }
    }

    /// Whether the formulas have the same values at another time. Components have these sizes, and
    /// their slopes these sizes over the period: both may be zero at one event.
    pub fn is_like(&self, later: &Self, sizes: &[f64], period: f64) -> bool {
        let near = |one: f64, other: f64, size: f64| {
            (one - other).abs() <= LIKE * (one.abs() + other.abs()) + HIDDEN * size
        };
        // Derivatives by parameters grow with the time where its scale depends on them.
        let by = |event: &Self| event.after_by.columns(0, event.slopes.len() + 1).into_owned();
        let (by, other_by) = (by(self), by(later));
        let own = [by.as_slice(), &self.conditions];
        let same =
            own.into_iter().zip([other_by.as_slice(), &later.conditions]).all(|(own, others)| {
                // A condition is zero at its event.
                let size = own.iter().fold(self.after.amax(), |size, it| size.max(it.abs()));
                own.iter().zip(others).all(|(one, other)| near(*one, *other, size))
            });
        same && sizes.iter().enumerate().all(|(k, size)| {
            near(self.after[k], later.after[k], *size)
                && near(self.slopes[k], later.slopes[k], size / period)
                && near(self.slopes_after[k], later.slopes_after[k], size / period)
        })
    }

    /// Whether the condition only touches zero.
    pub fn grazes(&self) -> bool {
        self.rate().abs() <= LIKE * self.rate_size()
    }

    /// What the rate of the condition is made of.
    pub fn rate_size(&self) -> f64 {
        let parts = (0..self.slopes.len()).map(|k| (self.guard_by[k] * self.slopes[k]).abs());
        let size = parts.fold(self.guard_by[self.slopes.len()].abs(), f64::max);
        // At a graze of one part, all of it vanishes: then it is as large as the slopes.
        size.max(self.slopes.amax() * self.guard_by.rows(0, self.slopes.len()).amax())
    }

    /// Whether the mode that follows slides along what was reached: there the condition stays zero.
    pub fn slides_behind(&self) -> bool {
        let size = self.rate_size();
        size > 0.0 && self.rate_after.abs() <= STILL * size
    }
}

/// Values that differ by no more than this part are the same.
const LIKE: f64 = 1e-6;
/// Values that differ by no more than this part of the largest one beside them are the same.
const HIDDEN: f64 = 1e-9;
/// A rate is zero if it is less than this part of what it is made of.
const STILL: f64 = 1e-10;

/// The time since a tick of a clock.
fn since_tick(graph: &mut Graph, period: Formula, phase: Formula, number: f64) -> Formula {
    let (time, number) = (graph.time(), graph.constant(number));
    let ticks = graph.binary(Binary::Mul, number, period);
    let tick = graph.binary(Binary::Add, phase, ticks);
    graph.binary(Binary::Sub, time, tick)
}

/// The rate of a formula along slopes.
pub(crate) fn rate(graph: &mut Graph, formula: Formula, slopes: &[Formula]) -> Formula {
    graph.slope(formula, &mut |graph, variable| match variable {
        Variable::Time => graph.constant(1.0),
        Variable::Component(place) => slopes[place as usize],
        Variable::Parameter(_) => graph.constant(0.0),
    })
}

/// The derivatives of a formula by each component, the time and some parameters.
pub(crate) fn by_each(
    graph: &mut Graph,
    formula: Formula,
    n: usize,
    active: &[usize],
) -> Vec<Formula> {
    let components = (0..n).map(|place| Variable::Component(narrow(place)));
    let parameters = active.iter().map(|&place| Variable::Parameter(narrow(place)));
    let all: Vec<Variable> = components.chain([Variable::Time]).chain(parameters).collect();
    let by = |own: Variable, graph: &mut Graph| {
        graph.slope(formula, &mut |graph, variable| {
            graph.constant(f64::from(u8::from(variable == own)))
        })
    };
    all.into_iter().map(|own| by(own, graph)).collect()
}
