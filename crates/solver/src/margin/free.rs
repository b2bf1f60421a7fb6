//! The margins of a free run.

use std::marker::PhantomData;

use crate::error::RunError;
use crate::events::Note;
use crate::hybrid::{Direction, Guard, Outcome};
use crate::lists::List;
use crate::margin::name::{Exit, Hint, Margin, Place, Way};
use crate::margin::prescribed::{Kind, Taken, Watch, branch, sense, watch};
use crate::margin::rate::{Reach, derivative};
use crate::margin::{Margins, NearMiss, guards_of, values_of};
use crate::method::Method;
use crate::options::Options;
use crate::runs::at_switches::AtSwitches;
use crate::runs::runner::run_any;
use crate::system::{PerGuard, System};

/// If the last phase is shorter than this part of the run, it may be about to vanish. Boundaries
/// get their names from runs 1e-9 beside them, where a vanishing phase is shorter than this. If the
/// phase does not vanish, the only cost is a longer run.
const SHORT: f64 = 1e-6;

/// The margins of a free run from a mode, a place and a state.
pub(super) fn margins<M: Method, S: System>(
    system: &S,
    (mode, s, state): (S::Mode, f64, &S::State),
    end: f64,
    options: &Options,
) -> Result<Margins, RunError> {
    let mut switches = Vec::new();
    let mut watcher = AtSwitches::new::<S>(false, |event| {
        let &Note { s, guard, from, to, ref before, ref after, .. } = event;
        let (before, after) = (before.clone(), after.clone());
        switches.push(Switch { s, guard, from, to, before, after });
        false
    });
    let free = run_any::<M, S, _>(system, (mode, s, state), end, options, &mut watcher)?;
    let start = Start { mode, s, state: state.clone() };
    let ended_by = match free.outcome {
        Outcome::EndedByGuard { guard } => Some(guard),
        _ => None,
    };
    let switches = &switches[..switches.len() - usize::from(ended_by.is_some())];
    let mut found = Margins {
        fired: switches.iter().map(|event| event.guard).collect(),
        near_misses: Vec::new(),
        outcome: free.outcome,
    };
    // What would follow the last switch does not matter if the run stops there.
    let phases = switches.len()
        + match free.outcome {
            Outcome::EndedByGuard { .. } | Outcome::ReachedEnd => 1,
            Outcome::SwitchLimit => 0,
            _ => return Ok(found),
        };
    let short = SHORT * (free.s - start.s);
    let (exits, misses, method) = (Vec::new(), Vec::new(), PhantomData::<M>);
    let mut listing = Listing { system, options, end, exits, misses, method };
    let mut phase = Phase { start, led_by: None, last: false };
    for k in 0..phases {
        let switch = switches.get(k);
        let exited = switch.map_or(free.s, |event| event.s);
        // If the last phase is about to vanish, the phase before it lasts to the end.
        let vanishes = k + 2 == phases && free.s - exited <= short;
        phase.last = switch.is_none() || vanishes;
        listing.phase(&phase, switch, exited, ended_by);
        if let Some(event) = switch {
            let start = Start { mode: event.to, s: event.s, state: event.after.clone() };
            phase = Phase { start, led_by: Some(event), last: false };
        }
    }
    found.near_misses = listing.misses;
    Ok(found)
}

/// A switch of the free run.
struct Switch<S: System> {
    s: f64,
    guard: usize,
    from: S::Mode,
    to: S::Mode,
    before: S::State,
    after: S::State,
}

/// Where a phase starts.
struct Start<S: System> {
    mode: S::Mode,
    s: f64,
    state: S::State,
}

/// A phase of the free run.
struct Phase<'a, S: System> {
    start: Start<S>,
    /// The switch that led here.
    led_by: Option<&'a Switch<S>>,
    /// Whether the phase lasts to the end of the run, or nearly.
    last: bool,
}

