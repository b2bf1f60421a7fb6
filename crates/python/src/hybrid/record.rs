//! What a run finds, as columns.

use std::collections::HashMap;
use std::sync::Arc;

use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyDictMethods};
use stickslip_solver::dynamic::{DynamicDense, DynamicEvent, DynamicObserver};
use stickslip_solver::sliding::{Refusal, SurfaceSide};
use stickslip_solver::{
    Grazing, Rest,
    hybrid::{Pole, Preempted},
};

use crate::background::Signals;
use crate::hybrid::segments::{Segments, fraction};
use crate::hybrid::system::System;
use crate::hybrid::trouble::Trouble;
use crate::hybrid::{Job, Regime};

/// Keeps what a run finds. With `SEGMENTS` it also receives dense output.
pub struct Record<const SEGMENTS: bool> {
    /// 1 if the run goes forwards, and −1 if it goes backwards.
    direction: f64,
    /// The end of the span.
    end: f64,
    /// The times at which the state is wanted, in the order of the run, and how many are done. All
    /// steps are recorded if there is no such list.
    times: Option<(Vec<f64>, usize)>,
    points: Points,
    events: Events,
    touches: Vec<(f64, usize, usize, f64)>,
    poles: Vec<(f64, usize, usize)>,
    preempted: Vec<(f64, usize, usize)>,
    rests: Vec<(f64, f64, usize, usize, usize)>,
    /// All segments if they are kept, and else the last one.
    segments: Segments,
    dense: bool,
    /// The modes so far; their places are the numbers by which they go here.
    seen: Vec<Regime>,
    numbers: HashMap<(usize, [i8; 4], bool), usize>,
    /// Where the run has led to where the solution does not go on.
    refusal: Option<(f64, Refusal)>,
    /// The mode, the time and the state at which the run has arrived for certain.
    last: (usize, f64, Vec<f64>),
    /// Whether a segment begins there or later.
    moved: bool,
    ended: bool,
    trouble: Arc<Trouble>,
    signals: Signals,
}

/// Modes and states at times.
#[derive(Default)]
struct Points {
    times: Vec<f64>,
    modes: Vec<usize>,
    states: Vec<f64>,
}

/// The events, as columns.
#[derive(Default)]
struct Events {
    times: Vec<f64>,
    guards: Vec<usize>,
    from: Vec<usize>,
    to: Vec<usize>,
    flatness: Vec<f64>,
    jump: Vec<bool>,
    simultaneous: Vec<Vec<usize>>,
    before: Vec<f64>,
    after: Vec<f64>,
}

impl<const SEGMENTS: bool> Record<SEGMENTS> {
    pub fn new(job: &Job, times: Option<Vec<f64>>, dense: bool, signals: Signals) -> Self {
        Self {
            direction: if job.forwards() { 1.0 } else { -1.0 },
            end: job.end,
            times: times.map(|times| (times, 0)),
            points: Points::default(),
            events: Events::default(),
            touches: Vec::new(),
            poles: Vec::new(),
            preempted: Vec::new(),
            rests: Vec::new(),
            segments: Segments::default(),
            dense,
            seen: Vec::new(),
            numbers: HashMap::new(),
            refusal: None,
            last: (0, job.start.s, job.start.state.clone()),
            moved: false,
            ended: false,
            trouble: job.system.system.trouble().clone(),
            signals,
        }
    }

    /// Begins with the mode at the start.
    pub fn begin(&mut self, mode: Regime) {
        self.last.0 = self.number(&mode);
    }

    /// Why the solution does not go on from where the run has ended, if it does not.
    pub fn refusal(&self) -> Option<(f64, Refusal)> {
        self.refusal
    }

    /// The number of a mode.
    fn number(&mut self, mode: &Regime) -> usize {
        let mut sides = [0; 4];
        sides.iter_mut().zip(mode.sides()).for_each(|(sign, &side)| *sign = sign_of(side));
        *self.numbers.entry((mode.own, sides, mode.is_unique())).or_insert_with(|| {
            self.seen.push(*mode);
            self.seen.len() - 1
        })
    }

    /// Whether nothing has been found.
    pub fn is_empty(&self) -> bool {
        let noticed = self.touches.len() + self.poles.len();
        self.segments.is_empty() && self.events.times.is_empty() && noticed == 0
    }

