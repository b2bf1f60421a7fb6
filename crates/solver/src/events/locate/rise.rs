//! A guard that rises from its zero at the start of a step, and comes back before rounding shows
//! that it has risen: a ball that hops by less than the rounding of its height.
//!
//! Its values say nothing about when it comes back, but its first two derivatives do. The event is
//! there, or where rounding shows that the guard is beyond zero. A transition at the start of a hop
//! would find the ball on its way up, and turn its velocity through the floor.

use crate::events::along_step::flow;
use crate::events::arrival::SHOWS;
use crate::events::event::{Crossed, Event};
use crate::events::examination::Examination;
use crate::events::locate::Near;
use crate::events::quick::NODES;
use crate::events::sidestep::resolution;
use crate::events::status::Crossing;
use crate::method::{Method, StepOf};
use crate::system::System;

/// Where it is looked for between a zero and a crossing.
const WITHIN: [f64; 3] = [0.5, 0.29, 0.83];
/// A second difference that is so many times what rounding hides shows a second derivative.
const SEEN: f64 = 16_384.0;

/// The part of the time over which derivatives may be differenced, however short the step is.
const LONGEST: f64 = 1e-4;
/// A guard that is back on its zero within this part of the time may not have risen visibly.
const SOON: f64 = 1e-6;

impl<S: System> Examination<'_, S> {
    /// A step fraction before a crossing, up to which a guard that starts from a zero shows that it
    /// has risen. It is looked for only where the crossing is so close that rounding may hide that.
    /// The result is `None` if it does.
    pub(super) fn rise_before<M: Method>(
        &mut self,
        step: &StepOf<S::State>,
        guard: usize,
        crossing: &Crossing,
    ) -> Option<f64> {
        let theta = crossing.bracket.guess;
        if crossing.bracket.rests {
            return Some(0.0);
        }
        let soon = theta < NODES[1] || theta * step.h <= SOON * step.s.abs().max(self.usual);
        let from_zero = self.phase.zero_orders[guard] > 0 && self.notes_of(guard).next().is_none();
        if theta == 0.0 || from_zero && soon {
            self.rise_shows::<M>(step, (guard, crossing.sign), theta)
        } else {
            Some(0.0)
        }
    }

    /// A step fraction at which `sign` times a guard shows that it has risen from its zero at the
    /// start of `step`, before the crossing that is expected near `theta`. Closer to the start,
    /// signs are rounding. The result is `None` if rounding hides all of the rise.
    fn rise_shows<M: Method>(
        &mut self,
        step: &StepOf<S::State>,
        (guard, sign): (usize, f64),
        theta: f64,
    ) -> Option<f64> {
        let shortest = resolution(step.s, step.h);
        let (mut hides, mut beyond) = (true, theta);
        for part in WITHIN.into_iter().filter(|part| part * theta >= shortest) {
            match self.shows::<M>(step, (guard, sign), part * theta) {
                0.0 => {}
                side if side > 0.0 => return Some(part * theta),
                _ => (hides, beyond) = (false, beyond.min(part * theta)),
            }
        }
        // It is expected too early, where rounding still hides all, or too late.
        let factor = if hides { 4.0 } else { 0.25 };
        let mut place = if hides { theta.max(shortest) } else { factor * beyond };
        while place < 1.0 && place >= shortest {
            match self.shows::<M>(step, (guard, sign), place) {
                side if side > 0.0 => return Some(place),
                0.0 if hides => {}
                side if side < 0.0 && !hides => {}
                _ => return None,
            }
            place *= factor;
        }
        None
    }

    /// The sign of `sign` times a guard at a place of `step`, or 0 if rounding hides it.
    fn shows<M: Method>(
        &mut self,
        step: &StepOf<S::State>,
        (guard, sign): (usize, f64),
        place: f64,
    ) -> f64 {
        let (system, mode, reach) = (self.system, self.phase.mode, 0.0);
        let near = Near { system, mode, guard, sign, reach };
        let trial = self.restep::<M>(step, place * step.h);
        let s = trial.s + trial.h;
        let value = near.value(s, &trial.y1, self.room);
        let hidden = 4.0 * near.rounding(s, &trial.y1, self.room);
        self.room.give_step(trial);
        if value.abs() > hidden { value.signum() } else { 0.0 }
    }

    /// The time after which `sign` times a guard is back on the zero from which it rises as `step`
    /// starts, by its first two derivatives, and its slope there. Rounding hides its values, but
    /// not its derivatives, which differences over a longer way show.
    fn returns(
        &mut self,
        step: &StepOf<S::State>,
        (guard, sign): (usize, f64),
    ) -> Option<(f64, f64)> {
        let (system, mode, s, y) = (self.system, self.phase.mode, step.s, &step.y0);
        let near = Near { system, mode, guard, sign, reach: 0.0 };
        let hidden = near.rounding(s, y, self.room);
        let (mut slope, mut ahead, mut moved) =
            (self.room.state(), self.room.state(), self.room.state());
        system.field(mode, s, y, &mut slope);
        let start = near.value(s, y, self.room);
        let (room, statistics) = (&mut *self.room, &mut *self.statistics);
        let mut value = |by: f64| {
            flow::<S>((system, mode), (s, y, &slope), by, (&mut moved, &mut ahead));
            statistics.field += 1;
            statistics.guards += 1;
            near.value(s + by, &moved, room)
        };
        let mut reach = SHOWS * self.drift;
        let mut found = None;
        let longest = step.h.max(self.usual).max(LONGEST * s.abs());
        while found.is_none() && reach > 0.0 && reach <= longest {
            let (after, before) = (value(reach), value(-reach));
            let bend = after + before - 2.0 * start;
            if bend.abs() > SEEN * hidden {
                found = Some((0.5 * (after - before) / reach, bend / (reach * reach)));
            }
            reach *= 4.0;
        }
        for state in [slope, ahead, moved] {
            self.room.give(state);
        }
        let (rate, bend) = found?;
        // It is surely on its way back where rounding shows that it is beyond zero.
        let beyond = (2.0 * hidden / -bend).sqrt();
        let elapsed = (-2.0 * rate / bend).max(beyond);
        (bend < 0.0).then(|| (elapsed, (rate + bend * elapsed).abs()))
    }

    /// The event of a guard that comes back to its zero unseen.
    pub(super) fn unseen<M: Method>(
        &mut self,
        step: &StepOf<S::State>,
        (guard, sign): (usize, f64),
        beyond: f64,
    ) -> Event<S> {
        let (elapsed, slope) = self.returns(step, (guard, sign)).unwrap_or((0.0, 0.0));
        let trial = if elapsed > 0.0 {
            self.restep::<M>(step, elapsed.min(step.h))
        } else {
            step.shrunk_to_start()
        };
        let (system, at, s) = (self.system, (self.phase.mode, guard), trial.s + trial.h);
        let (elapsed, state) = (trial.h, trial.y1.clone());
        let residual = self.room.value(system, at, s, &state).abs();
        let crossed = Crossed { slope, jump: false, sign };
        let alone = Event::alone((guard, self.phase.count()), crossed, (elapsed, state), trial);
        Event { residual, beyond, ..alone }
    }
}
