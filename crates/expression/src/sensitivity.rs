//! Derivatives of a run with respect to parameters and initial values, through every event.
//!
//! Derivatives are further components of the state. Between events they obey the variational
//! equations, and at an event they jump (Leine and Nijmeijer, *Dynamics and Bifurcations of
//! Non-Smooth Mechanical Systems*, 2004, section 7.3). Both are formulas that [`Graph::slope`]
//! makes from those of the system, whose branches are events. So there is no second engine: error
//! control, events and speed are those of any run.

use stickslip_solver::{EmbeddedPair, InvalidValue, Options, Outcome, RunError};
use thiserror::Error;

use crate::graph::{Binary, Formula, FormulaNode, Graph, Unary, Variable};
use crate::program::{Inputs, Program};
use crate::recording::{Hidden, Recording};
use crate::system::{Component, Next, Rule, System, Trigger};

/// What a run is differentiated by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum By {
    /// A parameter, by its place.
    Parameter(usize),
    /// The value of a component at the start, by its place.
    Start(usize),
}

/// A run with its derivatives.
#[derive(Clone, Debug)]
pub struct SystemSensitivities {
    /// The run. Its states have the components of the system, and then, for each thing it is
    /// differentiated by, the derivative of each component at a fixed time.
    pub recording: Recording,
    /// The events, in order, and last the end.
    pub places: Vec<Moving>,
}

/// An event, or the end of a run, which moves with what the run is differentiated by.
#[derive(Clone, Debug, PartialEq)]
pub struct Moving {
    /// The time.
    pub s: f64,
    /// Its derivatives.
    pub s_by: Vec<f64>,
    /// The state before the event, or at the end.
    pub state: Vec<f64>,
    /// For each derivative, that of each component at the place, which moves too.
    pub state_by: Vec<Vec<f64>>,
}

/// Why a run has no derivatives.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SensitivityError {
    /// The system cannot run with these parameters.
    #[error(transparent)]
    Parameters(#[from] InvalidValue),
    /// The run failed, for instance at a graze, where derivatives do not exist.
    #[error(transparent)]
    Run(#[from] RunError),
    /// Something jumps where derivatives by the way it is reached are not known.
    #[error("there are no derivatives behind t = {s:?}: {reason}")]
    Jump {
        /// Where.
        s: f64,
        /// What.
        reason: &'static str,
    },
}

impl System {
    /// Runs the system to `end`, or to its own end, together with derivatives.
    ///
    /// Error control covers the derivatives too, which are about as accurate as the state. They
    /// hold for an unchanged order of events, and grow without bound towards a graze. Where events
    /// accumulate, the run ends, also if the system says how it goes on.
    ///
    /// ```
    /// use stickslip_expression::{By, System};
    /// use stickslip_solver::{EmbeddedPair, Options};
    ///
    /// // Thrown up with velocity v, the ball is back after 2v/g, and again after another 2ev/g.
    /// let ball = System::parse(
    ///     "parameter e = 0.5\nstate x = 0, v = 4.905\nx' = v\nv' = -9.81\n\
    ///      when x < 0 \"floor\"\n  x := 0\n  v := -e*v\nend = 1.6",
    /// )?;
    /// let by = [By::Parameter(0), By::Start(1)];
    /// let options = Options::default();
    /// let found = ball.sensitivities(&by, &[0.5], EmbeddedPair::Dop853, None, &options)?;
    /// let second = &found.places[1];
    /// assert!((second.s - 1.5).abs() < 1e-13);
    /// assert!((second.s_by[0] - 1.0).abs() < 1e-12 && (second.s_by[1] - 3.0 / 9.81).abs() <
    /// 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`SensitivityError`].
    pub fn sensitivities(
        &self,
        by: &[By],
        parameters: &[f64],
        method: EmbeddedPair,
        end: Option<f64>,
        options: &Options,
    ) -> Result<SystemSensitivities, SensitivityError> {
        self.sensitivities_unless(&|_| false, by, parameters, method, end, options)
    }

    /// As [`Self::sensitivities`], and stops where `stops`, which is called with the time after
    /// every step and every event, returns `true`.
    ///
    /// # Errors
    /// [`SensitivityError`].
    pub fn sensitivities_unless(
        &self,
        stops: &dyn Fn(f64) -> bool,
        by: &[By],
        parameters: &[f64],
        method: EmbeddedPair,
        end: Option<f64>,
        options: &Options,
    ) -> Result<SystemSensitivities, SensitivityError> {
        let compiled = self.compile_as_it_is()?;
        if let Some(beyond) = by.iter().find(|by| match by {
            By::Parameter(place) => *place >= self.parameters.len(),
            By::Start(place) => *place >= self.components.len(),
        }) {
            let (what, value) = match beyond {
                By::Parameter(place) => ("the place of a parameter", *place),
                By::Start(place) => ("the place of a component", *place),
            };
            let expected = "one of those that the system has";
            return Err(InvalidValue::new(what, value, expected).into());
        }
        if !self.slides.is_empty() {
            let s = compiled.with(parameters)?.start().s;
            let reason =
                "what follows on several surfaces, or on those of functions, is no formula";
            return Err(SensitivityError::Jump { s, reason });
        }
        let end_moves = end.is_none();
        let end = end.unwrap_or(compiled.with(parameters)?.end());
        let branched = self.branched();
        if branched.is_none() && self.branches() {
            let s = compiled.with(parameters)?.start().s;
            let reason = "equations branch in many ways, or beside guards that start from zero";
            return Err(SensitivityError::Jump { s, reason });
        }
        let extended = Extended::of(branched.as_ref().map_or(self, |it| &it.system), by);
        let runnable = extended.system.compile_as_it_is()?.with(parameters)?;
        let mut recording = runnable.record_as_it_is(stops, method, end, options)?;
        let rules: Vec<usize> = self.modes.iter().map(|mode| mode.rules.len()).collect();
        extended.require_jumps_alone(&recording, &rules)?;
        let mut places = extended.places(&recording, parameters, end_moves, &rules);
        if branched.is_some() {
            let own = self.components.len();
            recording.take_out(Hidden { groups: 1 + by.len(), own }, &rules);
            for place in &mut places {
                place.state.truncate(own);
                place.state_by.iter_mut().for_each(|by| by.truncate(own));
            }
        }
        Ok(SystemSensitivities { recording, places })
    }
}

/// A system whose state has derivatives.
struct Extended<'a> {
    system: System,
    by: &'a [By],
    /// The number of components of the system itself.
    n: usize,
    /// How the time of each rule of each mode moves with each thing.
    moves: Vec<Vec<Vec<Formula>>>,
    /// How the end moves.
    end_moves: Vec<Formula>,
}

