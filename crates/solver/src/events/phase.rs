//! The active mode with its guards, between two steps.

use crate::error::RunError;
use crate::events::along_step::rounding;
use crate::events::event::Event;
use crate::hybrid::{Direction, Guard};
use crate::method::Store;
use crate::system::{List, PerGuard, Room, System};

/// The part of its largest value that a guard may have where it has just fired.
pub(crate) const NEAR_ZERO: f64 = 1e-6;

/// The active mode, and what is known about its guards at the start of the next step.
pub(crate) struct Phase<S: System> {
    pub(crate) mode: S::Mode,
    pub(crate) guards: PerGuard<S, Guard>,
    /// Whether all guards are declared to be smooth.
    pub(crate) smooth: bool,
    /// The values of the guards.
    pub(crate) values: PerGuard<S, f64>,
    /// Whether any guard starts the next step from a known zero.
    pub(crate) at_zero: bool,
    /// The orders of the zeros from which the guards start the next step, 0 if they do not.
    pub(crate) zero_orders: PerGuard<S, u32>,
    /// Whether a guard counts as zero only because rounding may have moved it away.
    pub(crate) forgiven: PerGuard<S, bool>,
    /// The largest absolute values of the guards at the ends of the phase's steps.
    pub(crate) largest: PerGuard<S, f64>,
}

impl<S: System> Phase<S> {
    /// Room for a phase.
    pub(crate) fn new(mode: S::Mode) -> Self {
        Self {
            mode,
            guards: List::of(0, Guard::OFF),
            smooth: true,
            values: List::of(0, 0.0),
            at_zero: false,
            zero_orders: List::of(0, 0),
            forgiven: List::of(0, false),
            largest: List::of(0, 0.0),
        }
    }

    pub(crate) fn count(&self) -> usize {
        self.guards.parts().len()
    }

    /// Enters `mode` at (`s`, `y`), after its guards have `fired` so often.
    pub(crate) fn enter(
        &mut self,
        system: &S,
        mode: S::Mode,
        (s, y): (f64, &S::State),
        fired: &mut PerGuard<S, u32>,
    ) -> Result<(), RunError> {
        self.mode = mode;
        system.guards(mode, &mut self.guards);
        let n = self.count();
        if fired.parts().len() < n {
            fired.fit(n, 0);
        }
        for (guard, fired) in self.guards.parts_mut().iter_mut().zip(fired.parts()) {
            *guard = guard.fired(*fired);
        }
        self.values.fit(n, 0.0);
        system.guard_values(mode, s, y, &mut self.values);
        self.zero_orders.fit(n, 0);
        self.forgiven.fit(n, false);
        self.largest.fit(n, 0.0);
        self.smooth = self.guards.parts().iter().all(Guard::needs_no_look);
        self.at_zero = false;
        for guard in 0..n {
            let (of, value) = (&self.guards[guard], self.values[guard]);
            if of.direction() != Direction::Off && value.is_nan() {
                return Err(RunError::GuardNotANumber { guard, s });
            }
            self.at_zero |= of.zero_order() > 0;
            self.zero_orders[guard] = of.zero_order();
            self.forgiven[guard] = false;
            self.largest[guard] = value.abs();
        }
        Ok(())
    }

    /// Whether a guard of the mode `from` before `event` seems to be one of this mode too: where
    /// the state `y` goes on unchanged, it has the same value or its negative.
    #[inline(never)]
    fn is_same_guard(
        &self,
        system: &S,
        (s, y): (f64, &S::State),
        event: &Event<S::State>,
        (from, guard): (S::Mode, usize),
        room: &mut Room<S>,
    ) -> bool {
        *y == event.state
            && room.value(system, (from, guard), s, y).abs() == self.values[guard].abs()
    }

    /// Takes values that may be due to rounding of the state at `event`, which led here, for zeros.
    /// `from` is the mode before the event, and `largest` the largest value there of the guard that
    /// fired. `stood` tells which guards have fired before at the same instant and stood on their
    /// zero.
    pub(crate) fn forgive(
        &mut self,
        system: &S,
        (s, y): (f64, &S::State),
        event: &Event<S::State>,
        (from, largest): (S::Mode, f64),
        stood: &PerGuard<S, bool>,
        room: &mut Room<S>,
    ) {
        for guard in 0..self.count() {
            let stood = stood.parts().get(guard).is_some_and(|stood| *stood);
            let (value, direction) = (self.values[guard], self.guards[guard].direction());
            // A guard that fired stands on its zero where it goes on, also exactly, and whatever
            // its rounding is.
            let is_near = || value.abs() <= NEAR_ZERO * largest.max(event.slope * event.step.h);
            let stands = !matches!(direction, Direction::Off | Direction::Below)
                && (if guard == event.guard { is_near() } else { stood })
                && self.is_same_guard(system, (s, y), event, (from, guard), room);
            let may_be_zero = match direction {
                Direction::Off => false,
                // On the right side, a bound of the domain needs no pardon.
                Direction::Below => value < 0.0,
                _ => stands || (guard == event.guard && from == self.mode),
            };
            if !may_be_zero || self.zero_orders[guard] > 0 {
                continue;
            }
            let s_scale = s.abs().max(event.step.s.abs());
            let mut scale = room.state();
            let of = [&event.state, &event.step.y0, y];
            S::State::each(&mut scale, of, |_, [a, b, c]| a.abs().max(b.abs()).max(c.abs()));
            let residual = if guard == event.guard { event.residual } else { 0.0 };
            let mut hidden = || {
                let (about, scales) = ((s, y), (s_scale, &scale));
                rounding(system, (self.mode, guard), about, scales, room).0.max(residual)
            };
            if stands || value.abs() <= hidden() {
                self.at_zero = true;
                self.zero_orders[guard] = 1;
                self.forgiven[guard] = true;
            }
            room.give(scale);
        }
    }

    /// Goes on after a step, at whose end the guards have these values.
    #[inline]
    pub(crate) fn advance(&mut self, values: &PerGuard<S, f64>) {
        self.values.set(values);
        if self.at_zero {
            self.forget_zeros();
        }
        for (largest, value) in self.largest.parts_mut().iter_mut().zip(values.parts()) {
            *largest = if value.abs() > *largest { value.abs() } else { *largest };
        }
    }

    pub(crate) fn forget_zeros(&mut self) {
        self.at_zero = false;
        self.zero_orders.parts_mut().fill(0);
        self.forgiven.parts_mut().fill(false);
    }
}
