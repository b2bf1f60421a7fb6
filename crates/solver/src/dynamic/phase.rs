//! The active mode of a dynamic system with its guards, between two steps.

use crate::dynamic::curve::{Work, rounding};
use crate::dynamic::event::Event;
use crate::dynamic::system::{DynamicSystem, SignedGuard};
use crate::error::RunError;
use crate::hybrid::{Direction, Guard};

/// The active mode, and what is known about its guards at the start of the next step.
pub(crate) struct Phase<Mode> {
    pub(crate) mode: Mode,
    pub(crate) guards: Vec<Guard>,
    /// Whether all guards are declared to be smooth.
    pub(crate) smooth: bool,
    /// The values of the guards.
    pub(crate) values: Vec<f64>,
    /// Whether any guard starts the next step from a known zero.
    pub(crate) at_zero: bool,
    /// The orders of the zeros from which the guards start the next step, 0 if they do not.
    pub(crate) zero_orders: Vec<u32>,
    /// Whether a guard counts as zero only because rounding may have moved it away.
    pub(crate) forgiven: Vec<bool>,
    /// The largest absolute values of the guards at the ends of the phase's steps.
    pub(crate) largest: Vec<f64>,
}

impl<Mode: Copy> Phase<Mode> {
    /// Room for the phases of a run that starts in `mode`.
    pub(crate) fn new(mode: Mode) -> Self {
        Self {
            mode,
            guards: Vec::new(),
            smooth: true,
            values: Vec::new(),
            at_zero: false,
            zero_orders: Vec::new(),
            forgiven: Vec::new(),
            largest: Vec::new(),
        }
    }

    /// Enters `mode` at (`s`, `y`), after guards have `fired` so often.
    pub(crate) fn enter<S: DynamicSystem<Mode = Mode>>(
        &mut self,
        system: &S,
        mode: Mode,
        (s, y): (f64, &[f64]),
        fired: &[u32],
    ) -> Result<(), RunError> {
        let guards = system.guards(mode);
        let count = |guard: usize| fired.get(guard).copied().unwrap_or(0);
        self.mode = mode;
        self.guards.clear();
        self.guards.extend(guards.iter().enumerate().map(|(i, guard)| guard.fired(count(i))));
        self.values.clear();
        self.values.resize(guards.len(), f64::NAN);
        system.guard_values(mode, s, y, &mut self.values);
        for (guard, value) in self.values.iter().enumerate() {
            if self.guards[guard].direction() != Direction::Off && value.is_nan() {
                return Err(RunError::GuardNotANumber { guard, s });
            }
        }
        self.smooth = self.guards.iter().all(Guard::needs_no_look);
        self.at_zero = self.guards.iter().any(|guard| guard.zero_order() > 0);
        self.zero_orders.clear();
        self.zero_orders.extend(self.guards.iter().map(Guard::zero_order));
        self.forgiven.clear();
        self.forgiven.resize(guards.len(), false);
        self.largest.clear();
        self.largest.extend(self.values.iter().map(|value| value.abs()));
        Ok(())
    }

    /// Takes values that may be due to rounding of the state at `event`, which led here, for zeros.
    /// `same` tells whether the guard that fired is the same as before the event, and `stands`
    /// which guards go on where they fired at this instant, whatever their rounding is. The sizes
    /// of the time and of the components near the event are `s_scale` and `work.scale`.
    pub(crate) fn forgive<S: DynamicSystem<Mode = Mode>>(
        &mut self,
        system: &S,
        (s, y): (f64, &[f64]),
        event: &Event,
        (same, stands): (bool, &[bool]),
        s_scale: f64,
        work: &mut Work,
    ) -> usize {
        let mut count = 0;
        for guard in 0..self.guards.len() {
            let (value, direction) = (self.values[guard], self.guards[guard].direction());
            let may_be_zero = match direction {
                Direction::Off => false,
                // On the right side, a bound of the domain needs no pardon.
                Direction::Below => value < 0.0,
                // A guard that fired stands on its zero where it goes on, also exactly.
                _ => stands[guard] || guard == event.guard && same,
            };
            if !may_be_zero || self.zero_orders[guard] > 0 {
                continue;
            }
            let at = SignedGuard { system, mode: self.mode, guard, sign: 1.0 };
            let Work { moved, values, scale, .. } = &mut *work;
            values.resize(self.guards.len(), 0.0);
            let (hidden, evaluations) = rounding(&at, (s, y), (s_scale, scale), moved, values);
            count += evaluations;
            let residual = if guard == event.guard { event.residual } else { 0.0 };
            let stands = stands[guard] && direction != Direction::Below;
            if stands || value.abs() <= hidden.max(residual) {
                self.at_zero = true;
                self.zero_orders[guard] = 1;
                self.forgiven[guard] = true;
            }
        }
        count
    }

    /// Goes on after a step, at whose end the guards have these values.
    pub(crate) fn advance(&mut self, values: &[f64]) {
        self.values.copy_from_slice(values);
        if self.at_zero {
            self.at_zero = false;
            self.zero_orders.fill(0);
            self.forgiven.fill(false);
        }
        for (largest, value) in self.largest.iter_mut().zip(values) {
            *largest = if value.abs() > *largest { value.abs() } else { *largest };
        }
    }
}
