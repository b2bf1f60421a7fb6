//! A run of a system with everything that happened.

use stickslip_solver::dynamic::{
    DynamicObserver, DynamicRecorder, DynamicRun, DynamicSegment, DynamicSwitch, run_dynamic_with,
};
use stickslip_solver::{
    EmbeddedPair, Grazing, Options, Outcome, Rest, RunError,
    hybrid::{Pole, Preempted},
};

use crate::run::Runnable;

/// A run: how it ended, its events, and its state at every time.
#[derive(Clone, Debug)]
pub struct Recording {
    /// How the run ended.
    pub run: DynamicRun<usize>,
    /// What happened, in order. Events at the end of a run change nothing.
    pub events: Vec<DynamicSwitch<usize>>,
    /// Where guards touched zero, or nearly.
    pub touches: Vec<Grazing<usize>>,
    /// Where guards changed their sign at a pole.
    pub poles: Vec<Pole<usize>>,
    /// Where events accumulated and the run went on behind them.
    pub rests: Vec<Rest<usize>>,
    /// Rules that did not act, because another one had left their mode.
    pub preempted: Vec<Preempted<usize>>,
    start: f64,
    state: Vec<f64>,
    mode: usize,
    steps: Vec<DynamicSegment<usize>>,
}

/// A time in which a run was in one mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stay {
    /// The mode.
    pub mode: usize,
    /// When it began.
    pub from: f64,
    /// When it ended.
    pub to: f64,
}

/// How a run ended, in a word: `end` of its time, at a `rule`, at the `accumulation` of its events,
/// at the `event_limit` or the `step_limit`, or `stopped`.
#[must_use]
pub const fn outcome_name(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::ReachedEnd => "end",
        Outcome::EndedByGuard { .. } => "rule",
        Outcome::Zeno { .. } => "accumulation",
        Outcome::SwitchLimit => "event_limit",
        Outcome::StepLimit => "step_limit",
        Outcome::Stopped => "stopped",
    }
}

/// Ends a run where a function says so.
struct Until<'a>(&'a dyn Fn(f64) -> bool);

impl DynamicObserver<usize> for Until<'_> {
    fn stops(&self, s: f64) -> bool {
        (self.0)(s)
    }
}

impl Runnable {
    /// Runs the system from its start to `end`, and records everything.
    ///
    /// ```
    /// use stickslip_expression::System;
    /// use stickslip_solver::{EmbeddedPair, Options};
    ///
    /// let system = System::parse("state x = 1\nx' = -x\nwhen x falls through 0.5 \"half\"")?;
    /// let decay = system.with(&[])?;
    /// let found = decay.record(EmbeddedPair::Dop853, 2.0, &Options::default())?;
    /// assert!((found.events[0].s - 2.0_f64.ln()).abs() < 1e-10);
    /// assert!((found.at(1.5).expect("within the run")[0] - (-1.5_f64).exp()).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`RunError`], as of a run of any system.
    pub fn record(
        &self,
        method: EmbeddedPair,
        end: f64,
        options: &Options,
    ) -> Result<Recording, RunError> {
        self.record_unless(&|_| false, method, end, options)
    }

    /// As [`Self::record`], and stops where `stops`, which is called with the time after every step
    /// and every event, returns `true`.
    ///
    /// # Errors
    /// [`RunError`], as of a run of any system.
    pub fn record_unless(
        &self,
        stops: &dyn Fn(f64) -> bool,
        method: EmbeddedPair,
        end: f64,
        options: &Options,
    ) -> Result<Recording, RunError> {
        if let Some(branched) = self.with_branches()
            && let Ok(mut found) = branched.record_as_it_is(stops, method, end, options)
            && found.is_regular()
        {
            found.take_out(Hidden { groups: 1, own: self.state.len() }, &self.rules());
            return Ok(found);
        }
        self.record_as_it_is(stops, method, end, options)
    }

