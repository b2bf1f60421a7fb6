//! The margins of a free run.

use crate::error::RunError;
use crate::hybrid::{Direction, Guard, HybridSystem, Observer, Outcome, Start, SwitchEvent};
use crate::margin::name::{Exit, Hint, Margin, Place, Way};
use crate::margin::prescribed::{Kind, Taken, Watch, branch, sense, watch};
use crate::margin::rate::{Reach, derivative, stands};
use crate::margin::{Margins, NearMiss};
use crate::method::Method;
use crate::options::Options;
use crate::runs::run;

/// If the last phase is shorter than this part of the run, it may be about to vanish. Boundaries
/// get their names from runs 1e-9 beside them, where a vanishing phase is shorter than this. If the
/// phase does not vanish, the only cost is a longer run.
const SHORT: f64 = 1e-6;

/// Runs `system` freely and returns every margin that the run leaves.
///
/// The margins of a phase take one run over that phase for each of its guards, two for a guard that
/// does not bound the domain of its mode, and each extremum takes about one step more. A guard has
/// no margins behind a place where its rate cannot be followed, for instance because it is zero
/// from there on. A run that ends early has none at all, but
/// one that ends at [`Options::max_switches`] has those of its phases up to there.
///
/// # Errors
/// Those of [`run`].
pub fn margins<M, S, const N: usize, const G: usize>(
    method: M,
    system: &S,
    start: Start<S::Mode, N>,
    end: f64,
    options: &Options,
) -> Result<Margins, RunError>
where
    M: Method,
    S: HybridSystem<N, G>,
{
    let mut switches = Switches(Vec::new());
    let free = run(method, system, start, end, options, &mut switches)?;
    let Switches(switches) = switches;
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
    let mut listing =
        Listing { method, system, options, end, exits: Vec::new(), misses: Vec::new() };
    let mut phase = Phase { start, led_by: None, last: false };
    for k in 0..phases {
        let switch = switches.get(k);
        let exited = switch.map_or(free.s, |event| event.s);
        // If the last phase is about to vanish, the phase before it lasts to the end.
        let vanishes = k + 2 == phases && free.s - exited <= short;
        phase.last = switch.is_none() || vanishes;
        listing.phase(&phase, switch, exited, ended_by);
        if let Some(event) = switch {
            let start = Start { mode: event.to, s: event.s, state: event.after };
            phase = Phase { start, led_by: Some(event), last: false };
        }
    }
    found.near_misses = listing.misses;
    Ok(found)
}

/// Records the switches of a run.
struct Switches<Mode, const N: usize>(Vec<SwitchEvent<Mode, N>>);

impl<Mode: Copy, const N: usize> Observer<Mode, N> for Switches<Mode, N> {
    fn on_switch(&mut self, event: &SwitchEvent<Mode, N>) {
        self.0.push(*event);
    }
}

/// A phase of the free run.
struct Phase<'a, Mode, const N: usize> {
    start: Start<Mode, N>,
    /// The switch that led here.
    led_by: Option<&'a SwitchEvent<Mode, N>>,
    /// Whether the phase lasts to the end of the run, or nearly.
    last: bool,
}

/// Collects the margins of a free run, phase by phase.
struct Listing<'a, M, S> {
    method: M,
    system: &'a S,
    options: &'a Options,
    /// The end of the span.
    end: f64,
    /// The exits of the phases so far.
    exits: Vec<Exit>,
    misses: Vec<NearMiss>,
}

