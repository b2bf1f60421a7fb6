//! The events of one instant, in order.
//!
//! Guards that cross zero at one place, up to rounding, belong to one instant. All of them act,
//! each once: guards of higher priority first, and then in the order of the list. A guard that has
//! crossed zero acts whatever the others did before, if the mode then active has this guard;
//! otherwise it is reported as preempted. A guard that bounds the domain of its mode
//! ([`Direction::Below`]) is evaluated again. `zeros` decides which guards stand on their zero.

mod zeros;

use smallvec::SmallVec;

use crate::error::RunError;
use crate::events::{Crossed, Event, Note, only};
use crate::hybrid::{Direction, Guard, Outcome, Preempted, Rest};
use crate::lists::List;
use crate::method::Store;
use crate::runs::clock::{Accumulation, Zeno};
use crate::runs::finite::check_finite;
use crate::runs::runner::{Runner, Watcher};
use crate::system::{PerGuard, System};

/// A guard has crossed zero in a mode, and has not acted yet.
#[derive(Clone, Copy, Debug)]
struct Pending<Mode> {
    crossed: Crossed,
    mode: Mode,
    guard: Guard,
}

impl<Mode> Pending<Mode> {
    /// Whether it is not evaluated again, as a bound of a domain is.
    fn is_edge(&self) -> bool {
        self.guard.direction() != Direction::Below
    }
}

/// A guard has acted in a mode, and led to another one.
#[derive(Clone, Copy)]
struct Transition<Mode> {
    from: Mode,
    guard: usize,
    /// The slope with which the guard has crossed zero, infinite if it has not been located.
    slope: f64,
    to: Mode,
}

/// A guard has crossed zero in a mode, and has changed nothing.
#[derive(Clone, Copy)]
struct Noted<Mode> {
    s: f64,
    mode: Mode,
    guard: usize,
    crossed: Crossed,
}

/// What is known about the guards at one instant, by their places.
pub(super) struct Instant<S: System> {
    pending: PerGuard<S, Option<Pending<S::Mode>>>,
    /// The modes in which guards have acted, and how they have crossed zero.
    acted: PerGuard<S, Option<(S::Mode, Crossed)>>,
    /// The last events that have changed nothing.
    noted: SmallVec<[Noted<S::Mode>; 2]>,
    /// The state before the first transition.
    origin: S::State,
    transitions: SmallVec<[Transition<S::Mode>; 4]>,
    /// The error of its place, NaN if it is not known yet.
    error: f64,
    /// The last modes and guards of a chain that comes close to the limit.
    chain: Vec<(S::Mode, usize)>,
}

/// The roundings of time within which an event that changes nothing is of the instant of a switch.
const HIDES: f64 = 16.0;
/// By how much of their size components move to a place nearby, where guards are compared.
const NEARBY: [f64; 3] = [1e-6, 1.7e-6, 2.3e-6];
/// The size of a component that is 0.
const TINY: f64 = 1e-6;
/// A cycle of transitions at one instant is named if it is no longer than this.
const LONGEST_CYCLE: usize = 8;

impl<S: System> Instant<S> {
    pub(super) fn new(n: usize) -> Self {
        Self {
            pending: List::of(0, None),
            acted: List::of(0, None),
            noted: SmallVec::new(),
            origin: S::State::room(n),
            transitions: SmallVec::new(),
            error: f64::NAN,
            chain: Vec::new(),
        }
    }

    /// Remembers events that have changed nothing on a step, and forgets those before it that
    /// cannot be of the same instant.
    pub(super) fn note(&mut self, notes: &[Note<S>], drift: f64) {
        let Some(first) = notes.first() else { return };
        self.noted.retain(|noted| noted.s >= first.s - HIDES * drift);
        for note in notes {
            let acts = |guard: &usize| *guard == note.guard || note.simultaneous[*guard];
            let guards = (0..note.crossed.parts().len()).filter(acts);
            self.noted.extend(guards.map(|guard| {
                let crossed = note.crossed[guard].unwrap_or(Crossed::AT_ONCE);
                Noted { s: note.s, mode: note.from, guard, crossed }
            }));
        }
    }

    /// Remembers the last events of a chain; `left` more events are allowed.
    fn remember(&mut self, left: usize, event: (S::Mode, usize)) {
        if left < 2 * LONGEST_CYCLE {
            self.chain.push(event);
        } else {
            self.chain.clear();
        }
    }

