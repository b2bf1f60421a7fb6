//! The active mode with its guards, between two steps.
//!
//! A guard that was zero where its phase began is remembered beyond the phase. Another guard may
//! act at the same instant and lead to a mode in which the first guard is still zero, wherever
//! rounding has put it. So a phase without length hands on which guards were zero. A guard that
//! changes its sign with the mode, or whose sign a prescribed run turns, is recognised by the size
//! of its value.

use crate::error::RunError;
use crate::hybrid::{Direction, Guard};
use crate::lists::List;
use crate::method::Store;
use crate::system::{PerGuard, System};

/// The part of its largest value that a guard may have where it has just fired.
pub(crate) const NEAR_ZERO: f64 = 1e-6;

/// The part of its largest value that a guard may have where it has just fired, after a time on
/// which rounding may have moved the event by `drift`. In a phase that is hardly longer, it hides
/// more.
pub(crate) fn near_zero(drift: f64, elapsed: f64) -> f64 {
    NEAR_ZERO.max(16.0 * drift / elapsed)
}

/// The time in which a state with this slope moves by its last digit. It is longer than the
/// rounding of times that are close to 0.
pub(crate) fn digit<V: Store>(y: &V, slope: &V) -> f64 {
    let size = |of: &V| of.parts().iter().fold(0.0_f64, |size, value| size.max(value.abs()));
    let time = f64::EPSILON * size(y) / size(slope);
    if time.is_finite() { time } else { 0.0 }
}

/// The active mode, and what is known about its guards at the start of the next step.
pub(crate) struct Phase<S: System> {
    pub(crate) mode: S::Mode,
    pub(crate) guards: PerGuard<S, Guard>,
    /// Whether all guards are declared to be smooth.
    pub(crate) smooth: bool,
    /// Whether guards have been active in the run that are not decided: those of a black box, whose
    /// signs are sampled, and those that a reset has left about as close to zero as errors reach.
    pub(crate) undecided: bool,
    /// The values of the guards.
    pub(crate) values: PerGuard<S, f64>,
    /// Whether any guard starts the next step from a known zero.
    pub(crate) at_zero: bool,
    /// The orders of the zeros from which the guards start the next step, 0 if they do not.
    pub(crate) zero_orders: PerGuard<S, u32>,
    /// Whether a guard counts as zero only because rounding may have moved it away.
    pub(crate) zero_by_rounding: PerGuard<S, bool>,
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
            undecided: false,
            values: List::of(0, 0.0),
            at_zero: false,
            zero_orders: List::of(0, 0),
            zero_by_rounding: List::of(0, false),
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
        let counters = (0..n).map(|guard| system.counter(mode, guard) + 1).max().unwrap_or(0);
        if fired.parts().len() < counters {
            fired.fit(counters, 0);
        }
        for (place, guard) in self.guards.parts_mut().iter_mut().enumerate() {
            *guard = guard.fired(fired[system.counter(mode, place)]);
        }
        self.values.fit(n, 0.0);
        system.guard_values(mode, s, y, &mut self.values);
        self.zero_orders.fit(n, 0);
        self.zero_by_rounding.fit(n, false);
        self.largest.fit(n, 0.0);
        self.smooth = self.guards.parts().iter().all(Guard::needs_no_look);
        self.at_zero = false;
        let has_values = |guard: &Guard| guard.direction().has_values();
        self.undecided |= !S::READABLE && self.guards.parts().iter().any(has_values);
        for guard in 0..n {
            let (of, value) = (&self.guards[guard], self.values[guard]);
            if of.direction().has_values() && value.is_nan() {
                return Err(RunError::GuardNotANumber { guard, s });
            }
            self.at_zero |= of.zero_order() > 0;
            self.zero_orders[guard] = of.zero_order();
            self.zero_by_rounding[guard] = false;
            self.largest[guard] = value.abs();
        }
        Ok(())
    }

    /// Whether a guard is a clock.
    pub(crate) fn is_clock(&self, guard: usize) -> bool {
        self.guards[guard].direction() == Direction::Clock
    }

    /// Whether guard `first` acts before guard `second` at one instant: it has the higher priority,
    /// or is listed first.
    pub(crate) fn precedes(&self, first: usize, second: usize) -> bool {
        let rank = |guard: usize| (-i16::from(self.guards[guard].rank()), guard);
        rank(first) < rank(second)
    }

    /// The largest value of a guard in the phase over its `slope`.
    pub(crate) fn flatness(&self, guard: usize, slope: f64) -> f64 {
        let largest = self.largest[guard];
        // A guard that has always been zero has no size.
        if largest == 0.0 { 0.0 } else { largest / slope }
    }

    /// Starts the next step of this guard from a zero, from which rounding may have moved it away.
    pub(crate) fn forgive(&mut self, guard: usize) {
        self.at_zero = true;
        self.zero_orders[guard] = 1;
        self.zero_by_rounding[guard] = true;
    }

    /// Goes on after a step, at whose end the guards have these values. Where rounding hides
    /// whether time has passed since the phase began (`is_here`), guards still stand on the zeros
    /// that are forgiven.
    #[inline]
    pub(crate) fn advance(&mut self, values: &PerGuard<S, f64>, is_here: impl Fn() -> bool) {
        self.values.set(values);
        if self.at_zero && is_here() {
            self.zero_orders.parts_mut().fill(0);
        } else if self.at_zero {
            self.forget_zeros();
        }
        for (largest, value) in self.largest.parts_mut().iter_mut().zip(values.parts()) {
            *largest = if value.abs() > *largest { value.abs() } else { *largest };
        }
    }

    pub(crate) fn forget_zeros(&mut self) {
        self.at_zero = false;
        self.zero_orders.parts_mut().fill(0);
        self.zero_by_rounding.parts_mut().fill(false);
    }
}