impl<M: Method, S> Listing<'_, M, S> {
    /// Lists the margins of a phase that ends at `exited`, with a `switch` if not with the run.
    fn phase<const N: usize, const G: usize>(
        &mut self,
        phase: &Phase<'_, S::Mode, N>,
        switch: Option<&SwitchEvent<S::Mode, N>>,
        exited: f64,
        ended_by: Option<usize>,
    ) where
        S: HybridSystem<N, G>,
    {
        let start = phase.start;
        let guards = self.guards(start.mode);
        let fires = switch.map(|event| event.guard);
        // The last extremum of the guard that fires, and its side of zero.
        let (mut passed, mut side) = (start.s, 0.0);
        for (guard, own) in guards.into_iter().enumerate() {
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
            let last = self.extrema(phase, exited, (guard, own));
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
            self.at_exit(&guards, event, exit);
            self.exits.push(exit);
        }
    }

    /// The guards of a mode, after those of the exits have fired.
    fn guards<const N: usize, const G: usize>(&self, mode: S::Mode) -> [Guard; G]
    where
        S: HybridSystem<N, G>,
    {
        let mut guards = self.system.guards(mode);
        for exit in &self.exits {
            guards[exit.guard] = guards[exit.guard].fired(1);
        }
        guards
    }

    /// The margin of a guard at the start of a phase, 0 if it has none.
    fn at_start<const N: usize, const G: usize>(
        &mut self,
        phase: &Phase<'_, S::Mode, N>,
        guard: usize,
    ) -> f64
    where
        S: HybridSystem<N, G>,
    {
        let Start { mode, s, state } = phase.start;
        let led_by = phase.led_by.filter(|event| {
            let from = (event.from, &event.before);
            stands(self.system, guard, s, from, (mode, &state))
        });
        let stands = led_by.is_some_and(|event| event.guard == guard);
        let was_on = |event: &SwitchEvent<S::Mode, N>| {
            self.system.guards(event.from)[guard].direction() != Direction::Off
        };
        // It has the same margin already where the phase before ended.
        let known = !stands && led_by.is_some_and(was_on);
        let reach = Reach::new::<M, S, N, G>(self.system, &phase.start, self.end, self.options);
        let at_zero = stands || self.system.guard_values(mode, s, &state)[guard] == 0.0;
        let order = self.system.guards(mode)[guard].zero_order().max(u32::from(at_zero));
        let (mode, which, place) = ((mode, self.options), (guard, order), (s, &state));
        let value =
            derivative::<M, S, N, G>(self.system, &reach, mode, which, place).unwrap_or(0.0);
        if !known {
            self.add(guard, Place::Start { derivative: order }, Taken { s, value });
        }
        value
    }

    /// The margins of a guard at its extrema in a phase. Returns the place of the last one.
    fn extrema<const N: usize, const G: usize>(
        &mut self,
        phase: &Phase<'_, S::Mode, N>,
        exited: f64,
        (guard, own): (usize, Guard),
    ) -> f64
    where
        S: HybridSystem<N, G>,
    {
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
                // Of a guard that may be on either side of zero, an extremum that is turned away
                // from zero is none that touches it.
                if bounds || at.value >= 0.0 {
                    self.add(guard, place, at);
                    last = last.max(at.s);
                }
            }
        }
        last
    }

    /// The margins of the other guards where a phase ends, and of the transition there.
    fn at_exit<const N: usize, const G: usize>(
        &mut self,
        guards: &[Guard; G],
        event: &SwitchEvent<S::Mode, N>,
        exit: Exit,
    ) where
        S: HybridSystem<N, G>,
    {
        let SwitchEvent { s, guard: fires, from, before, .. } = *event;
        let values = self.system.guard_values(from, s, &before);
        for guard in (0..G).filter(|&guard| guard != fires) {
            // A terminal guard would have ended the run, where the margin of the others is that at
            // the end.
            if guards[guard].direction() != Direction::Off && !guards[guard].ends_run() {
                let value = sense(guards[guard]) * values[guard];
                self.add(guard, Place::Exit(exit), Taken { s, value });
            }
        }
        let value = self.system.transition_condition(from, fires, s, &before);
        self.add(fires, Place::Branch(exit), Taken { s, value });
    }

    /// What is found from the start of a phase up to `until`; if the run fails, what it found
    /// before.
    fn watch<const N: usize, const G: usize>(
        &self,
        phase: &Phase<'_, S::Mode, N>,
        until: f64,
        what: (usize, Watch),
    ) -> Vec<Taken>
    where
        S: HybridSystem<N, G>,
    {
        watch(self.method, self.system, phase.start, until, self.options, &[], what)
            .unwrap_or_else(|(_, seen)| Some(seen))
            .map_or_else(Vec::new, |seen| seen.taken)
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
        // The guard has not fired before, so that its sign is that of its start.
        Direction::Either if at_start < 0.0 => Way::Rising,
        _ => Way::Falling,
    }
}
