//! Runs with a prescribed itinerary, which watch a guard in their last phase.

use crate::error::RunError;
use crate::events::Note;
use crate::hybrid::{Direction, Guard, Outcome};
use crate::lists::{List, Shape};
use crate::margin::name::{Exit, Way};
use crate::margin::rate::{ROUNDING, Reach, derivative};
use crate::margin::{guards_of, values_of};
use crate::method::{Method, StepOf, TrialOf};
use crate::options::Options;
use crate::runs::at_switches::AtSwitches;
use crate::runs::runner::{End, run_any};
use crate::system::{PerComponent, PerGuard, System};
use stickslip_number::{Enclosure, Interval};

/// What a run watches in the phase after its last exit.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Watch {
    /// A derivative of the guard at the start of the phase.
    Start { derivative: u32 },
    /// The minima of the guard, or its maxima, up to the first one after `enough`.
    Extrema { kind: Kind, enough: f64 },
    /// The guard at the last exit.
    Exit,
    /// The condition of the transition at the last exit.
    Branch,
    /// The guard at the end of the run.
    End,
    /// No guard.
    Nothing,
}

/// On which side of zero an extremum is watched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Where the guard comes nearest to firing.
    Minimum,
    /// Where it comes nearest to the side from which it fires.
    Maximum,
}

/// A guard at a place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Taken {
    pub s: f64,
    pub value: f64,
}

/// What a prescribed run finds about the guard that it watches.
pub(super) struct Watched {
    /// The places of the prescribed exits.
    pub exits: Vec<f64>,
    /// The values that were watched, in order.
    pub taken: Vec<Taken>,
}

/// A run that has followed its exits, and what it found.
type Ended<S> = (End<S>, Watched);

/// Follows `exits` and then watches `guard`. The result is `None` if the run does not follow all
/// exits. If the run fails while it looks for extrema, the second result holds the extrema before.
pub(super) fn watch<M: Method, S: System>(
    system: &S,
    (mode, s, y): (S::Mode, f64, &S::State),
    end: f64,
    options: &Options,
    exits: &[Exit],
    (guard, watch): (usize, Watch),
) -> Result<Option<Ended<S>>, (RunError, Watched)> {
    let reach = Reach::new::<M>(system, (mode, s, y), end, options);
    let prescribed = Prescribed { system, exits, watched: guard, watch, reach };
    // In a prescribed run, switches may be as close together as they like, and there are more of
    // them: places and extrema count too.
    let limits = (usize::MAX, usize::MAX);
    let (max_switches, max_at_one_instant) = limits;
    let options = Options { zeno: 0.0, max_switches, max_at_one_instant, ..*options };
    let mut seen = Watched { exits: Vec::with_capacity(exits.len()), taken: Vec::new() };
    let mode = prescribed.enter(mode, 0, s);
    let lost = mode.progress == Progress::Lost;
    let mut watcher = AtSwitches::new::<Prescribed<'_, S>>(lost, |event| {
        prescribed.record(event, &mut seen);
        event.to.progress == Progress::Lost
    });
    let ended = run_any::<M, _, _>(&prescribed, (mode, s, y), end, &options, &mut watcher);
    let run = match ended {
        Ok(run) => run,
        Err(error) => return Err((error, seen)),
    };
    if run.mode.progress == Progress::Lost || seen.exits.len() < exits.len() {
        return Ok(None);
    }
    seen.taken.extend(prescribed.at_last::<M>(&run, &options));
    if let Some(&Taken { s, .. }) = seen.taken.iter().find(|taken| taken.value.is_nan()) {
        return Err((RunError::GuardNotANumber { guard, s }, seen));
    }
    let End { outcome, s, mode, state, decided, statistics } = run;
    Ok(Some((End { outcome, s, mode: mode.mode, state, decided, statistics }, seen)))
}