    /// Ends the record of a run that has failed, at the last place that is known.
    pub fn close(&mut self) {
        if self.ended {
            return;
        }
        if self.moved
            && let Some((mode, dense)) = self.segments.last(self.last.2.len())
        {
            self.last = (mode, dense.start() + dense.size(), dense.at(1.0));
        }
        let (mode, s, state) = self.last.clone();
        self.end_at(mode, s, &state);
    }

    /// Ends the record.
    fn end_at(&mut self, mode: usize, s: f64, state: &[f64]) {
        self.sample_until(s);
        if let Some((times, done)) = &mut self.times {
            while times.get(*done) == Some(&s) {
                *done += 1;
                self.points.push(mode, s, state);
            }
        }
        // A run that ends early ends with a point, whatever times are wanted.
        let early = (self.end - s) * self.direction > 0.0;
        let wanted = self.times.as_ref().is_none_or(|(times, _)| early && !times.is_empty());
        if wanted && !self.points.ends_at(mode, s, state) {
            self.points.push(mode, s, state);
        }
        self.last = (mode, s, state.to_vec());
        self.ended = true;
    }

    /// Samples the times before `s` from the last segment.
    fn sample_until(&mut self, s: f64) {
        let Some((times, done)) = &mut self.times else { return };
        while let Some(&time) = times.get(*done)
            && (s - time) * self.direction > 0.0
        {
            // A step may have many times.
            if self.signals.stop(time)
                && let Some(error) = self.signals.raised()
            {
                self.trouble.fail(error);
                return;
            }
            *done += 1;
            if let Some((mode, dense)) = self.segments.last(self.last.2.len()) {
                self.points.push(mode, time, &dense.at(fraction(&dense, time)));
            }
        }
    }

    /// The columns, of which those of states are one state after another.
    pub fn columns<'py>(self, py: Python<'py>, system: &System) -> PyResult<Bound<'py, PyDict>> {
        let columns = PyDict::new(py);
        let regimes = self.seen.iter().map(|seen| system.regime(seen.own));
        let (modes, variables): (Vec<_>, Vec<_>) = regimes.unzip();
        let sides = self.seen.iter().flat_map(Regime::sides);
        let sides: Vec<i8> = sides.copied().map(sign_of).collect();
        let unique: Vec<bool> = self.seen.iter().map(Regime::is_unique).collect();
        columns.set_item("seen_modes", modes.into_pyarray(py))?;
        columns.set_item("seen_variables", variables.concat().into_pyarray(py))?;
        columns.set_item("seen_sides", sides.into_pyarray(py))?;
        columns.set_item("seen_unique", unique.into_pyarray(py))?;
        let Points { times, modes, states } = self.points;
        columns.set_item("t", times.into_pyarray(py))?;
        columns.set_item("modes", modes.into_pyarray(py))?;
        columns.set_item("y", states.into_pyarray(py))?;
        let events = self.events;
        columns.set_item("event_times", events.times.into_pyarray(py))?;
        columns.set_item("event_guards", events.guards.into_pyarray(py))?;
        columns.set_item("event_from", events.from.into_pyarray(py))?;
        columns.set_item("event_to", events.to.into_pyarray(py))?;
        columns.set_item("event_flatness", events.flatness.into_pyarray(py))?;
        columns.set_item("event_jump", events.jump.into_pyarray(py))?;
        columns.set_item("event_simultaneous", events.simultaneous)?;
        columns.set_item("event_before", events.before.into_pyarray(py))?;
        columns.set_item("event_after", events.after.into_pyarray(py))?;
        columns.set_item("touches", self.touches)?;
        columns.set_item("poles", self.poles)?;
        columns.set_item("preempted", self.preempted)?;
        columns.set_item("rests", self.rests)?;
        columns.set_item("end_state", self.last.2.into_pyarray(py))?;
        columns.set_item("end_time", self.last.1)?;
        columns.set_item("end_mode", self.last.0)?;
        if self.dense {
            self.segments.columns(&columns)?;
        }
        Ok(columns)
    }
}

impl<const SEGMENTS: bool> DynamicObserver<Regime> for Record<SEGMENTS> {
    const WANTS_SEGMENTS: bool = SEGMENTS;