impl<'a> Extended<'a> {
    fn of(system: &System, by: &'a [By]) -> Self {
        let n = system.components.len();
        let mut ending = system.clone();
        // How derivatives go on behind an accumulation is not known: the run ends there.
        for rule in ending.modes.iter_mut().flat_map(|mode| &mut mode.rules) {
            rule.rest = None;
        }
        let mut extended = Self { system: ending, by, n, moves: Vec::new(), end_moves: Vec::new() };
        let begin = system.start.unwrap_or_else(|| extended.number(0.0));
        let slopes = extended.first_slopes(system, begin);
        for &by in by {
            let later = extended.fixed_slope(begin, by);
            let moves = extended.system.graph.value(later) != Some(0.0);
            for (place, component) in system.components.iter().enumerate() {
                let start = match by {
                    By::Parameter(_) if !moves => extended.fixed_slope(component.start, by),
                    By::Parameter(_) => {
                        // At a fixed time, a state that begins later has not come as far.
                        let own = extended.fixed_slope(component.start, by);
                        let missed = extended.graph().binary(Binary::Mul, slopes[place], later);
                        extended.graph().binary(Binary::Sub, own, missed)
                    }
                    By::Start(own) => extended.number(f64::from(u8::from(own == place))),
                };
                let name = match by {
                    By::Parameter(place) => &system.parameters[place].name,
                    By::Start(place) => &system.components[place].name,
                };
                let (name, discrete) = (format!("{}_by_{name}", component.name), false);
                extended.system.components.push(Component { name, start, discrete });
            }
        }
        let end = system.end.unwrap_or_else(|| extended.number(0.0));
        extended.end_moves = by.iter().map(|&by| extended.fixed_slope(end, by)).collect();
        for mode in 0..system.modes.len() {
            let own = &system.modes[mode];
            for k in 0..by.len() {
                for place in 0..n {
                    let rate = extended.variation(own.slopes[place], k, None);
                    extended.system.modes[mode].slopes.push(rate);
                }
            }
            let mut moves = Vec::new();
            for (place, rule) in own.rules.iter().enumerate() {
                let shifts: Vec<Formula> =
                    (0..by.len()).map(|k| extended.shift(rule, &own.slopes, k)).collect();
                if !rule.stays_as_it_is() {
                    let changes = extended.jump(system, mode, rule, &shifts);
                    extended.system.modes[mode].rules[place].changes.extend(changes);
                }
                moves.push(shifts);
            }
            extended.moves.push(moves);
        }
        extended
    }

