//! The events of one instant, in order.
//!
//! Guards that cross zero at one place, as far as rounding tells, are of one instant. All of them
//! act, each once: those of higher priority first, and then in the order in which they are listed. A
//! guard that has crossed zero does so whatever the others did before, if the mode then active has
//! this guard; otherwise it is reported as preempted. A guard that bounds the domain of its mode
//! ([`Direction::Below`]) is asked again.

use crate::error::RunError;
use crate::events::along_step::rounding;
use crate::events::phase::NEAR_ZERO;
use crate::events::{Crossed, Event};
use crate::hybrid::{Direction, Outcome, Preempted, Rest};
use crate::method::Store;
use crate::runs::clock::{Accumulation, Zeno};
use crate::runs::finite::check_finite;
use crate::runs::runner::{Runner, Watcher};
use crate::system::{List, Note, PerGuard, System};

/// What is known about the guards at one instant.
pub(super) struct Instant<S: System> {
    /// The guards that have crossed zero and have not acted yet.
    pending: PerGuard<S, Option<Crossed>>,
    /// The guards that have acted.
    acted: PerGuard<S, bool>,
    /// The last modes and guards of a chain that comes close to the limit.
    chain: Vec<(S::Mode, usize)>,
}

/// A cycle of transitions at one instant is named if it is no longer than this.
const LONGEST_CYCLE: usize = 8;

impl<S: System> Instant<S> {
    pub(super) fn new() -> Self {
        Self { pending: List::of(0, None), acted: List::of(0, false), chain: Vec::new() }
    }