    /// The numbers of rules of all modes.
    fn rules(&self) -> Vec<usize> {
        self.modes.iter().map(|mode| mode.guards.len()).collect()
    }

    /// Records a run whose branches are no events.
    pub(crate) fn record_as_it_is(
        &self,
        stops: &dyn Fn(f64) -> bool,
        method: EmbeddedPair,
        end: f64,
        options: &Options,
    ) -> Result<Recording, RunError> {
        let start = self.start();
        let mut observer = (DynamicRecorder::default(), Until(stops));
        let run = run_dynamic_with(method, self, start, end, options, &mut observer)?;
        let (DynamicRecorder { switches, grazings, poles, preempted, rests, segments, .. }, _) =
            observer;
        let (events, touches, steps) = (switches, grazings, segments);
        let (state, mode, start) = (start.state.to_vec(), start.mode, start.s);
        Ok(Recording { run, events, touches, poles, rests, preempted, start, state, mode, steps })
    }
}

impl Runnable {
    /// Runs the system from its start to `end`, and appends its events, also those before an error:
    /// this takes a fifth less time than [`Self::record`], and the memory of events.
    ///
    /// # Errors
    /// [`RunError`], as of a run of any system.
    pub fn events(
        &self,
        method: EmbeddedPair,
        end: f64,
        options: &Options,
        events: &mut Vec<DynamicSwitch<usize>>,
    ) -> Result<DynamicRun<usize>, RunError> {
        if let Some(branched) = self.with_branches() {
            let (mut found, start) = (Vec::new(), branched.start());
            let run = run_dynamic_with(method, &branched, start, end, options, &mut found);
            if let Ok(mut run) = run
                && is_regular(run.outcome)
            {
                let (own, rules) = (self.state.len(), self.rules());
                found.retain(|event| event.guard < rules[event.from]);
                for event in &mut found {
                    event.before.truncate(own);
                    event.after.truncate(own);
                    event.simultaneous.retain(|guard| *guard < rules[event.from]);
                }
                run.state.truncate(own);
                events.append(&mut found);
                return Ok(run);
            }
        }
        run_dynamic_with(method, self, self.start(), end, options, events)
    }
}

/// Whether a run came to its end. Otherwise its branches may have followed one another without end.
const fn is_regular(outcome: Outcome) -> bool {
    matches!(outcome, Outcome::ReachedEnd | Outcome::EndedByGuard { .. })
}

/// Components that are not those of the system: behind the own ones of each group.
#[derive(Clone, Copy)]
pub(crate) struct Hidden {
    /// The number of groups of a state.
    pub groups: usize,
    /// The number of own components of a group.
    pub own: usize,
}

impl Hidden {
    fn take_out(self, states: &mut Vec<f64>, all: usize) {
        let each = all / self.groups.max(1);
        let mut place = 0;
        states.retain(|_| {
            place += 1;
            (place - 1) % each < self.own
        });
    }
}

impl Recording {
    fn is_regular(&self) -> bool {
        is_regular(self.run.outcome)
    }

    /// Takes out components that are hidden, and rules behind so many of each mode.
    pub(crate) fn take_out(&mut self, hidden: Hidden, rules: &[usize]) {
        let all = self.state.len();
        let is_own = |mode: usize, guard: usize| guard < rules[mode];
        self.events.retain(|event| is_own(event.from, event.guard));
        for event in &mut self.events {
            event.simultaneous.retain(|&guard| is_own(event.from, guard));
            hidden.take_out(&mut event.before, all);
            hidden.take_out(&mut event.after, all);
        }
        self.touches.retain(|touch| is_own(touch.mode, touch.guard));
        self.poles.retain(|pole| is_own(pole.mode, pole.guard));
        self.preempted.retain(|it| is_own(it.mode, it.guard));
        self.steps.iter_mut().for_each(|step| hidden.take_out(&mut step.coefficients, all));
        hidden.take_out(&mut self.run.state, all);
        hidden.take_out(&mut self.state, all);
    }

    /// Where the run started.
    #[must_use]
    pub fn start(&self) -> f64 {
        self.start
    }