    /// The slopes of the state where a run begins, as formulas of parameters.
    fn first_slopes(&mut self, system: &System, begin: Formula) -> Vec<Formula> {
        let graph = self.graph();
        let at_start = |graph: &mut Graph, mode: usize, place: usize| {
            graph.rewritten(system.modes[mode].slopes[place], &mut |_, node, _| match node {
                FormulaNode::Variable(Variable::Component(own)) => {
                    Some(system.components[own as usize].start)
                }
                FormulaNode::Variable(Variable::Time) => Some(begin),
                _ => None,
            })
        };
        let first = |place: usize| {
            let mut slope = at_start(graph, system.first, place);
            for &(condition, mode) in system.otherwise.iter().rev() {
                let other = at_start(graph, mode, place);
                slope = graph.select(condition, slope, other);
            }
            slope
        };
        (0..system.components.len()).map(first).collect()
    }

    fn graph(&mut self) -> &mut Graph {
        &mut self.system.graph
    }

    fn number(&mut self, x: f64) -> Formula {
        self.graph().constant(x)
    }

    /// The derivative of a formula of parameters.
    fn fixed_slope(&mut self, formula: Formula, by: By) -> Formula {
        self.graph().slope(formula, &mut |graph, variable| match (variable, by) {
            (Variable::Parameter(place), By::Parameter(own)) if place as usize == own => {
                graph.constant(1.0)
            }
            _ => graph.constant(0.0),
        })
    }

    /// The change of a formula with the thing of number `k`: at a fixed time, or together with a
    /// time that moves like this while the state has these slopes.
    fn variation(
        &mut self,
        formula: Formula,
        k: usize,
        moving: Option<(Formula, &[Formula])>,
    ) -> Formula {
        let (n, by) = (self.n, self.by[k]);
        self.graph().slope(formula, &mut |graph, variable| match variable {
            Variable::Time => moving.map_or_else(|| graph.constant(0.0), |(shift, _)| shift),
            Variable::Component(place) => {
                // Components are counted by u32.
                let offset = u32::try_from(n * (k + 1)).unwrap_or(u32::MAX);
                let own = graph.component(offset.saturating_add(place));
                let Some((shift, slopes)) = moving else { return own };
                let along = graph.binary(Binary::Mul, slopes[place as usize], shift);
                graph.binary(Binary::Add, own, along)
            }
            Variable::Parameter(place) => {
                let is_own = by == By::Parameter(place as usize);
                graph.constant(f64::from(u8::from(is_own)))
            }
        })
    }

    /// How the time at which a rule acts moves with the thing of number `k`.
    fn shift(&mut self, rule: &Rule, slopes: &[Formula], k: usize) -> Formula {
        match &rule.trigger {
            &Trigger::When(guard, _) => {
                let change = self.variation(guard, k, None);
                let rate = self.graph().rate(guard, slopes);
                let ratio = self.graph().binary(Binary::Div, change, rate);
                self.graph().unary(Unary::Neg, ratio)
            }
            // The time is that of the list which is nearest.
            Trigger::At(times) => {
                let Some((&first, rest)) = times.split_first() else { return self.number(0.0) };
                let by = self.by[k];
                let (mut nearest, mut shift) = (self.distance(first), self.fixed_slope(first, by));
                for &time in rest {
                    let (distance, other) = (self.distance(time), self.fixed_slope(time, by));
                    let nearer = self.graph().binary(Binary::Sub, nearest, distance);
                    shift = self.graph().select(nearer, other, shift);
                    nearest = self.graph().binary(Binary::Min, nearest, distance);
                }
                shift
            }
            // phase + number·period, with number = (t − phase)/period rounded.
            &Trigger::Every { period, phase } => {
                let by = self.by[k];
                let (by_phase, by_period) =
                    (self.fixed_slope(phase, by), self.fixed_slope(period, by));
                let graph = self.graph();
                let (time, half) = (graph.time(), graph.constant(0.5));
                let since = graph.binary(Binary::Sub, time, phase);
                let number = graph.binary(Binary::Div, since, period);
                let number = graph.binary(Binary::Add, number, half);
                let number = graph.unary(Unary::Floor, number);
                let moved = graph.binary(Binary::Mul, number, by_period);
                graph.binary(Binary::Add, by_phase, moved)
            }
        }
    }

    /// How far the time is from another one.
    fn distance(&mut self, time: Formula) -> Formula {
        let now = self.graph().time();
        let difference = self.graph().binary(Binary::Sub, now, time);
        self.graph().unary(Unary::Abs, difference)
    }

