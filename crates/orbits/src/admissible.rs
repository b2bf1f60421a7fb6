//! Whether a system follows an orbit by itself.
//!
//! Runs of the system, whose events are decided by bounds, go from the middle of a segment to the
//! middle of the next one, until they have covered the orbit. So each starts from an accurate
//! state, away from zeros of conditions, however unstable the orbit is. The rules that act must be
//! those of the itinerary, at their times, and lead to its modes. Beside a graze a condition is
//! zero twice within the error of these times: an orbit is followed up to the first zero, where the
//! condition has the rate with which its rule acts.

use stickslip_expression::{
    Compiled, InvalidValue, Next, Recording, Rule, Runnable, System, Trigger,
};
use stickslip_solver::dynamic::{DynamicSwitch, ReadableDynamic};
use stickslip_solver::{Direction, EmbeddedPair, Options, Outcome};

use crate::equations::{Draft, Equations};
use crate::error::OrbitError;
use crate::itinerary::Leg;
use crate::orbit::{Obstacle, Orbit, Verdict};

/// How far an event may be from its place, of the period.
const AWAY: f64 = 1e-6;
/// A rate below this part of what it is made of may be 0.
const HIDDEN: f64 = 1e-10;
/// A duration below this part of the period may be 0.
const ROUNDING: f64 = 1e-12;
/// Segments shorter than this part of the period are passed by the run of a longer one.
const SHORT: f64 = 1e-5;

/// A system whose modes may also be entered halfway: behind its own modes are copies in which no
/// condition starts from a zero, as conditions of the modes themselves may.
#[derive(Clone, Debug)]
pub(crate) struct Halfway {
    system: System,
    compiled: Compiled,
    /// The number of modes of the system itself.
    modes: usize,
}

impl Halfway {
    pub fn new(system: &System, compiled: &Compiled) -> Result<Self, InvalidValue> {
        let (mut system, modes) = (system.clone(), system.modes.len());
        // Zeros are found from the ways into a mode, and copies are further ways.
        let runnable = compiled.with(&system.values())?;
        let own = system.modes.clone();
        for (place, mode) in system.modes.iter_mut().enumerate() {
            let guards = ReadableDynamic::guards(&runnable, place);
            for (rule, guard) in mode.rules.iter_mut().zip(guards) {
                rule.from_zero = guard.zero_order();
            }
        }
        for (place, mut mode) in own.into_iter().enumerate() {
            for rule in &mut mode.rules {
                rule.from_zero = 0;
                if rule.next == Next::Stay && !is_note(rule) {
                    rule.next = Next::Mode(place);
                }
            }
            system.modes.push(mode);
        }
        let compiled = system.compile()?;
        Ok(Self { system, compiled, modes })
    }

    /// The system in a state of a mode.
    pub fn starting(
        &self,
        parameters: &[f64],
        mode: usize,
        s: f64,
        state: &[f64],
    ) -> Result<Runnable, InvalidValue> {
        self.compiled.with(parameters)?.starting(Some(mode + self.modes), Some(s), Some(state))
    }
}

