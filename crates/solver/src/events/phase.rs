//! The active mode with its guards, between two steps.

use crate::error::RunError;
use crate::events::event::Event;
use crate::hybrid::{Direction, Guard, HybridSystem};
use crate::method::State;

/// The active mode, and what is known about its guards at the start of the next step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Phase<Mode, const G: usize> {
    pub(crate) mode: Mode,
    pub(crate) guards: [Guard; G],
    /// The values of the guards.
    pub(crate) values: [f64; G],
    /// Whether any guard starts the next step from a known zero.
    pub(crate) at_zero: bool,
    /// The orders of the zeros from which the guards start the next step, 0 if they do not.
    pub(crate) zero_orders: [u32; G],
    /// The signs with which the guards leave these zeros, 0 if a sign is not known.
    pub(crate) sides: [f64; G],
    /// The absolute values up to which a guard counts as zero, if its sign is known.
    pub(crate) hidden: [f64; G],
    /// Whether a guard has crossed already and fires at the start of the next step.
    pub(crate) due: [bool; G],
    /// The largest absolute values of the guards at the ends of the phase's steps.
    pub(crate) largest: [f64; G],
}

/// Where the guards stand after an event that changes nothing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Standing<const G: usize> {
    /// The guards that have fired with the event, one bit each.
    pub(crate) fired: u32,
    /// The orders of the zeros at which the guards stand, 0 for guards that are not at zero.
    pub(crate) zero_orders: [u32; G],
    /// The signs with which the guards leave these zeros, 0 if a sign is not known.
    pub(crate) sides: [f64; G],
    /// The absolute values up to which a guard counts as zero.
    pub(crate) hidden: [f64; G],
    /// Whether a guard has crossed already and fires next.
    pub(crate) due: [bool; G],
}

impl<Mode: Copy, const G: usize> Phase<Mode, G> {
    /// Enters `mode` at (`s`, `y`).
    pub(crate) fn enter<S: HybridSystem<N, G, Mode = Mode>, const N: usize>(
        system: &S,
        mode: Mode,
        s: f64,
        y: &State<N>,
    ) -> Result<Self, RunError> {
        let guards = system.guards(mode);
        let values = system.guard_values(mode, s, y);
        for guard in 0..G {
            if guards[guard].direction() != Direction::Off && values[guard].is_nan() {
                return Err(RunError::GuardNotANumber { guard, s });
            }
        }
        Ok(Self {
            mode,
            guards,
            values,
            at_zero: guards.iter().any(|guard| guard.zero_order() > 0),
            zero_orders: guards.map(|guard| guard.zero_order()),
            sides: [0.0; G],
            hidden: [0.0; G],
            due: [false; G],
            largest: values.map(f64::abs),
        })
    }

    /// Goes on in the same mode after `event`, in another state. If the guard that fired is still
    /// at zero, it starts from a known zero.
    pub(crate) fn resume<const N: usize>(&mut self, event: &Event<N>) {
        let guard = event.guard;
        if self.values[guard].abs() <= event.residual {
            self.at_zero = true;
            self.zero_orders[guard] = self.zero_orders[guard].max(1);
        }
    }

    /// Goes on after an event that changes neither mode nor state.
    pub(crate) fn stand(&mut self, standing: &Standing<G>) {
        self.at_zero = true;
        self.zero_orders = standing.zero_orders;
        self.sides = standing.sides;
        self.hidden = standing.hidden;
        self.due = standing.due;
    }

    /// Goes on after a step, at whose end the guards have these values.
    #[inline]
    pub(crate) fn advance(&mut self, values: [f64; G]) {
        self.values = values;
        if self.at_zero {
            self.at_zero = false;
            self.zero_orders = [0; G];
            self.sides = [0.0; G];
            self.due = [false; G];
        }
        for (largest, value) in self.largest.iter_mut().zip(values) {
            *largest = if value.abs() > *largest { value.abs() } else { *largest };
        }
    }
}
