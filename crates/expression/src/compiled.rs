//! A system whose formulas are compiled once, for any values of its parameters.

mod whole;

use std::sync::Arc;

use stickslip_solver::{Direction, Guard, InvalidValue, Times};

use crate::branches::Branched;
use crate::continuation::Continuation;
use crate::graph::{Formula, Variable};
use crate::program::{Inputs, Program};
use crate::resets::Resets;
use crate::run::{Mode, Reaction, Rest, Runnable, Ticks};
use crate::system::{self, Condition, Next, Rule, Slide, System, Trigger};

/// A system that is ready for parameters.
#[derive(Clone, Debug)]
pub struct Compiled {
    parameters: Vec<String>,
    components: Vec<String>,
    names: Vec<String>,
    modes: Vec<Mode>,
    /// What fires at times in each mode.
    clocks: Vec<Vec<Clock>>,
    first: usize,
    /// The first mode where one of the last numbers is negative, and none before it.
    otherwise: Vec<usize>,
    /// Conditions of a run, of which the very last numbers decide.
    required: Vec<Condition>,
    slides: Vec<Continuation>,
    /// Computes [`System::fixed_formulas`] from parameters.
    numbers: Program,
    count: usize,
    has: (bool, bool),
    /// The same system with its branches as events, and what its further components are on a state.
    branched: Option<Box<(Self, Program)>>,
}

/// How many numbers of a rule are times.
#[derive(Clone, Copy, Debug)]
enum Clock {
    Never,
    At(usize),
    Every,
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

    /// The system, ready for parameters.
    ///
    /// # Errors
    /// [`InvalidValue`] if its parts, which may be made by hand, do not fit together.
    pub fn compile(&self) -> Result<Compiled, InvalidValue> {
        let mut compiled = self.compile_as_it_is()?;
        if let Some(Branched { system, starts }) = self.branched() {
            let (components, parameters) = (self.components.len(), self.parameters.len());
            let inputs = Inputs { components, parameters, fixed: true };
            let starts = Program::compile(&system.graph, &starts, inputs);
            compiled.branched = Some(Box::new((system.compile_as_it_is()?, starts)));
        }
        Ok(compiled)
    }

    /// The system whose branches are no events.
    pub(crate) fn compile_as_it_is(&self) -> Result<Compiled, InvalidValue> {
        whole::require(self)?;
        let fixed = self.fixed_formulas();
        let inputs = Inputs { components: 0, parameters: self.parameters.len(), fixed: false };
        let clock = |rule: &Rule| match &rule.trigger {
            Trigger::When(..) => Clock::Never,
            Trigger::At(times) => Clock::At(times.len()),
            Trigger::Every { .. } => Clock::Every,
        };
        let modes = self.modes.iter().zip(self.counters()).zip(self.zero_orders());
        Ok(Compiled {
            parameters: self.parameters.iter().map(|it| it.name.clone()).collect(),
            components: self.components.iter().map(|it| it.name.clone()).collect(),
            names: self.modes.iter().map(|mode| mode.name.clone()).collect(),
            modes: modes
                .map(|((mode, counters), orders)| self.compile_mode(mode, counters, &orders))
                .collect(),
            clocks: self.modes.iter().map(|mode| mode.rules.iter().map(clock).collect()).collect(),
            first: self.first,
            otherwise: self.otherwise.iter().map(|(_, mode)| *mode).collect(),
            required: self.required.clone(),
            slides: self.slides.iter().map(|slide| self.continuation(slide)).collect(),
            numbers: Program::compile(&self.graph, &fixed, inputs),
            count: fixed.len(),
            has: (self.start.is_some(), self.end.is_some()),
            branched: None,
        })
    }

    /// The system with numbers for its parameters.
    ///
    /// # Errors
    /// As [`Self::compile`] and [`Compiled::with`].
    pub fn with(&self, parameters: &[f64]) -> Result<Runnable, InvalidValue> {
        self.compile()?.with(parameters)
    }