/// Whether the condition of a transition is positive; `None` if the transition has no condition.
pub(super) fn branch<S: System>(
    system: &S,
    mode: S::Mode,
    guard: usize,
    (s, y): (f64, &S::State),
) -> Option<bool> {
    let condition = system.transition_condition(mode, guard, s, y);
    (!condition.is_nan()).then_some(condition > 0.0)
}

/// The sign with which a guard is multiplied, so that it is positive where it does not fire.
pub(super) fn sense(guard: Guard) -> f64 {
    if guard.direction() == Direction::Rising { -1.0 } else { 1.0 }
}

/// A system whose guards fire only as prescribed. The value of one guard, the subject, is replaced
/// by what the run waits for: a place, the guard itself, or its rate.
struct Prescribed<'a, S: System> {
    system: &'a S,
    exits: &'a [Exit],
    /// The guard to watch after all exits.
    watched: usize,
    watch: Watch,
    reach: Reach<S>,
}

/// A mode of the system and the progress of the prescribed run.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PhaseMode<Mode> {
    mode: Mode,
    /// The number of exits that have happened.
    phase: usize,
    progress: Progress,
    /// Where the phase began.
    began: f64,
    /// The order of the zero from which the subject starts there.
    order: u32,
    /// Whether the subject fires where it rises.
    rises: bool,
}

/// The progress within a phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Progress {
    /// Nothing that the run waits for has happened yet.
    Start,
    /// The run has passed the place after which the guard of the exit may fire.
    Armed,
    /// The guard that is watched has approached zero by more than rounding, and does so no more:
    /// its next extremum is near.
    Near,
    /// The run has passed an extremum of the guard that it watches, where its rate, with what may
    /// be rounding, is zero.
    Extremum,
    /// The run has passed an extremum, and the rate with what may be rounding is positive there.
    Passed,
    /// The run has passed the last extremum that it has to find.
    Done,
    /// The run cannot follow the exits.
    Lost,
}

/// What the run waits for.
#[derive(Clone, Copy)]
enum Awaited {
    /// The run waits for this place.
    Place(f64),
    /// The run waits for the subject to fire in this way.
    Guard(Way),
    /// The run waits for an extremum of the subject.
    Extremum(Kind),
    /// The run waits for its end.
    End,
    /// The run waits for nothing any more.
    Nothing,
}

impl<Mode> PhaseMode<Mode> {
    /// The time after which clocks fire in this phase: what is due at the start of a run is too.
    fn since(&self) -> f64 {
        if self.phase == 0 { self.began.next_down() } else { self.began }
    }
}

