//! Orbits from a run that settles: its last events repeat.

use stickslip_expression::{InvalidValue, Runnable, Trigger};
use stickslip_solver::dynamic::{
    DynamicDense, DynamicEvent, DynamicObserver, DynamicRun, DynamicSwitch, run_dynamic_with,
};
use stickslip_solver::{EmbeddedPair, Options, Outcome, RunError};

use crate::admissible::is_note;
use crate::equations::{Draft, clock_values, enlarge, is_apart};
use crate::error::OrbitError;
use crate::find::{Guess, Orbits};
use crate::itinerary::Leg;
use crate::orbit::Orbit;
use crate::watch::Watched;

/// So many events of a run are looked at for one that repeats.
const MOST_EVENTS: usize = 400;
/// An orbit goes around again from states that differ by less, of their size.
const AGAIN: f64 = 1e-8;
/// How much repeated states may differ, of their size.
const REPEATS: f64 = 1e-4;

/// A run with its last events, without those that change nothing if there are others.
pub(crate) struct Settling {
    pub run: DynamicRun<usize>,
    pub last: Vec<DynamicSwitch<usize>>,
    /// The largest sizes of components in the whole time, and in its second half.
    pub sizes: [Vec<f64>; 2],
}

/// What is seen of a run.
struct Seen<'a> {
    events: Vec<DynamicSwitch<usize>>,
    sizes: [Vec<f64>; 2],
    /// The middle of the time.
    middle: f64,
    watched: Watched<'a>,
}

impl Seen<'_> {
    fn see(&mut self, s: f64, state: &[f64]) {
        let [whole, late] = &mut self.sizes;
        enlarge(whole, state);
        if s >= self.middle {
            enlarge(late, state);
        }
    }
}

impl DynamicObserver<usize> for Seen<'_> {
    const WANTS_SEGMENTS: bool = true;

    fn on_switch(&mut self, event: &DynamicEvent<'_, usize>) {
        self.events.push(event.to_switch());
    }
    fn stops(&self, s: f64) -> bool {
        self.watched.stops(s)
    }
    fn on_segment(&mut self, _: usize, dense: &DynamicDense<'_>) {
        self.see(dense.start(), dense.coefficients());
    }
    fn on_end(&mut self, _: usize, s: f64, state: &[f64]) {
        self.see(s, state);
    }
}

impl Orbits {
    /// The orbit to which a run from the start of the guess has settled after a time: its last
    /// events repeat. Its itinerary is not used.
    ///
    /// # Errors
    /// [`OrbitError`].
    pub fn settled(
        &self,
        parameters: &[f64],
        guess: &Guess<'_>,
        time: f64,
    ) -> Result<Orbit, OrbitError> {
        let runnable = self.start(parameters, guess)?;
        require_time("the time to settle", time)?;
        let start = runnable.start().s;
        let watched = Watched::over(&self.watch, [start, start + time]);
        let found = self.settling(&runnable, time, &self.options, watched);
        let found = found.map_err(|error| OrbitError::Run { segment: 0, error })?;
        self.require_wanted()?;
        let draft = self.repeated(parameters, &found);
        let orbit = self.once_around(&draft.ok_or(OrbitError::NotSettled {
            events: found.last.len(),
            tolerance: REPEATS,
            outcome: found.run.outcome,
        })?)?;
        Ok(self.earlier(&orbit, runnable.start().s).unwrap_or(orbit))
    }

    /// The same orbit some rounds earlier, if its system depends on the time: later, a change of a
    /// period moves its start by much. Nothing is to begin on the way.
    fn earlier(&self, orbit: &Orbit, earliest: f64) -> Option<Orbit> {
        let mut earliest = earliest;
        let mut is_timed = false;
        for rule in self.system.modes.iter().flat_map(|mode| &mode.rules) {
            match rule.trigger {
                Trigger::Every { period, phase } => {
                    let clock = clock_values(&self.system, &orbit.parameters, period, phase);
                    earliest = earliest.max(clock.ok()?[1]);
                    is_timed = true;
                }
                Trigger::At(_) => return None,
                Trigger::When(..) => {}
            }
        }
        let rounds = ((orbit.start - earliest) / orbit.period).floor();
        if !is_timed || rounds < 1.0 {
            return None;
        }
        let draft = orbit.draft();
        let found = self.solve(&Draft { start: draft.start - rounds * orbit.period, ..draft });
        found.ok().filter(|found| found.is_admissible() || !orbit.is_admissible())
    }

