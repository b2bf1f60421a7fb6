//! Lyapunov exponents through switches.
//!
//! Between events the variational equations carry directions along, and at an event saltation does
//! (Müller, *Chaos, Solitons & Fractals* 5, 1671, 1995). They are made orthogonal again at each
//! event, and between where they grow much (Benettin et al., *Meccanica* 15, 9, 1980).

use std::collections::HashMap;

use nalgebra::DMatrix;
use stickslip_expression::Graph;
use stickslip_solver::dynamic::{DynamicSwitch, run_dynamic_with};
use stickslip_solver::{EmbeddedPair, Outcome};

use super::{Switches, require_end, require_skip};
use crate::equations::{EventFormulas, Flow, is_apart};
use crate::error::OrbitError;
use crate::find::{Guess, Orbits};
use crate::itinerary::Leg;
use crate::settle::{leg, require_time};
use crate::watch::Watched;

/// Directions whose growths in one piece differ more are made orthogonal in its middle.
const MOST_GROWTH: f64 = 1e8;
/// A direction that an event makes shorter than this part of another one is lost.
const LOST: f64 = 1e-13;
/// A piece between events is no longer than this part of the time.
const PIECE: f64 = 1.0 / 64.0;

/// Lyapunov exponents of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Exponents {
    /// The exponents, the largest first: rates at which directions grow. Of systems without
    /// explicit time one is 0, and one is −∞ for each direction that is lost at events.
    pub values: Vec<f64>,
    /// The largest difference of an exponent between both halves of the time.
    pub spread: f64,
    /// The number of events in the time.
    pub events: usize,
}

impl Orbits {
    /// The Lyapunov exponents of a run from the start of the guess, in a time that follows another
    /// one in which it settles. Its itinerary is not used. Components that need not come back, as
    /// counters, are left out.
    ///
    /// # Errors
    /// [`OrbitError`]: the run does not come to its end, its events accumulate, or an event is a
    /// graze, where a direction grows without bound.
    pub fn exponents(
        &self,
        parameters: &[f64],
        guess: &Guess<'_>,
        skip: f64,
        time: f64,
    ) -> Result<Exponents, OrbitError> {
        require_skip(skip)?;
        require_time("the time of exponents", time)?;
        let runnable = self.start(parameters, guess)?;
        let (start, pair) = (runnable.start(), EmbeddedPair::Dop853);
        let from = start.s + skip;
        let mut found = Switches::from(Watched::over(&self.watch, [start.s, from + time]));
        let run = run_dynamic_with(pair, &runnable, start, from + time, &self.options, &mut found);
        let run = run.map_err(|error| OrbitError::Run { segment: 0, error })?;
        require_end(run.outcome, run.s)?;
        found.rest.map_or(Ok(()), |s| require_end(Outcome::Zeno { accumulation: s }, s))?;
        let events = found.events;
        let legs: Vec<Leg> = events.iter().map(leg).collect();
        let moving = (0..start.state.len()).filter(|k| !is_apart(&self.system, &legs, *k));
        let moving: Vec<usize> = moving.collect();
        if moving.is_empty() {
            return Ok(Exponents { values: Vec::new(), spread: 0.0, events: events.len() });
        }
        let carried = Watched::over(&self.watch, [start.s, run.s]);
        let mut carrier = Carrier::new(self, parameters, moving);
        let (mut mode, mut s, mut state) = (start.mode, start.s, start.state.to_vec());
        // What had grown by how much at the start, in the middle and at the end of the time.
        let mut marks = Vec::new();
        let stops = [from, from + 0.5 * time, run.s];
        let mut ahead = events.iter().peekable();
        for stop in stops {
            while s < stop || ahead.peek().is_some_and(|event| event.s < stop) {
                let event = ahead.next_if(|event| event.s < stop);
                let end = event.map_or(stop, |event| event.s);
                let parts = ((end - s) / (PIECE * time)).ceil().max(1.0);
                let duration = (end - s) / parts;
                let mut part = 0.0;
                while part < parts {
                    let at = (s + part * duration, &state[..]);
                    state = carrier.flow(mode, at, duration, PIECE * PIECE * time)?;
                    part += 1.0;
                    carried.stops(s + part * duration);
                }
                s = end;
                if let Some(event) = event {
                    carrier.cross(leg(event), event)?;
                    (mode, state) = (event.to, event.after.clone());
                }
            }
            marks.push((s, carrier.growth.clone()));
        }
        let events = events.iter().filter(|event| (from..run.s).contains(&event.s)).count();
        Ok(exponents(&marks, events))
    }
}