impl<S: System> Prescribed<'_, S> {
    /// The time of a clock in this phase, if the guard is a clock.
    fn due(&self, at: &PhaseMode<S::Mode>, guard: usize) -> Option<f64> {
        let guards = guards_of(self.system, at.mode);
        let is_clock =
            guards.parts().get(guard).is_some_and(|guard| guard.direction() == Direction::Clock);
        is_clock.then(|| self.system.next_time(at.mode, guard, at.since()))
    }

    /// Whether the guard is watched in this phase.
    fn is_last(&self, phase: usize) -> bool {
        let at_exit = matches!(self.watch, Watch::Exit | Watch::Branch);
        phase + usize::from(at_exit) == self.exits.len()
    }

    /// The subject, which is the guard that counts, and what the run waits for.
    fn subject(&self, at: &PhaseMode<S::Mode>) -> (usize, Awaited) {
        let stopped = matches!(at.progress, Progress::Done | Progress::Lost);
        let awaited = match (self.exits.get(at.phase), self.watch) {
            (Some(exit), _) if !stopped => {
                let passes = at.progress == Progress::Start && exit.part.0 > 0.0;
                let place = Awaited::Place(exit.after.0);
                return (exit.guard, if passes { place } else { Awaited::Guard(exit.way) });
            }
            (None, Watch::Extrema { kind, .. }) if !stopped => Awaited::Extremum(kind),
            (None, Watch::End | Watch::Nothing) if !stopped => Awaited::End,
            _ => Awaited::Nothing,
        };
        (self.watched, awaited)
    }

    /// The beginning of a phase in `mode`. The run is lost if the guard that counts is not part of
    /// the mode.
    fn enter(&self, mode: S::Mode, phase: usize, began: f64) -> PhaseMode<S::Mode> {
        let progress = Progress::Start;
        let at = PhaseMode { mode, phase, progress, began, order: 0, rises: false };
        let (subject, guards) = (self.subject(&at).0, guards_of(self.system, mode));
        let own = |guard: usize| guards.parts().get(guard).copied().unwrap_or(Guard::OFF);
        let off = |guard: usize| own(guard).direction() == Direction::Off;
        let watches = self.is_last(phase) && self.watch != Watch::Nothing;
        let waits = watches || phase < self.exits.len();
        let lost = (waits && off(subject)) || (watches && off(self.watched));
        let progress = if lost { Progress::Lost } else { Progress::Start };
        let rises = own(subject).direction() == Direction::Rising;
        PhaseMode { progress, order: own(subject).zero_order(), rises, ..at }
    }

    /// The rate of the subject, positive where it moves away from an extremum, and the part of it
    /// that may be rounding.
    fn rate(
        &self,
        at: &PhaseMode<S::Mode>,
        (subject, kind): (usize, Kind),
        place: (f64, &S::State),
    ) -> (f64, f64) {
        let (system, guard) = (self.system, (at.mode, subject));
        // Where a zero is divided out, that rounds more.
        let (rate, rounding) = match at.order {
            0 => self.reach.rate_and_rounding(system, guard, place),
            _ => (self.reach.rate(system, guard, place), 0.0),
        };
        (if at.rises == (kind == Kind::Minimum) { -rate } else { rate }, rounding)
    }

    /// The guard that is watched, or its extremum, with the zero from which it starts divided out.
    fn divided(at: &PhaseMode<S::Mode>, s: f64, value: f64) -> f64 {
        #[expect(clippy::cast_possible_wrap, reason = "an order is a small number")]
        let power = (s - at.began).powi(at.order as i32);
        if at.order == 0 { value } else { value / power }
    }

    /// The value of the guard that is watched, positive where it does not fire.
    fn value(&self, at: &PhaseMode<S::Mode>, s: f64, y: &S::State) -> f64 {
        let (mode, since) = (at.mode, at.since());
        let sign = sense(guards_of(self.system, mode)[self.watched]);
        sign * values_of(self.system, mode, since, (s, y))[self.watched]
    }

    /// What follows the zero of the rate of `subject`, with what may be rounding, or of the rate
    /// itself.
    fn after_zero(
        &self,
        at: &PhaseMode<S::Mode>,
        (subject, kind): (usize, Kind),
        (s, y): (f64, &S::State),
    ) -> Progress {
        let (rate, rounding) =
            if at.order == 0 { self.rate(at, (subject, kind), (s, y)) } else { (0.0, 0.0) };
        let rounds = rounding > 0.0;
        if at.progress != Progress::Near && rounds && rate < 0.0 {
            return Progress::Near;
        }
        match self.watch {
            Watch::Extrema { enough, .. } if s < enough => {}
            _ => return Progress::Done,
        }
        let positive = rounds && rate > -0.5 * rounding;
        if positive { Progress::Passed } else { Progress::Extremum }
    }

    /// Records the exits, and the extrema of the guard that is watched.
    fn record(&self, event: &Note<Self>, seen: &mut Watched) {
        let at = &event.from;
        let (guard, awaited) = self.subject(at);
        if event.guard != guard {
            return;
        }
        match awaited {
            Awaited::Place(_) | Awaited::End | Awaited::Nothing => {}
            Awaited::Guard(_) => seen.exits.push(event.s),
            Awaited::Extremum(_) if event.to.progress == Progress::Near => {}
            Awaited::Extremum(kind) => {
                let value = self.value(at, event.s, &event.before);
                let value = Self::divided(at, event.s, value);
                let value = if kind == Kind::Minimum { value } else { -value };
                seen.taken.push(Taken { s: event.s, value });
            }
        }
    }

    /// The margin at the end of the run, if it is watched there.
    fn at_last<M: Method>(&self, run: &End<Self>, options: &Options) -> Option<Taken> {
        let (at, mode, s, y) = (&run.mode, run.mode.mode, run.s, &run.state);
        let regular = matches!(run.outcome, Outcome::EndedByGuard { .. } | Outcome::ReachedEnd);
        let value = match self.watch {
            Watch::Start { .. } if self.due(at, self.watched).is_some() => self.value(at, s, y),
            Watch::Start { derivative: which } => {
                let (mode, which) = ((mode, options), (self.watched, which));
                derivative::<M, S>(self.system, &self.reach, mode, which, (s, y))?
            }
            Watch::Exit => self.value(at, s, y),
            Watch::Branch => self.system.transition_condition(mode, self.watched, s, y),
            Watch::End if regular => self.value(at, s, y),
            Watch::End | Watch::Extrema { .. } | Watch::Nothing => return None,
        };
        Some(Taken { s, value })
    }
}

