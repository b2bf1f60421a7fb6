//! The active mode with its guards, between two steps.

use crate::error::RunError;
use crate::events::along_step::rounding;
use crate::events::event::Event;
use crate::hybrid::{Direction, Guard, HybridSystem};
use crate::method::State;

/// The part of its largest value that a guard may have where it has just fired.
pub(crate) const NEAR_ZERO: f64 = 1e-6;

/// The active mode, and what is known about its guards at the start of the next step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Phase<Mode, const G: usize> {
    pub(crate) mode: Mode,
    pub(crate) guards: [Guard; G],
    /// Whether all guards are declared to be smooth.
    pub(crate) smooth: bool,
    /// The values of the guards.
    pub(crate) values: [f64; G],
    /// Whether any guard starts the next step from a known zero.
    pub(crate) at_zero: bool,
    /// The orders of the zeros from which the guards start the next step, 0 if they do not.
    pub(crate) zero_orders: [u32; G],
    /// Whether a guard counts as zero only because rounding may have moved it away.
    pub(crate) forgiven: [bool; G],
    /// The largest absolute values of the guards at the ends of the phase's steps.
    pub(crate) largest: [f64; G],
}

impl<Mode: Copy, const G: usize> Phase<Mode, G> {
    /// Enters `mode` at (`s`, `y`), after its guards have `fired` so often.
    pub(crate) fn enter<S: HybridSystem<N, G, Mode = Mode>, const N: usize>(
        system: &S,
        mode: Mode,
        (s, y): (f64, &State<N>),
        fired: &[u32; G],
    ) -> Result<Self, RunError> {
        let guards = system.guards(mode);
        let guards: [Guard; G] = std::array::from_fn(|guard| guards[guard].fired(fired[guard]));
        let values = system.guard_values(mode, s, y);
        for guard in 0..G {
            if guards[guard].direction() != Direction::Off && values[guard].is_nan() {
                return Err(RunError::GuardNotANumber { guard, s });
            }
        }
        Ok(Self {
            mode,
            guards,
            smooth: guards.iter().all(Guard::needs_no_look),
            values,
            at_zero: guards.iter().any(|guard| guard.zero_order() > 0),
            zero_orders: guards.map(|guard| guard.zero_order()),
            forgiven: [false; G],
            largest: values.map(f64::abs),
        })
    }

    /// Whether a guard of the mode `from` before `event` seems to be one of this mode too: where
    /// the state `y` goes on unchanged, it has the same value or its negative.
    #[inline(never)]
    fn is_same_guard<S: HybridSystem<N, G, Mode = Mode>, const N: usize>(
        &self,
        system: &S,
        (s, y): (f64, &State<N>),
        event: &Event<N>,
        (from, guard): (Mode, usize),
    ) -> bool {
        *y == event.state
            && system.guard_values(from, s, y)[guard].abs() == self.values[guard].abs()
    }

    /// Takes values that may be due to rounding of the state at `event`, which led here, for zeros.
    /// `from` is the mode before the event, and `largest` the largest value there of the guard that
    /// fired. `stood` tells which guards have fired before at the same instant and stood on their
    /// zero.
    pub(crate) fn forgive<S: HybridSystem<N, G, Mode = Mode>, const N: usize>(
        &mut self,
        system: &S,
        (s, y): (f64, &State<N>),
        event: &Event<N>,
        (from, largest): (Mode, f64),
        stood: &[bool; G],
    ) where
        Mode: PartialEq,
    {
        for (guard, &stood) in stood.iter().enumerate() {
            let (value, direction) = (self.values[guard], self.guards[guard].direction());
            // A guard that fired stands on its zero where it goes on, also exactly, and whatever
            // its rounding is.
            let is_near = || value.abs() <= NEAR_ZERO * largest.max(event.slope * event.step.h);
            let stands = !matches!(direction, Direction::Off | Direction::Below)
                && (if guard == event.guard { is_near() } else { stood })
                && self.is_same_guard(system, (s, y), event, (from, guard));
            let may_be_zero = match direction {
                Direction::Off => false,
                // On the right side, a bound of the domain needs no pardon.
                Direction::Below => value < 0.0,
                _ => stands || (guard == event.guard && from == self.mode),
            };
            if !may_be_zero || self.zero_orders[guard] > 0 {
                continue;
            }
            let value_at = |s: f64, y: &State<N>| system.guard_values(self.mode, s, y)[guard];
            let s_scale = s.abs().max(event.step.s.abs());
            let scale = event.state.zip_map(&event.step.y0, |a, b| a.abs().max(b.abs()));
            let y_scale = scale.zip_map(y, |a, b| a.max(b.abs()));
            let residual = if guard == event.guard { event.residual } else { 0.0 };
            let hidden = || rounding(value_at, (s, y), (s_scale, &y_scale)).max(residual);
            if stands || value.abs() <= hidden() {
                self.at_zero = true;
                self.zero_orders[guard] = 1;
                self.forgiven[guard] = true;
            }
        }
    }

    /// Goes on after a step, at whose end the guards have these values.
    #[inline]
    pub(crate) fn advance(&mut self, values: [f64; G]) {
        self.values = values;
        if self.at_zero {
            self.at_zero = false;
            self.zero_orders = [0; G];
            self.forgiven = [false; G];
        }
        for (largest, value) in self.largest.iter_mut().zip(values) {
            *largest = if value.abs() > *largest { value.abs() } else { *largest };
        }
    }
}
