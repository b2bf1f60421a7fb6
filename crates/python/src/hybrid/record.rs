//! What a run finds, as columns.

use std::sync::Arc;

use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyDictMethods};
use stickslip_solver::{
    DynamicDense, DynamicEvent, DynamicObserver, Grazing, Pole, Preempted, Rest,
};

use crate::hybrid::Job;
use crate::hybrid::segments::{Segments, fraction};
use crate::hybrid::trouble::Trouble;

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
    /// The mode, the time and the state at which the run has arrived for certain.
    last: (usize, f64, Vec<f64>),
    /// Whether a segment begins there or later.
    moved: bool,
    ended: bool,
    trouble: Arc<Trouble>,
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
    pub fn new(job: &Job, times: Option<Vec<f64>>, dense: bool) -> Self {
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
            last: job.start.clone(),
            moved: false,
            ended: false,
            trouble: job.system.trouble().clone(),
        }
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
        self.on_end(mode, s, &state);
    }

    /// Samples the times before `s` from the last segment.
    fn sample_until(&mut self, s: f64) {
        let Some((times, done)) = &mut self.times else { return };
        while let Some(&time) = times.get(*done)
            && (s - time) * self.direction > 0.0
        {
            *done += 1;
            if let Some((mode, dense)) = self.segments.last(self.last.2.len()) {
                self.points.push(mode, time, &dense.at(fraction(&dense, time)));
            }
        }
    }

    /// The columns, of which those of states are one state after another.
    pub fn columns(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let columns = PyDict::new(py);
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

impl<const SEGMENTS: bool> DynamicObserver<usize> for Record<SEGMENTS> {
    const WANTS_SEGMENTS: bool = SEGMENTS;

    fn on_switch(&mut self, event: &DynamicEvent<'_, usize>) {
        self.events.push(event);
        let changes = event.from != event.to || event.before != event.after;
        if changes {
            if self.times.is_none() && event.before != event.after {
                self.points.push(event.from, event.s, event.before);
            }
            self.last = (event.to, event.s, event.after.to_vec());
            self.moved = false;
        }
    }

    fn on_grazing(&mut self, touch: &Grazing<usize>) {
        self.touches.push((touch.s, touch.mode, touch.guard, touch.margin));
    }

    fn on_pole(&mut self, pole: &Pole<usize>) {
        self.poles.push((pole.s, pole.mode, pole.guard));
    }

    fn on_preempted(&mut self, preempted: &Preempted<usize>) {
        self.preempted.push((preempted.s, preempted.mode, preempted.guard));
    }

    fn on_rest(&mut self, rest: &Rest<usize>) {
        self.rests.push((rest.s, rest.error, rest.guard, rest.from, rest.to));
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

    fn stops(&self) -> bool {
        self.trouble.has_failed()
    }

    fn on_segment(&mut self, mode: usize, dense: &DynamicDense<'_>) {
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

    fn on_end(&mut self, mode: usize, s: f64, state: &[f64]) {
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
    fn push(&mut self, event: &DynamicEvent<'_, usize>) {
        self.times.push(event.s);
        self.guards.push(event.guard);
        self.from.push(event.from);
        self.to.push(event.to);
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
