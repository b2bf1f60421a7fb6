//! Which guards stand on their zero at an instant, as far as rounding lets that be known.

use super::{Act, Instant, Pending, Transition};
use crate::events::along_step::{rounding, scales};
use crate::events::phase::{NEAR_ZERO, digit, near_zero};
use crate::events::{Crossed, Doubt, Event};
use crate::hybrid::Direction;
use crate::method::Store;
use crate::runs::runner::{Runner, Watcher};
use crate::system::System;

/// The parts of a usual step over which a guard shows on which side it leaves zero: the first that
/// is tried, and about the last.
const CLOSE: f64 = 1e-6;
const FAR: f64 = 1e-2;
/// Rounding decides when a guard comes back that goes no farther in a phase than so many times what
/// rounding hides.
const CONFUSES: f64 = 16.0;
/// It is in doubt whether a guard that has acted stands on its zero up to so many times what the
/// errors of its instant explain.
const DOUBTFUL: f64 = 16.0;

impl<S: System, O: Watcher<S>> Runner<'_, S, O> {
    /// Takes values of guards that may be due to rounding of the state, or that are left where a
    /// guard has acted, for zeros.
    pub(super) fn forgive(&mut self, event: &Event<S>, act: &Act<S>) {
        for guard in 0..self.phase.count() {
            let (value, direction) =
                (self.phase.values[guard], self.phase.guards[guard].direction());
            // On the right side, a bound of the domain needs no pardon.
            let below = direction == Direction::Below && value < 0.0;
            let crossed = if direction.is_edge() {
                self.instant.acted[guard]
            } else {
                // One that is clearly beyond has not been located.
                let located = |it: &Pending<_>| below && it.crossed.slope.is_finite();
                self.instant.pending[guard].filter(located).map(|it| (it.mode, it.crossed))
            };
            if self.phase.zero_orders[guard] > 0 || !below && crossed.is_none() {
                continue;
            }
            // A guard that has crossed stands on its zero, whatever its rounding is, while nothing
            // changes its value. A guard of another mode does not.
            let left = match crossed.map(|crossed| self.left(event, act, crossed, guard)) {
                Some(None) if !below => continue,
                left => left.flatten().unwrap_or(0.0),
            };
            let hidden = self.hidden(event, guard);
            let away = value.abs().min((value - left).abs());
            // A transition makes an error of time larger, but not so much.
            let slope = crossed.map_or(f64::INFINITY, |(_, crossed)| crossed.slope);
            let near = NEAR_ZERO * away <= hidden + slope * self.clock.drift();
            let more = if near && away > hidden { self.unsettled(guard) } else { 0.0 };
            let known = hidden + more;
            if away <= known {
                self.phase.forgive(guard);
            } else if direction.is_edge() && away <= DOUBTFUL * known {
                // Errors of earlier events may have moved it.
                self.phase.undecided = true;
            }
        }
    }

    /// The value that is left where a guard has crossed zero in a mode, 0 if it has jumped. The
    /// result is `None` if the active mode does not have this guard.
    fn left(
        &mut self,
        event: &Event<S>,
        act: &Act<S>,
        (mode, crossed): (S::Mode, Crossed),
        guard: usize,
    ) -> Option<f64> {
        let sense = self.sense(event, mode, guard);
        let left = self.room.value(self.system, (mode, guard), self.clock.s, &event.state);
        self.statistics.guards += 1;
        // The guard that has acted stands on its zero only if it was close to it.
        let h = event.step.h;
        let size = act.largest.max(act.crossed.slope * h);
        let near = if h > 0.0 {
            near_zero(self.clock.drift() + digit(&event.state, &self.slope), h)
        } else {
            NEAR_ZERO
        };
        let stands = !crossed.jump && (guard != act.guard || left.abs() <= near * size);
        (sense != 0.0).then_some(if stands { sense * left } else { 0.0 })
    }

    /// By how much a guard would differ if the instant had come later by the error of its place,
    /// and everything had acted there as it has.
    fn unsettled(&mut self, guard: usize) -> f64 {
        let (system, s) = (self.system, self.clock.s);
        let Some(&Transition { from, .. }) = self.instant.transitions.first() else { return 0.0 };
        let late = s + self.error_of_place();
        let (mut slope, mut y) = (self.room.state(), self.room.state());
        system.field(from, self.clock.s, &self.instant.origin, &mut slope);
        S::State::shifted(&mut y, &self.instant.origin, &slope, late - self.clock.s);
        let mut acts = self.instant.transitions.iter();
        let same = acts.all(|it| system.transition(it.from, it.guard, late, &mut y) == it.to);
        let value = self.room.value(system, (self.phase.mode, guard), late, &y);
        self.statistics.field += 1;
        self.statistics.guards += 1;
        self.room.give(slope);
        self.room.give(y);
        let change = (value - self.phase.values[guard]).abs();
        if same && change.is_finite() { change } else { 0.0 }
    }

    /// The error of the place of this instant: of its time, and of the guard that acted first.
    fn error_of_place(&mut self) -> f64 {
        let Instant { transitions, origin, error, .. } = &mut self.instant;
        if error.is_nan() {
            *error = self.clock.drift();
            let first = transitions.first().filter(|first| first.slope.is_finite());
            if let Some(&Transition { from, guard, slope, .. }) = first {
                let (system, at, usual) = (self.system, (from, guard), self.h);
                let (statistics, room) = (&mut self.statistics, &mut self.room);
                let mut doubt = Doubt { system, at, usual, statistics, room };
                *error += doubt.error((self.clock.s, &*origin), slope);
            }
        }
        *error
    }

    /// The value that a guard may have by rounding where it is zero at this instant.
    pub(super) fn hidden(&mut self, event: &Event<S>, guard: usize) -> f64 {
        let (s, y) = (self.clock.s, &self.state);
        let mut scale = self.room.state();
        let s_scale = scales(&event.step, s, &event.state, &mut scale);
        S::State::each(&mut scale, [y], |scale, [y]| scale.max(y.abs()));
        let at = (self.phase.mode, guard);
        let (hidden, count) = rounding(self.system, at, (s, y), (s_scale, &scale), &mut self.room);
        self.statistics.guards += count;
        self.room.give(scale);
        if guard == event.guard { hidden.max(event.residual) } else { hidden }
    }

    /// Whether the phase is so short that rounding hides how far the guard went in it.
    pub(super) fn hides(&mut self, event: &Event<S>, guard: usize, crossed: Crossed) -> bool {
        let phase = self.clock.phase;
        let brief = phase > 0.0 && self.zeno.is_brief(phase, self.clock.s);
        brief && crossed.slope * phase <= CONFUSES * self.hidden(event, guard)
    }

    /// Whether a guard bounds the domain of the mode and is beyond zero: clearly, or where it has
    /// just crossed zero. If another guard `waits` for its turn, or the run ends here, one that
    /// stands on its zero and falls counts as well, since the next step would find it too late.
    pub(super) fn is_violated(&mut self, event: &Event<S>, guard: usize, waits: bool) -> bool {
        let value = self.phase.values[guard];
        if self.phase.guards[guard].direction() != Direction::Below {
            return false;
        }
        let forgiven = self.phase.zero_by_rounding[guard];
        if self.phase.zero_orders[guard] > 0 && !forgiven {
            return false;
        }
        if value < 0.0 && !forgiven {
            return true;
        }
        let pending = self.instant.pending[guard].map(|pending| pending.mode);
        let crossed = pending.filter(|&mode| self.sense(event, mode, guard) == 1.0);
        if !waits && crossed.is_none() {
            return false;
        }
        let hidden = self.hidden(event, guard);
        // It has crossed zero where it is now, whatever its rounding is.
        let stands = crossed.is_some_and(|mode| {
            self.statistics.guards += 1;
            let there = self.room.value(self.system, (mode, guard), self.clock.s, &event.state);
            (value - there).abs() <= hidden
        });
        if stands && crossed == Some(self.phase.mode) {
            return true;
        }
        let is_zero = stands || waits && (forgiven || value <= hidden + self.unsettled(guard));
        is_zero && self.falls(guard, value, hidden)
    }

    /// Whether a guard with this value falls where the active mode goes on.
    fn falls(&mut self, guard: usize, value: f64, hidden: f64) -> bool {
        let (mode, s) = (self.phase.mode, self.clock.s);
        let (mut slope, mut ahead) = (self.room.state(), self.room.state());
        self.system.field(mode, s, &self.state, &mut slope);
        self.statistics.field += 1;
        let shortest = (CLOSE * self.h).max(256.0 * f64::EPSILON * s.abs());
        let mut reach = shortest;
        let change = loop {
            S::State::shifted(&mut ahead, &self.state, &slope, reach);
            let change = self.room.value(self.system, (mode, guard), s + reach, &ahead) - value;
            self.statistics.guards += 1;
            if change.abs() > 8.0 * hidden || reach >= FAR * self.h {
                // What nothing hides shows at once: it rests on zero, and falls later.
                break if hidden == 0.0 && reach > shortest { 0.0 } else { change };
            }
            reach *= 16.0;
        };
        self.room.give(slope);
        self.room.give(ahead);
        change < -8.0 * hidden
    }
}