/// Whether the system follows the orbit at a solution of its equations.
///
/// # Errors
/// The parameters cannot be used.
pub(crate) fn verdict(
    halfway @ Halfway { system, modes, .. }: &Halfway,
    equations: &Equations,
    orbit: &Orbit,
    options: &Options,
) -> Result<Verdict, OrbitError> {
    let draft = &orbit.draft();
    let period = draft.period();
    // Where two clocks tick at once, a segment has no length, but for rounding: the run decides.
    let is_backwards = |it: &f64| *it < -ROUNDING * period;
    if let Some(segment) = draft.durations.iter().position(is_backwards) {
        return Ok(Verdict::Virtual(Obstacle::Backwards { segment }));
    }
    let mut touches = None;
    for (segment, leg) in draft.legs.iter().enumerate() {
        let Trigger::When(_, direction) = leg.rule(system).trigger else { continue };
        let s = orbit.time(segment + 1);
        let event = equations.end(segment, &draft.parameters, (s, &orbit.segments[segment].end));
        let rate = if direction == Direction::Rising { -event.rate() } else { event.rate() };
        let rate = if direction == Direction::Either { -rate.abs() } else { rate };
        let rule = leg.rule;
        if rate > HIDDEN * event.rate_size() {
            return Ok(Verdict::Virtual(Obstacle::Acts { segment, rule, s }));
        }
        if event.grazes() {
            let name = leg.name(system);
            touches =
                Some(format!("the condition of rule `{name}` only touches zero at t = {s:?}"));
            if rate >= -HIDDEN * event.rate_size() {
                return Ok(Verdict::Undecided(touches.unwrap_or_default()));
            }
        }
    }
    let (m, starts) = (draft.legs.len(), draft.starts());
    let long: Vec<usize> = (0..m).filter(|&i| draft.durations[i] > SHORT * period).collect();
    let mut undecided = None;
    for (place, &from) in long.iter().enumerate() {
        let last = place + 1 == long.len();
        // Segments are counted on into the next round.
        let to = if last { long[0] + m } else { long[place + 1] };
        let time = |segment: usize| starts[segment % m] + period * (segment / m) as f64;
        let middle = |segment: usize| time(segment) + 0.5 * draft.durations[segment % m];
        let state = equations.within(draft, from, 0.5 * draft.durations[from])?;
        let leg = draft.legs[from];
        let own = halfway.starting(&draft.parameters, leg.mode, middle(from), &state)?;
        let expected: Vec<(usize, f64)> =
            (from..to).map(|i| (i % m, time(i) + draft.durations[i % m])).collect();
        let obstacle = |events: &[DynamicSwitch<usize>]| {
            obstacle((system, *modes), draft, (&expected, to), events).map(Verdict::Virtual)
        };
        let found = match own.record(EmbeddedPair::Dop853, middle(to), options) {
            Ok(found) => found,
            Err(error) => {
                // What acts before the run fails may be what the orbit does not allow.
                let mut events = Vec::new();
                let _ = own.events(EmbeddedPair::Dop853, middle(to), options, &mut events);
                let undecided = || Verdict::Undecided(system.explained(&error));
                let acts = obstacle(&events)
                    .filter(|it| !matches!(it, Verdict::Virtual(Obstacle::Idle { .. })));
                return Ok(acts.unwrap_or_else(undecided));
            }
        };
        match (obstacle(&found.events), &touches) {
            // Rounding hides that the condition becomes negative.
            (Some(Verdict::Virtual(Obstacle::Idle { .. })), Some(touches)) => {
                return Ok(Verdict::Undecided(touches.clone()));
            }
            (Some(obstacle), _) => return Ok(obstacle),
            (None, _) => {}
        }
        undecided = undecided.or_else(|| doubt(system, &found));
    }
    let undecided = undecided.or_else(|| later_clock(system, draft));
    Ok(undecided.map_or(Verdict::Admissible, Verdict::Undecided))
}

/// A clock that may act in a later period, though it does not act in the first one.
fn later_clock(system: &System, draft: &Draft) -> Option<String> {
    let clocks = draft.legs.iter().flat_map(|leg| {
        let rules = system.modes[leg.mode].rules.iter().enumerate();
        rules.map(|(place, rule)| (Leg { rule: place, ..*leg }, rule))
    });
    let mut later = clocks.filter(|(own, rule)| {
        let is_clock = !matches!(rule.trigger, Trigger::When(..));
        let known = draft.legs.iter().any(|leg| leg.rule(system).trigger == rule.trigger);
        is_clock && !is_note(rule) && !known && !draft.legs.contains(own)
    });
    let name = later.next()?.0.name(system);
    Some(format!("rule `{name}` acts at times that are not those of the orbit"))
}

/// Where a run does not do what is expected: events of segments at times, up to the middle of the
/// segment `to`, which may be one of the next round.
fn obstacle(
    (system, modes): (&System, usize),
    draft: &Draft,
    (expected, to): (&[(usize, f64)], usize),
    events: &[DynamicSwitch<usize>],
) -> Option<Obstacle> {
    let away = AWAY * draft.period();
    let mut expected = expected.iter().copied().peekable();
    for event in events {
        let next = expected.peek().copied();
        if let Some((segment, s)) = next {
            let leg = draft.legs[segment];
            let is_own = event.from % modes == leg.mode && event.guard == leg.rule;
            if is_own && (event.s - s).abs() <= away {
                expected.next();
                let to = event.to % modes;
                if to != leg.next {
                    return Some(Obstacle::Branches { segment, to });
                }
                continue;
            }
        }
        let rule = &system.modes[event.from].rules[event.guard];
        if !is_note(rule) {
            let m = draft.legs.len();
            let (segment, rounds) = next.map_or((to % m, to / m), |(segment, _)| (segment, 0));
            let s = event.s - draft.period() * rounds as f64;
            return Some(Obstacle::Acts { segment, rule: event.guard, s });
        }
    }
    expected.next().map(|(segment, _)| Obstacle::Idle { segment })
}

/// Whether a rule changes nothing.
pub(crate) fn is_note(rule: &Rule) -> bool {
    rule.next == Next::Stay
        && rule.changes.is_empty()
        && rule.rest.is_none()
        && rule.ends_after == 0
}

/// What rounding hides along a run.
fn doubt(system: &System, found: &Recording) -> Option<String> {
    let touch =
        found.touches.iter().find(|touch| !is_note(&system.modes[touch.mode].rules[touch.guard]));
    if let Some(touch) = touch {
        let rule = system.modes[touch.mode].rules[touch.guard].name(touch.guard);
        return Some(format!("rule `{rule}` nearly acts at t = {:?}", touch.s));
    }
    if found.run.outcome != Outcome::ReachedEnd {
        return Some("the run along a segment ends early".to_owned());
    }
    (!found.run.decided).then(|| "conditions are sampled".to_owned())
}