    /// The numbers under which rules are counted: by their labels, or else each on its own, except
    /// that modes have common rules at one place.
    fn counters<'a>(&'a self) -> Vec<Arc<[usize]>> {
        if self.modes.iter().flat_map(|mode| &mode.rules).all(|rule| rule.ends_after <= 1) {
            return self.modes.iter().map(|mode| (0..mode.rules.len()).collect()).collect();
        }
        let mut known: Vec<(usize, &'a Rule)> = Vec::new();
        let mut number = |(place, rule): (usize, &'a Rule)| {
            let is_same = |&(other, known): &(usize, &Rule)| match (&known.label, &rule.label) {
                (None, None) => other == place && known == rule,
                (one, other) => one == other,
            };
            known.iter().position(is_same).unwrap_or_else(|| {
                known.push((place, rule));
                known.len() - 1
            })
        };
        let modes = self.modes.iter();
        modes.map(|mode| mode.rules.iter().enumerate().map(&mut number).collect()).collect()
    }

    fn program(&self, formulas: &[Formula]) -> Program {
        let (components, parameters) = (self.components.len(), self.parameters.len());
        Program::compile(&self.graph, formulas, Inputs { components, parameters, fixed: true })
    }

    fn continuation(&self, slide: &Slide) -> Continuation {
        Continuation {
            first: slide.first,
            count: slide.surfaces.len(),
            surfaces: self.program(&slide.surfaces),
            corners: slide.corners.iter().map(|slopes| self.program(slopes)).collect(),
        }
    }

    fn resets(&self, changes: &[(usize, Formula)]) -> Resets {
        let (changed, values): (Vec<_>, Vec<_>) = changes.iter().copied().unzip();
        Resets { changed: changed.into(), values: self.program(&values) }
    }

    fn compile_mode(&self, mode: &system::Mode, counters: Arc<[usize]>, orders: &[u32]) -> Mode {
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
        let reads = self.graph.reads(&guards.collect::<Vec<_>>());
        let mut reads: Vec<usize> = reads
            .into_iter()
            .filter_map(|it| match it {
                Variable::Component(component) => Some(component as usize),
                _ => None,
            })
            .collect();
        // An empty list would mean all.
        if reads.is_empty() && !self.components.is_empty() {
            reads.push(0);
        }
        let reaction = |rule: &Rule| {
            let condition: &[Formula] = match &rule.next {
                Next::Branch(condition, ..) => &[*condition],
                _ => &[],
            };
            let rest = rule.rest.as_ref();
            Reaction {
                resets: self.resets(&rule.changes),
                next: rule.next.clone(),
                condition: self.program(condition),
                rest: rest.map(|it| Rest { next: it.next, resets: self.resets(&it.changes) }),
            }
        };
        Mode {
            counters,
            slopes: self.program(&mode.slopes),
            guards: mode
                .rules
                .iter()
                .zip(orders)
                .map(|(rule, &order)| guard(rule, order))
                .collect(),
            values: self.program(&values),
            reads: reads.into(),
            reactions: mode.rules.iter().map(reaction).collect(),
        }
    }
}

impl Compiled {
    /// Refuses a wrong number of parameters, and those that are not finite.
    pub(crate) fn check(&self, parameters: &[f64]) -> Result<(), InvalidValue> {
        if parameters.len() != self.parameters.len() {
            let (found, expected) = (parameters.len(), self.parameters.len());
            let expected = format!("{expected}: {}", self.parameters.join(", "));
            return Err(InvalidValue::new("the number of parameters", found, expected));
        }
        let mut values = self.parameters.iter().zip(parameters);
        values.try_for_each(|(name, &value)| finite(|| name.clone(), value))
    }

    /// The system with numbers for its parameters.
    ///
    /// # Errors
    /// [`InvalidValue`] if their number is wrong, if one is not finite, if a condition that the
    /// system requires does not hold, or if a start, an end or a time of a rule is not a number
    /// with them.
    pub fn with(&self, parameters: &[f64]) -> Result<Runnable, InvalidValue> {
        self.check(parameters)?;
        for (place, room) in self.rooms(parameters).into_iter().enumerate() {
            let what = || format!("condition {} that the system requires", place + 1);
            InvalidValue::check(what(), room, "a number that is not negative", room >= 0.0)?;
        }
        self.where_it_may(parameters)
    }

    /// The numbers that must not be negative for a run, in the order of [`System::required`].
    pub(crate) fn rooms(&self, parameters: &[f64]) -> Vec<f64> {
        if self.required.is_empty() {
            return Vec::new();
        }
        let mut numbers = vec![f64::NAN; self.count];
        self.numbers.run(f64::NAN, parameters, &mut numbers);
        let values = &numbers[self.count - self.required.len()..];
        self.required.iter().zip(values).map(|(condition, &it)| condition.room(it)).collect()
    }