    /// Remembers the last events of a chain, of which `left` more are allowed.
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
        let Instant { pending, acted, .. } = &mut self.instant;
        pending.set(&event.crossed);
        acted.fit(self.phase.count(), false);
        if self.clock.phase > 0.0 {
            acted.parts_mut().fill(false);
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
            if self.observer.stops() {
                return Ok(Some(Outcome::Stopped));
            }
        }
        self.begin()?;
        Ok(None)
    }

    /// Reports a switch and enters its mode, or ends the run.
    fn act(&mut self, event: &Event<S>, guard: usize) -> Result<Option<Outcome>, RunError> {
        let (s, from) = (self.clock.s, self.phase.mode);
        let crossed = self.instant.pending[guard].take().unwrap_or(Crossed::AT_ONCE);
        let ends = self.phase.guards[guard].ends_run();
        let before = self.state.clone();
        let to = if ends { from } else { self.system.transition(from, guard, s, &mut self.state) };
        self.fired[guard] += 1;
        self.statistics.switches += usize::from(!ends);
        let first = !self.instant.acted.parts().contains(&true);
        let pending = &self.instant.pending;
        let others = |other: usize| pending[other].is_some() || first && event.simultaneous[other];
        self.observer.on_switch(&Note {
            s,
            guard,
            simultaneous: List::made(self.phase.count(), others),
            flatness: self.phase.flatness(guard, crossed.slope),
            jump: crossed.jump,
            from,
            to,
            before: before.clone(),
            after: self.state.clone(),
        });
        if ends {
            return Ok(Some(Outcome::EndedByGuard { guard }));
        }
        if to != from {
            // Whether the state is in the domain of the new mode is asked anew.
            for (pending, guard) in
                self.instant.pending.parts_mut().iter_mut().zip(self.phase.guards.parts())
            {
                *pending = pending.filter(|_| guard.direction() != Direction::Below);
            }
        }
        self.phase.mode = to;
        if self.statistics.switches >= self.options.max_switches {
            return Ok(Some(Outcome::SwitchLimit));
        }
        if self.zeno.count_at(s) >= self.options.max_at_one_instant {
            return Err(self.cycle(from, guard));
        }
        self.instant.remember(self.zeno.left_at_instant(self.options), (from, guard));
        if let Some(accumulation) = self.zeno.after_switch(s, self.clock.phase, self.options) {
            return self.rest(guard, accumulation);
        }
        self.clock.phase = 0.0;
        let largest = self.phase.largest[guard];
        self.phase.enter(self.system, to, (s, &self.state), &mut self.fired)?;
        self.room.guards = self.phase.count();
        self.statistics.guards += 1;
        let act = Act { guard, from, before, largest, crossed };
        self.carry_over(event, &act);
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
        self.instant.acted = List::of(self.phase.count(), false);
        Ok(None)
    }

    /// Keeps what is known about the guards that the new mode has too, and reports those that it
    /// does not have.
    fn carry_over(&mut self, event: &Event<S>, act: &Act<S>) {
        let count = self.phase.count();
        let mut pending = std::mem::replace(&mut self.instant.pending, List::of(0, None));
        if act.from == self.phase.mode {
            self.instant.acted[act.guard] = true;
        } else {
            self.instant.acted.fit(count, false);
            for guard in 0..count {
                let acted =
                    self.instant.acted[guard] || guard == act.guard && self.is_near(event, act);
                self.instant.acted[guard] = acted && self.sense(event, act, guard) != 0.0;
            }
            for guard in 0..pending.parts().len() {
                let Some(crossed) = pending[guard] else { continue };
                let sign =
                    if guard < count { crossed.sign * self.sense(event, act, guard) } else { 0.0 };
                if sign != 0.0 && self.phase.guards[guard].direction().acts_from(sign) {
                    pending[guard] = Some(Crossed { sign, ..crossed });
                } else {
                    pending[guard] = None;
                    let (s, mode) = (self.clock.s, act.from);
                    self.observer.on_preempted(&Preempted { s, mode, guard });
                }
            }
            pending.fit(count, None);
        }
        for guard in 0..count {
            if self.phase.guards[guard].watches_jumps() && guard != act.guard {
                pending[guard] = pending[guard].or_else(|| self.jump(event, act, guard));
            }
        }
        self.instant.pending = pending;
    }

    /// Whether the guard that has acted is so close to its zero that it stands there.
    fn is_near(&self, event: &Event<S>, act: &Act<S>) -> bool {
        let size = act.largest.max(act.crossed.slope * event.step.h);
        self.phase.values[act.guard].abs() <= NEAR_ZERO * size
    }

    /// The sign with which a guard of the new mode is one of the mode before, 0 if it is another
    /// one. They are the same if their values are, or the negatives, where the step of the event
    /// starts, and before and after the transition.
    fn sense(&mut self, event: &Event<S>, act: &Act<S>, guard: usize) -> f64 {
        let (system, s, to) = (self.system, self.clock.s, self.phase.mode);
        if self.phase.guards[guard].direction() == Direction::Clock {
            return f64::from(u8::from(system.next_time(to, guard, s.next_down()) == s));
        }
        if !self.phase.guards[guard].direction().has_values() {
            return 0.0;
        }
        let (mut old, mut new) = (self.room.row(), self.room.row());
        let mut sense = 1.0;
        let places = [(event.step.s, &event.step.y0), (s, &act.before), (s, &self.state)];
        for (s, y) in places {
            system.guard_values(act.from, s, y, &mut old);
            system.guard_values(to, s, y, &mut new);
            self.statistics.guards += 2;
            let known = old.parts().get(guard).copied().unwrap_or(f64::NAN);
            if s == event.step.s && known == -new[guard] {
                sense = -1.0;
            }
            // NaN is not the same.
            if !(known == sense * new[guard]) {
                sense = 0.0;
                break;
            }
        }
        self.room.give_row(old);
        self.room.give_row(new);
        sense
    }

    /// How a transition carries a guard across zero, if it does so in the guard's direction.
    fn jump(&mut self, event: &Event<S>, act: &Act<S>, guard: usize) -> Option<Crossed> {
        let sense = if act.from == self.phase.mode { 1.0 } else { self.sense(event, act, guard) };
        let mut before = self.room.row();
        self.system.guard_values(act.from, self.clock.s, &act.before, &mut before);
        self.statistics.guards += 1;
        let sign = sense * before.parts().get(guard).copied().unwrap_or(0.0);
        self.room.give_row(before);
        let jumps = sign * self.phase.values[guard] < 0.0
            && self.phase.guards[guard].direction().acts_from(sign);
        let crossed = Crossed { slope: f64::INFINITY, jump: true, sign: sign.signum() };
        jumps.then_some(crossed)
    }

    /// Takes values of guards that may be due to rounding of the state, or that are left where a
    /// guard has acted, for zeros.
    fn forgive(&mut self, event: &Event<S>, act: &Act<S>) {
        let unchanged = self.state == act.before;
        for guard in 0..self.phase.count() {
            let (value, direction) =
                (self.phase.values[guard], self.phase.guards[guard].direction());
            let may_be_zero = match direction {
                // On the right side, a bound of the domain needs no pardon.
                Direction::Below => value < 0.0,
                _ => direction.is_edge() && self.instant.acted[guard],
            };
            if !may_be_zero || self.phase.zero_orders[guard] > 0 {
                continue;
            }
            // A guard that has acted stands on its zero where the state goes on, also exactly, and
            // whatever its rounding is.
            let stands = direction.is_edge()
                && unchanged
                && (guard != act.guard || self.is_near(event, act));
            if stands || value.abs() <= self.hidden(event, guard) {
                self.phase.forgive(guard);
            }
        }
    }

    /// The value that a guard may have by rounding where it is zero at this instant.
    fn hidden(&mut self, event: &Event<S>, guard: usize) -> f64 {
        let (s, y) = (self.clock.s, &self.state);
        let s_scale = s.abs().max(event.step.s.abs());
        let mut scale = self.room.state();
        let of = [&event.state, &event.step.y0, y];
        S::State::each(&mut scale, of, |_, [a, b, c]| a.abs().max(b.abs()).max(c.abs()));
        let at = (self.phase.mode, guard);
        let (hidden, count) = rounding(self.system, at, (s, y), (s_scale, &scale), &mut self.room);
        self.statistics.guards += count;
        self.room.give(scale);
        if guard == event.guard { hidden.max(event.residual) } else { hidden }
    }

    /// The guard that acts next at this instant. Only guards that have crossed zero are looked for;
    /// where there are any, those that bound the domain take their turn between them.
    fn next_to_act(&mut self, event: &Event<S>) -> Option<usize> {
        if self.instant.pending.parts().iter().all(Option::is_none) {
            return None;
        }
        let mut next: Option<usize> = None;
        for guard in 0..self.phase.count() {
            let crossed = self.instant.pending[guard].is_some();
            let acts = match self.phase.guards[guard].direction() {
                Direction::Off => false,
                Direction::Below => {
                    let value = self.phase.values[guard];
                    let below = value < 0.0 && self.phase.zero_orders[guard] == 0;
                    below || crossed && value.abs() <= self.hidden(event, guard)
                }
                _ => crossed,
            };
            if !acts {
                self.instant.pending[guard] = None;
            } else if next.is_none_or(|other| self.phase.precedes(guard, other)) {
                next = Some(guard);
            }
        }
        next
    }
}