    /// The modes and guards that follow each other again and again at the end of the chain.
    fn cycle(&self) -> &[(S::Mode, usize)] {
        let chain = &self.chain[..];
        let repeats = |&period: &usize| chain.iter().zip(&chain[period..]).all(|(a, b)| a == b);
        let period = (1..=chain.len() / 2).find(repeats).unwrap_or(chain.len().min(LONGEST_CYCLE));
        &chain[chain.len() - period..]
    }
}

/// A guard acts in a mode, at a state.
struct Act<S: System> {
    guard: usize,
    from: S::Mode,
    before: S::State,
    /// The guard's largest value in the phase that ends, and how it crossed zero.
    largest: f64,
    crossed: Crossed,
}

impl<S: System, O: Watcher<S>> Runner<'_, S, O> {
    /// Lets the guards of an event act, and enters the next phase. Returns the outcome if the run
    /// ends here.
    pub(super) fn switch(&mut self, event: &Event<S>) -> Result<Option<Outcome>, RunError> {
        check_finite(self.clock.s, event.state.parts())?;
        self.state.set(&event.state);
        self.rest.parts_mut().fill(0.0);
        let (mode, count) = (self.phase.mode, self.phase.count());
        let Instant { pending, acted, noted, origin, transitions, error, .. } = &mut self.instant;
        pending.fit(count, None);
        acted.fit(count, None);
        if self.clock.phase > 0.0 {
            acted.parts_mut().fill(None);
            transitions.clear();
        }
        if transitions.is_empty() {
            *error = f64::NAN;
            origin.set(&event.state);
        }
        // What has just been noted is of this instant too.
        let since = event.since.min(self.clock.s - HIDES * self.clock.drift());
        for &Noted { mode, guard, crossed, .. } in noted.iter().filter(|noted| noted.s >= since) {
            if guard < count {
                acted[guard] = Some((mode, crossed));
            }
        }
        for guard in 0..count {
            let of = self.phase.guards[guard];
            pending[guard] =
                event.crossed[guard].map(|crossed| Pending { crossed, mode, guard: of });
        }
        let mut guard = event.guard;
        loop {
            if let Some(outcome) = self.act(event, guard)? {
                return Ok(Some(outcome));
            }
            match self.next_to_act(event) {
                Some(next) => guard = next,
                None => break,
            }
            if self.observer.stops(self.clock.s) {
                return Ok(Some(Outcome::Stopped));
            }
        }
        self.begin()?;
        Ok(None)
    }

    /// Reports a switch and enters its mode, or ends the run.
    fn act(&mut self, event: &Event<S>, guard: usize) -> Result<Option<Outcome>, RunError> {
        let (s, from) = (self.clock.s, self.phase.mode);
        let pending = self.instant.pending[guard].take();
        let crossed = pending.map_or(Crossed::AT_ONCE, |pending| pending.crossed);
        let ends = self.phase.guards[guard].ends_run();
        let slope = if self.phase.guards[guard].direction().has_values() {
            crossed.slope
        } else {
            f64::INFINITY
        };
        let hides = self.hides(event, guard, crossed);
        let before = self.state.clone();
        let to = if ends { from } else { self.system.transition(from, guard, s, &mut self.state) };
        self.fired[self.system.counter(from, guard)] += 1;
        self.statistics.switches += usize::from(!ends);
        let first = self.instant.acted.parts().iter().all(Option::is_none);
        // Those that a row without a change names would have fired with it.
        let changes = ends || to != from || self.state != before;
        let pending = &self.instant.pending;
        let others = |other: usize| {
            changes && (pending[other].is_some() || first && event.simultaneous[other])
        };
        self.observer.on_switch(&Note {
            s,
            guard,
            simultaneous: List::made(self.phase.count(), others),
            flatness: self.phase.flatness(guard, crossed.slope),
            crossed: only(self.phase.count(), guard, crossed),
            from,
            to,
            before: before.clone(),
            after: self.state.clone(),
        });
        if ends {
            return Ok(Some(Outcome::EndedByGuard { guard }));
        }
        self.phase.mode = to;
        if self.statistics.switches >= self.options.max_switches {
            return Ok(Some(Outcome::SwitchLimit));
        }
        let most = self.options.max_at_one_instant;
        let count = self.zeno.count_at(s, guard);
        if let Some(accumulation) = self.zeno.behind_chain(s).filter(|_| to == from) {
            self.observer.forget(self.zeno.alone() - 1);
            return self.rest(guard, accumulation);
        }
        if count >= most {
            return Err(self.cycle(from, guard));
        }
        self.instant.remember(self.zeno.left_at_instant(self.options), (from, guard));
        if let Some(accumulation) =
            self.zeno.after_switch(s, (self.clock.phase, hides), self.options)
        {
            return self.rest(guard, accumulation);
        }
        self.clock.phase = 0.0;
        let largest = self.phase.largest[guard];
        self.phase.enter(self.system, to, (s, &self.state), &mut self.fired)?;
        self.room.guards = self.phase.count();
        self.statistics.guards += 1;
        self.instant.acted[guard] = Some((from, crossed));
        self.instant.transitions.push(Transition { from, guard, slope, to });
        let count = self.phase.count().max(self.instant.pending.parts().len());
        self.instant.pending.fit(count, None);
        self.instant.acted.fit(count, None);
        let act = Act { guard, from, before, largest, crossed };
        self.see_jumps(event, &act);
        self.forgive(event, &act);
        Ok(None)
    }

    /// The error of a chain of transitions at one instant, after `guard` of the mode `from`. The
    /// observer forgets the chain.
    fn cycle(&mut self, from: S::Mode, guard: usize) -> RunError {
        self.instant.remember(0, (from, guard));
        self.observer.forget(self.options.max_at_one_instant);
        let named = self.instant.cycle().iter();
        let cycle = named.map(|(mode, guard)| (*guard, format!("{mode:?}"))).collect();
        let (s, count) = (self.clock.s, self.options.max_at_one_instant);
        RunError::Cycle { s, count, cycle }
    }

    /// Goes on behind an accumulation of switches, if the system says how. Otherwise the run ends.
    fn rest(
        &mut self,
        guard: usize,
        Accumulation { s, error }: Accumulation,
    ) -> Result<Option<Outcome>, RunError> {
        let from = self.phase.mode;
        let Some(to) = self.system.rest(from, guard, s, &mut self.state) else {
            return Ok(Some(Outcome::Zeno { accumulation: s }));
        };
        self.observer.on_rest(&Rest { s, error, guard, from, to });
        self.clock.arrive(s.min(self.end));
        self.clock.phase = 0.0;
        self.zeno = Zeno::new(s);
        self.phase.enter(self.system, to, (s, &self.state), &mut self.fired)?;
        self.room.guards = self.phase.count();
        self.statistics.guards += 1;
        self.instant.pending = List::of(self.phase.count(), None);
        self.instant.acted = List::of(self.phase.count(), None);
        Ok(None)
    }

    /// Finds the guards that a transition carries across zero, of those that see it.
    fn see_jumps(&mut self, event: &Event<S>, act: &Act<S>) {
        for guard in 0..self.phase.count() {
            let of = self.phase.guards[guard];
            if of.watches_jumps() && guard != act.guard && self.instant.pending[guard].is_none() {
                let mode = self.phase.mode;
                self.instant.pending[guard] = self.jump(event, act, guard).map(|crossed| Pending {
                    crossed,
                    mode,
                    guard: of,
                });
            }
        }
    }

    /// 1 or −1 if a guard of the active mode is a guard of the mode `from`, with this sign; 0 if it
    /// is another guard. They are the same if their values are, or are opposite, where the step of
    /// the event starts, where it ends, in the present state, and near it.
    fn sense(&mut self, event: &Event<S>, from: S::Mode, guard: usize) -> f64 {
        let (system, s, to) = (self.system, self.clock.s, self.phase.mode);
        let direction = match self.phase.guards.parts().get(guard) {
            Some(_) if from == to => return 1.0,
            Some(guard) => guard.direction(),
            None => return 0.0,
        };
        if direction == Direction::Clock {
            return f64::from(u8::from(system.next_time(to, guard, s.next_down()) == s));
        }
        if !direction.has_values() {
            return 0.0;
        }
        let (mut old, mut new) = (self.room.row(), self.room.row());
        // Two forms may be equal on a way, and where it jumps to. Nearby they are not.
        let mut nearby = self.state.clone();
        for (i, y) in nearby.parts_mut().iter_mut().enumerate() {
            let size = y.abs().max(event.state.parts()[i].abs()).max(TINY);
            *y += (NEARBY[i % NEARBY.len()] * size).copysign(*y);
        }
        // It is not known before a value differs from zero.
        let mut sense = f64::NAN;
        let places =
            [(event.step.s, &event.step.y0), (s, &event.state), (s, &self.state), (s, &nearby)];
        for (s, y) in places {
            system.guard_values(from, s, y, &mut old);
            system.guard_values(to, s, y, &mut new);
            self.statistics.guards += 2;
            let (known, new) = (old.parts().get(guard).copied().unwrap_or(f64::NAN), new[guard]);
            if sense.is_nan() && known != 0.0 {
                sense = if known == -new { -1.0 } else { 1.0 };
            }
            let same = known == sense * new
                || known == 0.0 && new == 0.0
                || known.is_nan() && new.is_nan();
            if !same {
                sense = 0.0;
                break;
            }
        }
        self.room.give_row(old);
        self.room.give_row(new);
        if sense.is_nan() { 1.0 } else { sense }
    }

    /// How a transition carries a guard across zero, if it does so in the guard's direction.
    fn jump(&mut self, event: &Event<S>, act: &Act<S>, guard: usize) -> Option<Crossed> {
        let sense = self.sense(event, act.from, guard);
        let mut before = self.room.row();
        self.system.guard_values(act.from, self.clock.s, &act.before, &mut before);
        self.statistics.guards += 1;
        let sign = sense * before.parts().get(guard).copied().unwrap_or(0.0);
        self.room.give_row(before);
        let jumps = sign * self.phase.values[guard] < 0.0
            && self.phase.guards[guard].direction().acts_from(sign);
        // A guard that stands on its zero before and behind does not jump.
        let jumps = jumps && {
            let hidden = self.hidden(event, guard);
            sign.abs().max(self.phase.values[guard].abs()) > hidden
        };
        let crossed = Crossed { slope: f64::INFINITY, jump: true, sign: sign.signum() };
        jumps.then_some(crossed)
    }

    /// The guard that acts next at this instant: one that has crossed zero, or one that bounds the
    /// domain and is beyond zero. A guard that has crossed zero and that the mode does not have
    /// when its turn comes is reported, and does not act.
    fn next_to_act(&mut self, event: &Event<S>) -> Option<usize> {
        loop {
            // Behind the end of the run, no step follows either.
            let waits = self.instant.pending.parts().iter().flatten().any(Pending::is_edge)
                || self.clock.is_at(self.end);
            let mut guard = self.first_in_turn(event, waits)?;
            if !waits {
                // Others that stand on their zero would come too late behind what acts now.
                guard = self.first_in_turn(event, true)?;
            }
            let Some(Pending { crossed, mode, guard: of }) = self.instant.pending[guard] else {
                return Some(guard);
            };
            if of.direction() == Direction::Below {
                return Some(guard);
            }
            let sense = self.sense(event, mode, guard);
            let acts = sense != 0.0
                && self.phase.guards[guard].direction().acts_from(sense * crossed.sign);
            if acts {
                return Some(guard);
            }
            self.instant.pending[guard] = None;
            self.observer.on_preempted(&Preempted { s: self.clock.s, mode, guard });
        }
    }

    /// The guard whose turn it is. If another guard `waits` for its turn, those that bound the
    /// domain count too where they stand on their zero.
    fn first_in_turn(&mut self, event: &Event<S>, waits: bool) -> Option<usize> {
        let mut next: Option<(i16, usize)> = None;
        for guard in 0..self.instant.pending.parts().len() {
            let edge = self.instant.pending[guard].filter(Pending::is_edge);
            let rank = match (edge, self.phase.guards.parts().get(guard).copied()) {
                (Some(pending), _) => pending.guard.rank(),
                (None, Some(of)) if self.is_violated(event, guard, waits) => of.rank(),
                _ => continue,
            };
            let rank = (-i16::from(rank), guard);
            next = Some(next.map_or(rank, |next| next.min(rank)));
        }
        next.map(|(_, guard)| guard)
    }
}