    /// The derivatives behind an event: the change of the new state at the time that moves, less
    /// what the new slopes make of that motion.
    fn jump(
        &mut self,
        system: &System,
        mode: usize,
        rule: &Rule,
        shifts: &[Formula],
    ) -> Vec<(usize, Formula)> {
        let n = self.n;
        let after = self.graph().state(n, &rule.changes);
        let slopes = |next: usize| &system.modes[next].slopes;
        let rates: Vec<Formula> = (0..n)
            .map(|place| match rule.next {
                Next::Stay => self.graph().substituted(slopes(mode)[place], &after),
                Next::Mode(next) => self.graph().substituted(slopes(next)[place], &after),
                Next::Branch(condition, above, below) => {
                    let [above, below] = [above, below]
                        .map(|next| self.graph().substituted(slopes(next)[place], &after));
                    self.graph().select(condition, above, below)
                }
                // Systems with slides are refused.
                Next::Slide { .. } => self.graph().constant(f64::NAN),
            })
            .collect();
        let mut changes = Vec::new();
        for (k, &shift) in shifts.iter().enumerate() {
            for place in 0..n {
                let moving = Some((shift, &slopes(mode)[..]));
                let change = self.variation(after[place], k, moving);
                let back = self.graph().binary(Binary::Mul, rates[place], shift);
                let change = self.graph().binary(Binary::Sub, change, back);
                changes.push((n * (k + 1) + place, change));
            }
        }
        changes
    }

    /// Refuses events behind which derivatives are not known. Rules behind so many of each mode are
    /// those of branches.
    fn require_jumps_alone(
        &self,
        found: &Recording,
        rules: &[usize],
    ) -> Result<(), SensitivityError> {
        for (place, event) in found.events.iter().enumerate() {
            let refuse = |reason| Err(SensitivityError::Jump { s: event.s, reason });
            if event.jump {
                return refuse("a condition jumps over its limit");
            }
            let before = place.checked_sub(1).map_or(found.start(), |last| found.events[last].s);
            let behind = found.events.get(place + 1).map_or(f64::INFINITY, |next| next.s);
            let alone = before < event.s && event.s < behind;
            let is_branch = event.guard >= rules[event.from];
            if is_branch && !alone && event.before[self.n..] != event.after[self.n..] {
                return refuse("equations jump where something else happens");
            }
        }
        Ok(())
    }

    /// The events of the first rules of each mode and the end of a run, with their derivatives.
    fn places(
        &self,
        found: &Recording,
        parameters: &[f64],
        end_moves: bool,
        rules: &[usize],
    ) -> Vec<Moving> {
        let count = self.system.components.len();
        let inputs = Inputs { components: count, parameters: parameters.len(), fixed: true };
        let compile = |formulas: &[Formula]| {
            Program::compile(&self.system.graph, formulas, inputs).with(parameters)
        };
        let program = |mode: usize, rule: usize| {
            let own = &self.system.modes[mode].slopes[..self.n];
            compile(&[&self.moves[mode][rule][..], own].concat())
        };
        let programs = self.moves.iter().enumerate().map(|(mode, rules)| {
            (0..rules.len()).map(|rule| program(mode, rule)).collect::<Vec<_>>()
        });
        let programs: Vec<Vec<Program>> = programs.collect();
        let moving = |program: &Program, s: f64, state: &[f64]| {
            let mut values = vec![f64::NAN; self.by.len() + self.n];
            program.run(s, state, &mut values);
            let (s_by, slopes) = values.split_at(self.by.len());
            let by = |(k, shift): (usize, &f64)| {
                let own = &state[self.n * (k + 1)..self.n * (k + 2)];
                own.iter().zip(slopes).map(|(own, slope)| own + slope * shift).collect()
            };
            let state_by = s_by.iter().enumerate().map(by).collect();
            Moving { s, s_by: s_by.to_vec(), state: state[..self.n].to_vec(), state_by }
        };
        let mut places: Vec<Moving> = Vec::with_capacity(found.events.len() + 1);
        for event in found.events.iter().filter(|it| it.guard < rules[it.from]) {
            places.push(moving(&programs[event.from][event.guard], event.s, &event.before));
        }
        if !matches!(found.run.outcome, Outcome::EndedByGuard { .. }) {
            let own = &self.system.modes[found.run.mode].slopes[..self.n];
            let still = vec![Formula(0); self.by.len()];
            let shifts = if end_moves { &self.end_moves } else { &still };
            let mut end = moving(&compile(&[shifts, own].concat()), found.run.s, &found.run.state);
            if !end_moves || found.run.outcome != Outcome::ReachedEnd {
                end.s_by.fill(0.0);
                for (k, by) in end.state_by.iter_mut().enumerate() {
                    by.copy_from_slice(&found.run.state[self.n * (k + 1)..self.n * (k + 2)]);
                }
            }
            places.push(end);
        }
        places
    }
}