    /// As [`Self::with`], whether what the system requires holds or not.
    pub(crate) fn where_it_may(&self, parameters: &[f64]) -> Result<Runnable, InvalidValue> {
        self.check(parameters)?;
        let mut numbers = vec![f64::NAN; self.count];
        self.numbers.run(f64::NAN, parameters, &mut numbers);
        numbers.truncate(self.count - self.required.len());
        let mut numbers = Numbers(numbers.into_iter());
        let starts = self.components.iter();
        let state = starts.map(|it| numbers.next(|| format!("the start of `{it}`")));
        let state: Result<_, _> = state.collect();
        let start = self.has.0.then(|| numbers.next(|| "the start".to_owned()));
        let end = self.has.1.then(|| numbers.next(|| "the end".to_owned()));
        let mut ticks = Vec::with_capacity(self.modes.len());
        for (clocks, name) in self.clocks.iter().zip(&self.names) {
            let of_mode = clocks.iter().map(|clock| clock.ticks(&mut numbers, name));
            ticks.push(of_mode.collect::<Result<_, _>>()?);
        }
        let mut first = self.first;
        for &other in self.otherwise.iter().rev() {
            let choice = numbers.last(|| "what chooses the first mode".to_owned())?;
            first = if choice < 0.0 { other } else { first };
        }
        // Where a branch has no value, the system runs as it is.
        let branched = self.branched.as_ref().and_then(|branched| {
            Some(Box::new((branched.0.where_it_may(parameters).ok()?, branched.1.with(parameters))))
        });
        let runnable = Runnable {
            branched,
            slides: self.slides.iter().map(|slide| slide.with(parameters)).collect(),
            state: state?,
            tolerances: Vec::new(),
            modes: self.modes.iter().map(|mode| mode.with(parameters)).collect(),
            ticks,
            first,
            start: start.transpose()?.unwrap_or(0.0),
            end: end.transpose()?.unwrap_or(f64::INFINITY),
        };
        Ok(runnable.on_sides())
    }
}

/// What parameters make, in the order of [`System::fixed_formulas`].
struct Numbers(std::vec::IntoIter<f64>);

impl Numbers {
    fn next(&mut self, what: impl FnOnce() -> String) -> Result<f64, InvalidValue> {
        let value = self.0.next().unwrap_or(f64::NAN);
        finite(what, value).map(|()| value)
    }

    fn last(&mut self, what: impl FnOnce() -> String) -> Result<f64, InvalidValue> {
        let value = self.0.next_back().unwrap_or(f64::NAN);
        finite(what, value).map(|()| value)
    }
}

fn finite(what: impl FnOnce() -> String, value: f64) -> Result<(), InvalidValue> {
    if value.is_finite() {
        Ok(())
    } else {
        Err(InvalidValue::new(what(), value, "a finite number"))
    }
}

impl Clock {
    fn ticks(self, numbers: &mut Numbers, mode: &str) -> Result<Ticks, InvalidValue> {
        let what = |what: &str| format!("{what} of a rule of mode `{mode}`");
        match self {
            Self::Never => Ok(Ticks::Never),
            Self::At(count) => {
                let times = (0..count).map(|_| numbers.next(|| what("a time")));
                let mut times = times.collect::<Result<Vec<_>, _>>()?;
                times.sort_by(f64::total_cmp);
                Ok(Ticks::At(Times::new(times)?))
            }
            Self::Every => {
                let value = numbers.next(|| what("the period"))?;
                if value <= 0.0 {
                    return Err(InvalidValue::new(what("the period"), value, "a number above 0"));
                }
                Ok(Ticks::Every(value, numbers.next(|| what("the phase"))?))
            }
        }
    }
}

impl Mode {
    fn with(&self, parameters: &[f64]) -> Self {
        let bound = |program: &Program| program.with(parameters);
        let resets =
            |it: &Resets| Resets { changed: it.changed.clone(), values: bound(&it.values) };
        let reaction = |it: &Reaction| Reaction {
            resets: resets(&it.resets),
            next: it.next.clone(),
            condition: bound(&it.condition),
            rest: it.rest.as_ref().map(|it| Rest { next: it.next, resets: resets(&it.resets) }),
        };
        Self {
            slopes: bound(&self.slopes),
            values: bound(&self.values),
            reactions: self.reactions.iter().map(reaction).collect(),
            guards: self.guards.clone(),
            counters: self.counters.clone(),
            reads: self.reads.clone(),
        }
    }
}

/// The guard of a rule, which starts from a zero of this order.
fn guard(rule: &Rule, order: u32) -> Guard {
    let guard = match &rule.trigger {
        Trigger::When(_, direction) => Guard::new(*direction),
        // A rule that never acts.
        Trigger::At(times) if times.is_empty() => return Guard::OFF,
        _ => Guard::new(Direction::Clock),
    };
    let guard = guard.priority(rule.priority).from_zero(order);
    let guard = guard.terminal_after(rule.ends_after);
    if rule.sees_jumps { guard.sees_jumps() } else { guard }
}