impl<S: System> Phase<'_, S> {
    /// The time after which clocks fire in the phase: what is due at the start of the run is too.
    fn since(&self) -> f64 {
        if self.led_by.is_none() { self.start.s.next_down() } else { self.start.s }
    }
}

/// Collects the margins of a free run, phase by phase.
struct Listing<'a, M, S> {
    system: &'a S,
    options: &'a Options,
    /// The end of the span.
    end: f64,
    /// The exits of the phases so far.
    exits: Vec<Exit>,
    misses: Vec<NearMiss>,
    method: PhantomData<M>,
}

impl<M: Method, S: System> Listing<'_, M, S> {
    /// Lists the margins of a phase that ends at `exited`, with a `switch` if not with the run.
    fn phase(
        &mut self,
        phase: &Phase<'_, S>,
        switch: Option<&Switch<S>>,
        exited: f64,
        ended_by: Option<usize>,
    ) {
        let start = &phase.start;
        let guards = self.guards(start.mode);
        let fires = switch.map(|event| event.guard);
        // The last extremum of the guard that fires, and its side of zero.
        let (mut passed, mut side) = (start.s, 0.0);
        for (guard, &own) in guards.parts().iter().enumerate() {
            if own.direction() == Direction::Off {
                continue;
            }
            let at_start = self.at_start(phase, guard);
            if fires == Some(guard) {
                side = at_start;
            }
            if exited <= start.s {
                continue;
            }
            let is_clock = own.direction() == Direction::Clock;
            let last = if is_clock { start.s } else { self.extrema(phase, exited, (guard, own)) };
            if fires == Some(guard) {
                passed = last;
            } else if phase.last && ended_by != Some(guard) {
                for at in self.watch(phase, self.end, (guard, Watch::End)) {
                    self.add(guard, Place::End, at);
                }
            }
        }
        if let Some(event) = switch {
            let after = if passed > start.s { 0.5 * (passed + exited) } else { start.s };
            let part = if after > start.s { (after - start.s) / (exited - start.s) } else { 0.0 };
            let exit = Exit {
                guard: event.guard,
                way: way(guards[event.guard], side, exited > start.s),
                branch: branch(self.system, event.from, event.guard, (event.s, &event.before)),
                after: Hint(after),
                part: Hint(part),
            };
            self.at_exit(guards.parts(), event, phase.since(), exit);
            self.exits.push(exit);
        }
    }

    /// The guards of a mode, after the guards of the exits have fired.
    fn guards(&self, mode: S::Mode) -> PerGuard<S, Guard> {
        let mut guards = guards_of(self.system, mode);
        for exit in &self.exits {
            // The mode may have fewer guards.
            if let Some(guard) = guards.parts_mut().get_mut(exit.guard) {
                *guard = guard.fired(1);
            }
        }
        guards
    }

    /// The margin of a guard at the start of a phase, 0 if it has none.
    fn at_start(&mut self, phase: &Phase<'_, S>, guard: usize) -> f64 {
        let &Start { mode, s, ref state } = &phase.start;
        let place = (mode, s, state);
        let value = values_of(self.system, mode, phase.since(), (s, state))[guard];
        let was_on = |event: &&Switch<S>| {
            let before = guards_of(self.system, event.from);
            before.parts().get(guard).is_some_and(|guard| guard.direction() != Direction::Off)
        };
        // Whether the guard has the same value before and after the transition. Its value in a mode
        // without it means nothing.
        let led_by = phase.led_by.filter(was_on).filter(|event| {
            let since = phase.since();
            values_of(self.system, event.from, since, (s, &event.before))[guard] == value
        });
        let stands = led_by.is_some_and(|event| event.guard == guard);
        // It has the same margin already where the phase before ended.
        let known = !stands && led_by.is_some();
        let reach = Reach::new::<M>(self.system, place, self.end, self.options);
        let at_zero = stands || value == 0.0;
        let declared = guards_of(self.system, mode)[guard].zero_order();
        let order = declared.max(u32::from(at_zero));
        let is_clock = guards_of(self.system, mode)[guard].direction() == Direction::Clock;
        let (mode, which, place) = ((mode, self.options), (guard, order), (s, state));
        let value = if is_clock {
            Some(value)
        } else {
            derivative::<M, S>(self.system, &reach, mode, which, place)
        };
        let value = value.unwrap_or(0.0);
        if !known {
            self.add(guard, Place::Start { derivative: order }, Taken { s, value });
        }
        value
    }

    /// The margins of a guard at its extrema in a phase. Returns the place of the last one.
    fn extrema(&mut self, phase: &Phase<'_, S>, exited: f64, (guard, own): (usize, Guard)) -> f64 {
        // Nothing else need end the run where a terminal guard is watched.
        let until = if phase.last && !own.ends_run() { self.end } else { exited };
        let bounds = own.direction() == Direction::Below;
        let kinds = if bounds { &[Kind::Minimum][..] } else { &[Kind::Minimum, Kind::Maximum] };
        let mut last = phase.start.s;
        for &kind in kinds {
            let what = Watch::Extrema { kind, enough: f64::INFINITY };
            let taken = self.watch(phase, until, (guard, what)).into_iter();
            for (number, at) in taken.take_while(|at| at.s < exited).enumerate() {
                let near = Hint(at.s);
                let place = match kind {
                    Kind::Minimum => Place::Minimum { near, number },
                    Kind::Maximum => Place::Maximum { near, number },
                };
                // A guard may be on either side of zero. An extremum that is turned away from zero
                // does not touch it.
                if bounds || at.value >= 0.0 {
                    self.add(guard, place, at);
                    last = last.max(at.s);
                }
            }
        }
        last
    }

    /// The margins of the other guards where a phase ends, and of the transition there.
    fn at_exit(&mut self, guards: &[Guard], event: &Switch<S>, since: f64, exit: Exit) {
        let &Switch { s, guard: fires, from, ref before, .. } = event;
        let values = values_of(self.system, from, since, (s, before));
        for guard in (0..guards.len()).filter(|&guard| guard != fires) {
            // A terminal guard would have ended the run, where the margin of the others is that at
            // the end.
            if guards[guard].direction() != Direction::Off && !guards[guard].ends_run() {
                let value = sense(guards[guard]) * values[guard];
                self.add(guard, Place::Exit(exit), Taken { s, value });
            }
        }
        let value = self.system.transition_condition(from, fires, s, before);
        self.add(fires, Place::Branch(exit), Taken { s, value });
    }

    /// The margins from the start of a phase up to `until`, or up to where the run fails.
    fn watch(&self, phase: &Phase<'_, S>, until: f64, what: (usize, Watch)) -> Vec<Taken> {
        let &Start { mode, s, ref state } = &phase.start;
        match watch::<M, S>(self.system, (mode, s, state), until, self.options, &[], what) {
            Ok(None) => Vec::new(),
            Ok(Some((_, seen))) | Err((_, seen)) => seen.taken,
        }
    }

    /// Adds a margin, unless it is not a number, or zero whatever the parameters are.
    fn add(&mut self, guard: usize, place: Place, Taken { s, value }: Taken) {
        if value != 0.0 && !value.is_nan() {
            let margin = Margin { exits: self.exits.clone(), guard, place };
            self.misses.push(NearMiss { margin, s, value });
        }
    }
}

/// How the guard of a switch fires, in a phase of this length.
fn way(own: Guard, at_start: f64, lasts: bool) -> Way {
    match own.direction() {
        Direction::Below if !lasts => Way::AtOnce,
        Direction::Rising => Way::Rising,
        // The guard has not fired before, so that it has the sign of its start.
        Direction::Either if at_start < 0.0 => Way::Rising,
        _ => Way::Falling,
    }
}
