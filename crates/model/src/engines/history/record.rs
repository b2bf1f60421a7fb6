//! The states of a run, part by part.

use std::ops::Range;

use stickslip_contact::{Regime, Side};
use stickslip_solver::method::Dense;
use stickslip_solver::{Observer, State, SwitchEvent};

use super::Snapshot;
use super::followed::{Begins, Followed};

/// The run of one contact.
#[derive(Clone, Debug)]
pub struct Record<S: Followed<N>, const N: usize> {
    system: S,
    /// Accepted steps in order.
    steps: Vec<Dense<N>>,
    parts: Vec<Part<S::Mode, N>>,
    /// The first part of every phase.
    phases: Vec<usize>,
    /// How long the overlap went on when the force had ended.
    flight: f64,
}

/// A part of a phase in which the equations are the same.
#[derive(Clone, Debug)]
struct Part<M, const N: usize> {
    mode: M,
    /// Time at which its clock was zero.
    since: f64,
    begin: State<N>,
    end: State<N>,
    /// Its steps among the steps of the record; an empty range if the part is too short for one.
    steps: Range<usize>,
}

/// What a [`Record`] of any system provides.
pub trait Course {
    /// Duration of the contact.
    fn duration(&self) -> f64;
    /// Number of phases.
    fn phases(&self) -> usize;
    /// Regime and side of a phase.
    fn phase(&self, phase: usize) -> (Regime, Side);
    /// The first moment of a phase.
    fn begin(&self, phase: usize) -> Snapshot;
    /// The last moment of a phase.
    fn end(&self, phase: usize) -> Snapshot;
    /// The moment at a time within the contact.
    fn at(&self, time: f64) -> Snapshot;
    /// See [`PhaseHistory::samples`](super::PhaseHistory::samples).
    fn samples(&self, phase: usize, intervals: usize) -> Vec<Snapshot>;
}

impl<S: Followed<N>, const N: usize> Record<S, N> {
    /// The record of a contact before its run, which fills it as an observer.
    pub fn before(system: S) -> Self {
        let (mode, begin) = (system.start().mode, system.before_start(0.0));
        let first = Part { mode, since: 0.0, begin, end: begin, steps: 0..0 };
        Self { system, steps: Vec::new(), parts: vec![first], phases: vec![0], flight: 0.0 }
    }

    /// The parts of a phase, at least one.
    fn parts(&self, phase: usize) -> &[Part<S::Mode, N>] {
        let end = self.phases.get(phase + 1).copied().unwrap_or(self.parts.len());
        &self.parts[self.phases[phase]..end]
    }

    fn snapshot(&self, part: &Part<S::Mode, N>, state: &State<N>) -> Snapshot {
        let snapshot = self.system.snapshot(part.mode, state);
        Snapshot { time: part.since + snapshot.time, ..snapshot }
    }

    /// The last moment at which there is a force.
    fn parting(&self) -> Snapshot {
        let last = &self.parts[self.parts.len() - 1];
        self.snapshot(last, &last.end)
    }

    /// The moment at a time when nothing pushes any more.
    fn flying(&self, time: f64) -> Snapshot {
        let parting = self.parting();
        Snapshot {
            time,
            compression: parting.compression + (time - parting.time) * parting.normal_velocity,
            normal_force: 0.0,
            spring: 0.0,
            tangential_force: 0.0,
            limit: 0.0,
            ..parting
        }
    }

    /// The state of a part at a time of its clock.
    fn state_at(&self, part: &Part<S::Mode, N>, elapsed: f64) -> State<N> {
        let steps = &self.steps[part.steps.clone()];
        let index = steps.partition_point(|step| step.at(0.0)[S::CLOCK] <= elapsed);
        let Some(step) = index.checked_sub(1).map(|index| &steps[index]) else {
            let starts = part.since == 0.0 && part.begin[S::CLOCK] == 0.0;
            return if starts { self.system.before_start(elapsed) } else { part.begin };
        };
        // Newton's method, kept inside a bracket, for the fraction of the step at this time.
        let (mut low, mut high) = (0.0, 1.0);
        let mut theta = 0.5;
        for _ in 0..60 {
            let state = step.at(theta);
            let excess = state[S::CLOCK] - elapsed;
            if excess > 0.0 {
                high = theta;
            } else {
                low = theta;
            }
            let newton = theta - excess / (self.system.clock_rate(&state) * step.size());
            let next = if low < newton && newton < high { newton } else { 0.5 * (low + high) };
            let moved = (next - theta).abs();
            theta = next;
            if moved <= f64::EPSILON {
                break;
            }
        }
        step.at(theta)
    }
}