/// Exponents from what directions had grown by at some times.
fn exponents(marks: &[(f64, Vec<f64>)], events: usize) -> Exponents {
    let rates = |(from, before): &(f64, Vec<f64>), (to, after): &(f64, Vec<f64>)| {
        let all = before.iter().zip(after).map(|(before, after)| match *after {
            f64::NEG_INFINITY => f64::NEG_INFINITY,
            after => (after - before) / (to - from),
        });
        let mut all: Vec<f64> = all.collect();
        all.sort_by(|one, other| other.total_cmp(one));
        all
    };
    let values = rates(&marks[0], &marks[marks.len() - 1]);
    let halves = marks.windows(2).map(|pair| rates(&pair[0], &pair[1]));
    let differences = halves.flat_map(|half| {
        let own = values.iter().zip(half).filter(|(value, _)| value.is_finite());
        own.map(|(value, half)| (value - half).abs()).collect::<Vec<_>>()
    });
    Exponents { spread: differences.fold(0.0, f64::max), values, events }
}

/// Directions that are carried along a run.
struct Carrier<'a> {
    orbits: &'a Orbits,
    parameters: &'a [f64],
    graph: Graph,
    flows: HashMap<usize, Flow>,
    events: HashMap<Leg, EventFormulas>,
    /// The components that are not left out.
    moving: Vec<usize>,
    directions: DMatrix<f64>,
    /// The logarithm of what each direction has grown by.
    growth: Vec<f64>,
}

impl<'a> Carrier<'a> {
    fn new(orbits: &'a Orbits, parameters: &'a [f64], moving: Vec<usize>) -> Self {
        let count = moving.len();
        // Directions that no equation prefers.
        let any = DMatrix::from_fn(count, count, |i, j| (1.0 + (3 * i + 7 * j * j) as f64).sin());
        let directions = any.qr().q();
        let (graph, growth) = (orbits.system.graph.clone(), vec![0.0; count]);
        let (flows, events) = (HashMap::new(), HashMap::new());
        Self { orbits, parameters, graph, flows, events, moving, directions, growth }
    }

    /// Carries the directions along a mode, and returns the state.
    fn flow(
        &mut self,
        mode: usize,
        (s, state): (f64, &[f64]),
        duration: f64,
        least: f64,
    ) -> Result<Vec<f64>, OrbitError> {
        let Self { orbits, parameters, graph, .. } = self;
        orbits.require_wanted()?;
        let flow =
            self.flows.entry(mode).or_insert_with(|| Flow::new(graph, &orbits.system, mode, &[]));
        let flown = flow.run(parameters, (s, state), duration, &orbits.options);
        let flown = flown.map_err(|error| OrbitError::Run { segment: 0, error })?;
        let by = flown.by.select_rows(&self.moving).select_columns(&self.moving);
        let (directions, sizes) = orthogonal(&by * &self.directions);
        let (most, least_size) = extremes(&sizes);
        let is_little = most < MOST_GROWTH * least_size;
        if !is_little && duration > least {
            let half = 0.5 * duration;
            let middle = self.flow(mode, (s, state), half, least)?;
            return self.flow(mode, (s + half, &middle), half, least);
        }
        self.accept(directions, &sizes);
        Ok(flown.state)
    }

    /// Carries the directions across an event.
    fn cross(&mut self, leg: Leg, event: &DynamicSwitch<usize>) -> Result<(), OrbitError> {
        let Self { orbits, parameters, graph, .. } = self;
        let formulas = self
            .events
            .entry(leg)
            .or_insert_with(|| EventFormulas::new(graph, &orbits.system, leg, None, &[]));
        let across = formulas.at(parameters, event.s, &event.before).saltation();
        let across = across.select_rows(&self.moving).select_columns(&self.moving);
        if across.iter().any(|it| !it.is_finite()) {
            return Err(OrbitError::Grazes { rule: leg.name(&orbits.system), s: event.s });
        }
        let mut carried = across * &self.directions;
        let mut kept = self.moving.len();
        loop {
            let (directions, mut sizes) = orthogonal(carried.clone());
            let (most, _) = extremes(&sizes);
            let lost = |size: &f64| *size <= LOST * most;
            // A direction that is lost goes behind those that are not.
            if let Some(place) = sizes[..kept].iter().position(lost) {
                kept -= 1;
                for k in place..kept {
                    carried.swap_columns(k, k + 1);
                    self.growth.swap(k, k + 1);
                }
                continue;
            }
            sizes[kept..].fill(0.0);
            self.accept(directions, &sizes);
            return Ok(());
        }
    }

    fn accept(&mut self, directions: DMatrix<f64>, sizes: &[f64]) {
        self.directions = directions;
        self.growth.iter_mut().zip(sizes).for_each(|(growth, size)| *growth += size.ln());
    }
}

/// The directions of columns, orthogonal, and the length of each across those before it.
fn orthogonal(columns: DMatrix<f64>) -> (DMatrix<f64>, Vec<f64>) {
    let qr = columns.qr();
    let sizes = qr.r().diagonal().iter().map(|it| it.abs()).collect();
    (qr.q(), sizes)
}

/// The largest and the least size.
fn extremes(sizes: &[f64]) -> (f64, f64) {
    sizes
        .iter()
        .fold((0.0, f64::INFINITY), |(most, least), size| (most.max(*size), least.min(*size)))
}