impl<S: System> System for Prescribed<'_, S> {
    type Mode = PhaseMode<S::Mode>;
    type State = S::State;
    type Components = S::Components;
    type Guards = S::Guards;
    const READABLE: bool = false;

    #[inline]
    fn field(&self, at: Self::Mode, s: f64, y: &S::State, slope: &mut S::State) {
        self.system.field(at.mode, s, y, slope);
    }

    fn guards(&self, at: Self::Mode, guards: &mut PerGuard<S, Guard>) {
        let (subject, awaited) = self.subject(&at);
        self.system.guards(at.mode, guards);
        for exit in &self.exits[..at.phase.min(self.exits.len())] {
            if let Some(guard) = guards.parts_mut().get_mut(exit.guard) {
                *guard = guard.fired(1);
            }
        }
        let last = self.is_last(at.phase);
        let guard_of = |guard: usize, own: &Guard| {
            // A zero at the start of the phase matters only there.
            let order = if at.progress == Progress::Start { own.zero_order() } else { 0 };
            let watched = self.watch != Watch::Nothing && guard == self.watched;
            if own.ends_run() && !(last && watched) {
                return Guard::new(own.direction()).from_zero(order).terminal();
            }
            if guard != subject {
                return Guard::OFF;
            }
            match awaited {
                Awaited::Place(_) => Guard::new(Direction::Below),
                Awaited::Guard(way) => {
                    // Not `Below`: after a graze it may still be negative, and must rise first.
                    let guard = match way {
                        Way::AtOnce => Guard::new(Direction::Below),
                        Way::Falling | Way::Rising => {
                            Guard::new(Direction::Falling).from_zero(order)
                        }
                    };
                    if last { guard.terminal() } else { guard }
                }
                Awaited::Extremum(_) => {
                    // The rate rises from zero after a minimum.
                    let after_minimum = at.progress == Progress::Extremum;
                    let order = u32::from(after_minimum);
                    Guard::new(Direction::Rising).from_zero(order)
                }
                Awaited::End => Guard::OFF,
                Awaited::Nothing => Guard::new(Direction::Below).terminal(),
            }
        };
        for (guard, own) in guards.parts_mut().iter_mut().enumerate() {
            // Place and rate of a smooth guard are smooth too.
            *own = guard_of(guard, own).as_smooth_as(own);
        }
    }

    #[inline]
    fn guard_values(&self, at: Self::Mode, s: f64, y: &S::State, values: &mut PerGuard<S, f64>) {
        let (subject, awaited) = self.subject(&at);
        self.system.guard_values(at.mode, s, y, values);
        // The mode may have fewer guards.
        let Some(value) = values.parts_mut().get_mut(subject) else { return };
        if let Some(due) = self.due(&at, subject) {
            *value = due - s;
        }
        *value = match awaited {
            Awaited::Place(place) => place - s,
            Awaited::Guard(Way::Falling) | Awaited::End => *value,
            Awaited::Guard(Way::Rising) => -*value,
            Awaited::Extremum(kind) => {
                let (rate, rounding) = self.rate(&at, (subject, kind), (s, y));
                let (rate, rounding) = match at.order {
                    0 if at.progress == Progress::Near => (rate, 0.0),
                    // Only what cannot be rounding counts as an approach to zero.
                    0 => (rate, rounding),
                    // The zero is divided out. Both terms are nearly equal soon after it.
                    order => {
                        let (since, due) = (s - at.began, *value * f64::from(order));
                        let due = if at.rises == (kind == Kind::Minimum) { -due } else { due };
                        let terms = rate.abs() * (since + s.abs() / 16.0) + due.abs();
                        (rate * since - due, ROUNDING * terms)
                    }
                };
                // A guard that does not change, or by less than its rounding, has passed its
                // extremum.
                let rate = rate + rounding;
                if rate == 0.0 { f64::MIN_POSITIVE } else { rate }
            }
            Awaited::Guard(Way::AtOnce) | Awaited::Nothing => -1.0,
        };
    }

    fn enclose(
        &self,
        _: Self::Mode,
        _: Enclosure,
        _: &PerComponent<S, Enclosure>,
    ) -> PerGuard<S, Enclosure> {
        List::of(0, Enclosure::ENTIRE)
    }

    fn reads(&self, at: Self::Mode) -> <S::Components as Shape>::Read {
        self.system.reads(at.mode)
    }

    fn guard_rates(&self, _: Self::Mode, _: f64, _: &S::State, rates: &mut PerGuard<S, f64>) {
        rates.parts_mut().fill(f64::NAN);
    }

    fn enclose_rate(&self, _: Self::Mode, _: f64, _: &S::State, _: usize) -> Interval {
        Interval::ENTIRE
    }

    fn transition_condition(&self, _: Self::Mode, _: usize, _: f64, _: &S::State) -> f64 {
        f64::NAN
    }

    fn longest_first_step(&self, at: Self::Mode, s: f64, y: &S::State) -> f64 {
        self.system.longest_first_step(at.mode, s, y)
    }

    fn rest(&self, _: Self::Mode, _: usize, _: f64, _: &mut S::State) -> Option<Self::Mode> {
        None
    }

    fn counter(&self, at: Self::Mode, guard: usize) -> usize {
        self.system.counter(at.mode, guard)
    }

    fn next_time(&self, at: Self::Mode, guard: usize, s: f64) -> f64 {
        self.system.next_time(at.mode, guard, s)
    }

    fn settle(&self, at: Self::Mode, y: &S::State) -> Self::Mode {
        PhaseMode { mode: self.system.settle(at.mode, y), ..at }
    }

    fn step<M: Method>(
        &self,
        at: Self::Mode,
        trial: &TrialOf<'_, S::State>,
        step: &mut StepOf<S::State>,
    ) {
        let moved = self.reach.follow(trial.s);
        if moved
            && at.order == 0
            && let (subject, Awaited::Extremum(_)) = self.subject(&at)
        {
            self.reach.measure(self.system, (at.mode, subject), trial);
        }
        self.system.step::<M>(at.mode, trial, step);
    }

    fn transition(&self, at: Self::Mode, guard: usize, s: f64, y: &mut S::State) -> Self::Mode {
        let (subject, awaited) = self.subject(&at);
        let progress = match awaited {
            Awaited::Guard(_)
                if self.exits[at.phase].branch != branch(self.system, at.mode, guard, (s, y)) =>
            {
                Progress::Lost
            }
            Awaited::Guard(_) => {
                let mode = self.system.transition(at.mode, guard, s, y);
                // A clock knows its time exactly.
                let began = self.due(&at, guard).unwrap_or(s);
                return self.enter(mode, at.phase + 1, began);
            }
            Awaited::Place(_) => Progress::Armed,
            Awaited::Extremum(kind) => self.after_zero(&at, (subject, kind), (s, y)),
            Awaited::End | Awaited::Nothing => Progress::Done,
        };
        PhaseMode { progress, ..at }
    }
}