    fn on_switch(&mut self, event: &DynamicEvent<'_, Regime>) {
        let (from, to) = (self.number(&event.from), self.number(&event.to));
        self.events.push(event, from, to);
        if let Some(refusal) = event.to.refusal() {
            self.refusal = Some((event.s, refusal));
        }
        let changes = event.from != event.to || event.before != event.after;
        if changes {
            if self.times.is_none() && event.before != event.after {
                self.points.push(from, event.s, event.before);
            }
            self.last = (to, event.s, event.after.to_vec());
            self.moved = false;
        }
    }

    fn on_grazing(&mut self, touch: &Grazing<Regime>) {
        let mode = self.number(&touch.mode);
        self.touches.push((touch.s, mode, touch.guard, touch.margin));
    }

    fn on_pole(&mut self, pole: &Pole<Regime>) {
        let mode = self.number(&pole.mode);
        self.poles.push((pole.s, mode, pole.guard));
    }

    fn on_preempted(&mut self, preempted: &Preempted<Regime>) {
        let mode = self.number(&preempted.mode);
        self.preempted.push((preempted.s, mode, preempted.guard));
    }

    fn on_rest(&mut self, rest: &Rest<Regime>) {
        let (from, to) = (self.number(&rest.from), self.number(&rest.to));
        self.rests.push((rest.s, rest.error, rest.guard, from, to));
    }

    fn forget(&mut self, switches: usize) {
        let kept = self.events.times.len().saturating_sub(switches);
        let Some(&s) = self.events.times.get(kept) else { return };
        let n = self.last.2.len();
        let before = self.events.before[kept * n..(kept + 1) * n].to_vec();
        self.last = (self.events.from[kept], s, before);
        self.moved = false;
        while self.points.times.last() == Some(&s) {
            self.points.pop(n);
        }
        self.events.truncate(kept, n);
    }

    fn stops(&self, s: f64) -> bool {
        if self.signals.stop(s)
            && let Some(error) = self.signals.raised()
        {
            self.trouble.fail(error);
        }
        self.trouble.has_failed()
    }

    fn on_segment(&mut self, mode: Regime, dense: &DynamicDense<'_>) {
        let mode = self.number(&mode);
        if self.times.is_some() {
            self.sample_until(dense.start());
        } else {
            self.points.push(mode, dense.start(), &dense.at(0.0));
        }
        if self.dense {
            self.segments.push(mode, dense);
        } else {
            self.segments.replace(mode, dense);
        }
        self.moved = true;
    }

    fn on_end(&mut self, mode: Regime, s: f64, state: &[f64]) {
        let mode = self.number(&mode);
        self.end_at(mode, s, state);
    }
}

/// The sign by which a side goes in Python.
fn sign_of(side: SurfaceSide) -> i8 {
    match side {
        SurfaceSide::Above => 1,
        SurfaceSide::Below => -1,
        SurfaceSide::Sliding => 0,
    }
}

impl Points {
    fn push(&mut self, mode: usize, time: f64, state: &[f64]) {
        self.times.push(time);
        self.modes.push(mode);
        self.states.extend_from_slice(state);
    }

    fn pop(&mut self, n: usize) {
        self.times.pop();
        self.modes.pop();
        self.states.truncate(self.states.len().saturating_sub(n));
    }

    fn ends_at(&self, mode: usize, time: f64, state: &[f64]) -> bool {
        self.times.last() == Some(&time)
            && self.modes.last() == Some(&mode)
            && self.states.ends_with(state)
    }
}

impl Events {
    fn push(&mut self, event: &DynamicEvent<'_, Regime>, from: usize, to: usize) {
        self.times.push(event.s);
        self.guards.push(event.guard);
        self.from.push(from);
        self.to.push(to);
        self.flatness.push(event.flatness);
        self.jump.push(event.jump);
        self.simultaneous.push(event.simultaneous.to_vec());
        self.before.extend_from_slice(event.before);
        self.after.extend_from_slice(event.after);
    }

    /// Keeps the first `kept` events, with states of `n` components.
    fn truncate(&mut self, kept: usize, n: usize) {
        self.times.truncate(kept);
        self.guards.truncate(kept);
        self.from.truncate(kept);
        self.to.truncate(kept);
        self.flatness.truncate(kept);
        self.jump.truncate(kept);
        self.simultaneous.truncate(kept);
        self.before.truncate(kept * n);
        self.after.truncate(kept * n);
    }
}