    /// The steps of the run.
    #[must_use]
    pub fn steps(&self) -> &[DynamicSegment<usize>] {
        &self.steps
    }

    /// The state at a time of the run, and at an event the state behind it; `None` outside the run.
    #[must_use]
    pub fn at(&self, s: f64) -> Option<Vec<f64>> {
        if s == self.run.s {
            return Some(self.run.state.clone());
        }
        if !(self.start..self.run.s).contains(&s) {
            return None;
        }
        let behind = self.events.partition_point(|event| event.s <= s);
        let place = self.steps.partition_point(|step| step.s <= s);
        // A step may begin at an event, or somewhat before it: what it knows is the newer.
        let last = behind.checked_sub(1).map(|last| &self.events[last]).filter(|it| it.s == s);
        match (last, place.checked_sub(1)) {
            (Some(event), _) => Some(event.after.clone()),
            (None, None) => Some(self.state.clone()),
            (None, Some(last)) => Some(self.steps[last].at(s, self.state.len())),
        }
    }

    /// The modes of the run, in order. A mode that is entered anew is another stay only if it
    /// is another mode.
    #[must_use]
    pub fn stays(&self) -> Vec<Stay> {
        let mut stays = vec![Stay { mode: self.mode, from: self.start, to: self.run.s }];
        let mut rests = self.rests.iter().map(|rest| (rest.s, rest.to)).peekable();
        let mut moves = Vec::with_capacity(self.events.len());
        for event in &self.events {
            moves.extend(std::iter::from_fn(|| rests.next_if(|(s, _)| *s <= event.s)));
            moves.push((event.s, event.to));
        }
        for (s, mode) in moves.into_iter().chain(rests) {
            let last = stays.len() - 1;
            if mode != stays[last].mode {
                stays[last].to = s;
                stays.push(Stay { mode, from: s, to: self.run.s });
            }
        }
        stays
    }

    /// Times and states for a smooth curve: each step in so many parts, and both sides of events.
    #[must_use]
    pub fn curve(&self, parts: usize) -> Vec<(f64, Vec<f64>)> {
        let mut curve = vec![(self.start, self.state.clone())];
        let mut events = self.events.iter().peekable();
        // Steps end at events that change something; others lie within them.
        let changes =
            |event: &&DynamicSwitch<usize>| event.before != event.after || event.from != event.to;
        let mut changing = self.events.iter().filter(changes).peekable();
        let parts = parts.max(1);
        for step in &self.steps {
            while let Some(event) = events.next_if(|event| event.s <= step.s) {
                curve.push((event.s, event.before.clone()));
                curve.push((event.s, event.after.clone()));
            }
            while changing.next_if(|event| event.s <= step.s).is_some() {}
            let most = changing.peek().map_or(self.run.s, |event| event.s);
            for part in 1..=parts {
                let s = (step.s + step.h * part as f64 / parts as f64).min(most);
                while let Some(event) = events.next_if(|event| event.s < s) {
                    curve.push((event.s, event.before.clone()));
                }
                curve.push((s, step.at(s, self.state.len())));
            }
        }
        for event in events {
            curve.push((event.s, event.before.clone()));
            curve.push((event.s, event.after.clone()));
        }
        curve.push((self.run.s, self.run.state.clone()));
        curve
    }

    /// The mode at a time of the run, and at an event the mode behind it.
    #[must_use]
    pub fn mode_at(&self, s: f64) -> usize {
        let event = self.events.partition_point(|event| event.s <= s);
        let rest = self.rests.partition_point(|rest| rest.s <= s);
        let event = event.checked_sub(1).map(|last| &self.events[last]);
        match (event, rest.checked_sub(1).map(|last| &self.rests[last])) {
            (Some(event), Some(rest)) if event.s < rest.s => rest.to,
            (Some(event), _) => event.to,
            (None, Some(rest)) => rest.to,
            (None, None) => self.mode,
        }
    }
}