    /// A run from its start, for a time.
    pub(crate) fn settling(
        &self,
        runnable: &Runnable,
        time: f64,
        options: &Options,
        watched: Watched<'_>,
    ) -> Result<Settling, RunError> {
        let start = runnable.start();
        let sizes = [0, 1].map(|_| vec![0.0; start.state.len()]);
        let (events, middle) = (Vec::new(), start.s + 0.5 * time);
        let mut seen = Seen { events, sizes, middle, watched };
        let (pair, end) = (EmbeddedPair::Dop853, start.s + time);
        let run = run_dynamic_with(pair, runnable, start, end, options, &mut seen)?;
        let Seen { events: mut last, sizes, .. } = seen;
        let acts = |event: &DynamicSwitch<usize>| {
            let rule = &self.system.modes[event.from].rules[event.guard];
            !is_note(rule) || matches!(rule.trigger, Trigger::Every { .. })
        };
        // Where nothing else happens, rules that change nothing say where an orbit starts.
        if last.iter().any(acts) {
            last.retain(acts);
        }
        last.drain(..last.len().saturating_sub(MOST_EVENTS));
        Ok(Settling { run, last, sizes })
    }

    /// The orbit of a round. Where a run comes to it from one side and the other in turn, its round
    /// may go around twice, or more often.
    pub(crate) fn once_around(&self, round: &Draft) -> Result<Orbit, OrbitError> {
        let orbit = self.solve(round)?;
        let Draft { parameters, start, legs, states, durations } = orbit.draft();
        let mut sizes = vec![0.0; states[0].len()];
        let ends = orbit.segments.iter().map(|it| &it.end);
        states.iter().chain(ends).for_each(|state| enlarge(&mut sizes, state));
        let same = |one: usize, other: usize| {
            let mut parts = states[one].iter().zip(&states[other]).zip(&sizes).enumerate();
            let near = |x: f64, size: f64| x.abs() <= AGAIN * size;
            legs[one] == legs[other]
                && near(durations[one] - durations[other], orbit.period)
                && parts.all(|(place, ((x, y), size))| {
                    near(x - y, *size) || is_apart(&self.system, &legs, place)
                })
        };
        let m = legs.len();
        let again = |n: &usize| m % n == 0 && (*n..m).all(|k| same(k, k - n));
        let once = (1..m).find(again).and_then(|n| {
            let (legs, states) = (legs[..n].to_vec(), states[..n].to_vec());
            let durations = durations[..n].to_vec();
            self.solve(&Draft { parameters: parameters.clone(), start, legs, states, durations })
                .ok()
        });
        Ok(once.unwrap_or(orbit))
    }

    /// The last round of events that repeats at the end of a run. Events that accumulate, or end
    /// the run, do not.
    pub(crate) fn repeated(&self, parameters: &[f64], found: &Settling) -> Option<Draft> {
        let Settling { run, last, .. } = found;
        if matches!(run.outcome, Outcome::Zeno { .. } | Outcome::EndedByGuard { .. }) {
            return None;
        }
        let legs: Vec<Leg> = last.iter().map(leg).collect();
        let apart: Vec<bool> = (0..self.system.components.len())
            .map(|place| is_apart(&self.system, &legs, place))
            .collect();
        let same = |one: usize, other: usize| {
            let near =
                |(x, y): (&f64, &f64)| (x - y).abs() <= REPEATS * x.abs().max(y.abs()).max(REPEATS);
            let mut states = last[one].after.iter().zip(&last[other].after).zip(&apart);
            legs[one] == legs[other] && states.all(|(it, apart)| *apart || near(it))
        };
        let repeats = |m: &usize| {
            let rounds = (last.len() - 1) / m;
            rounds >= 2 && (last.len() - m..last.len()).all(|k| same(k, k - m))
        };
        let m = (1..last.len()).find(repeats)?;
        let round = &last[last.len() - m - 1..];
        Some(Draft {
            parameters: parameters.to_vec(),
            start: round[0].s,
            legs: legs[last.len() - m..].to_vec(),
            states: round[..m].iter().map(|it| it.after.clone()).collect(),
            durations: round.windows(2).map(|pair| pair[1].s - pair[0].s).collect(),
        })
    }
}

/// The leg that ends with an event.
pub(crate) fn leg(event: &DynamicSwitch<usize>) -> Leg {
    Leg { mode: event.from, rule: event.guard, next: event.to }
}

/// Refuses a length of time that is none.
pub(crate) fn require_time(name: &'static str, time: f64) -> Result<(), InvalidValue> {
    InvalidValue::check(name, time, "a finite number above 0", time.is_finite() && time > 0.0)
}