impl<S: Followed<N>, const N: usize> Course for Record<S, N> {
    fn duration(&self) -> f64 {
        self.parting().time + self.flight
    }

    fn phases(&self) -> usize {
        self.phases.len()
    }

    fn phase(&self, phase: usize) -> (Regime, Side) {
        S::phase(self.parts(phase)[0].mode)
    }

    fn begin(&self, phase: usize) -> Snapshot {
        let part = &self.parts(phase)[0];
        self.snapshot(part, &part.begin)
    }

    fn end(&self, phase: usize) -> Snapshot {
        let parts = self.parts(phase);
        let part = &parts[parts.len() - 1];
        if phase + 1 == self.phases.len() && self.flight > 0.0 {
            return self.flying(self.duration());
        }
        self.snapshot(part, &part.end)
    }

    fn at(&self, time: f64) -> Snapshot {
        if time > self.parting().time {
            return self.flying(time);
        }
        let begins = |part: &Part<S::Mode, N>| part.since + part.begin[S::CLOCK];
        // The first part begins at time 0.
        let index = self.parts.partition_point(|part| begins(part) <= time).max(1) - 1;
        let part = &self.parts[index];
        self.snapshot(part, &self.state_at(part, time - part.since))
    }

    fn samples(&self, phase: usize, intervals: usize) -> Vec<Snapshot> {
        let parts = self.parts(phase);
        let steps = &self.steps[parts[0].steps.start..parts[parts.len() - 1].steps.end];
        let (from, length) = match (steps.first(), steps.last()) {
            (Some(first), Some(last)) => {
                (first.start(), last.start() + last.size() - first.start())
            }
            _ => (0.0, 0.0),
        };
        let inner = if steps.is_empty() { 1..1 } else { 1..intervals };
        let between = inner.map(|i| {
            let s = from + length * (i as f64 / intervals as f64);
            let index = steps.partition_point(|step| step.start() <= s).max(1) - 1;
            let theta = (s - steps[index].start()) / steps[index].size();
            let index = parts[0].steps.start + index;
            let part = parts.partition_point(|part| part.steps.end <= index).min(parts.len() - 1);
            self.snapshot(&parts[part], &self.steps[index].at(theta.clamp(0.0, 1.0)))
        });
        let first = std::iter::once(self.begin(phase));
        let mut samples: Vec<_> = first.chain(between).collect();
        if phase + 1 == self.phases.len() && self.flight > 0.0 {
            samples.push(self.parting());
        }
        samples.push(self.end(phase));
        samples
    }
}

impl<S: Followed<N>, const N: usize> Observer<S::Mode, N> for Record<S, N> {
    const WANTS_SEGMENTS: bool = true;

    fn on_segment(&mut self, _mode: S::Mode, step: &Dense<N>) {
        self.steps.push(*step);
    }

    fn on_switch(&mut self, event: &SwitchEvent<S::Mode, N>) {
        let begins = S::begins(event);
        let steps = self.steps.len();
        let Some(ended) = self.parts.last_mut() else { return };
        if begins == Begins::Nothing {
            return;
        }
        ended.end = event.before;
        ended.steps.end = steps;
        if begins == Begins::ContactEnd {
            self.flight = self.system.flight(event.from, &event.before);
            return;
        }
        let since = ended.since + event.before[S::CLOCK] - event.after[S::CLOCK];
        if begins == Begins::Phase {
            self.phases.push(self.parts.len());
        }
        let (begin, end) = (event.after, event.after);
        self.parts.push(Part { mode: event.to, since, begin, end, steps: steps..steps });
    }
}
