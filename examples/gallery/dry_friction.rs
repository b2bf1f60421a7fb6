//! A mass on a spring with dry friction, shaken: x″ + x = A cos Ωt − F sgn x′. Where x′ vanishes
//! the mass sticks if the load |A cos Ωt − x| is below F, and turns or goes on if not.

use stickslip::solver::{Direction, Guard, HybridSystem, Start, State};
use stickslip::tracer::{Point, Window};

/// Frequency Ω and amplitude A; F = 1.
pub const WINDOW: Window = Window { low: Point::new(0.3, 1.2), high: Point::new(1.8, 4.0) };
pub const AXES: [&str; 2] =
    ["frequency Ω in units of √(k/m)", "amplitude of the force in units of the friction"];

pub struct Shaken {
    frequency: f64,
    amplitude: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mode {
    Stick,
    /// With the sign of the velocity, and the order of the zero from which it starts.
    Slip(f64, u32),
}

impl Shaken {
    fn load(&self, t: f64, x: f64) -> f64 {
        self.amplitude * (self.frequency * t).cos() - x
    }
}

impl HybridSystem<2, 2> for Shaken {
    type Mode = Mode;

    fn field(&self, mode: Mode, t: f64, y: &State<2>) -> State<2> {
        match mode {
            Mode::Stick => State::zeros(),
            Mode::Slip(sign, _) => State::from([y[1], self.load(t, y[0]) - sign]),
        }
    }
    /// The load leaves its limits above or below; or the velocity vanishes.
    fn guards(&self, mode: Mode) -> [Guard; 2] {
        let guard = Guard::new(Direction::Below);
        match mode {
            Mode::Stick => [guard; 2],
            Mode::Slip(_, order) => [guard.from_zero(order), Guard::OFF],
        }
    }
    fn guard_values(&self, mode: Mode, t: f64, y: &State<2>) -> [f64; 2] {
        let load = self.load(t, y[0]);
        match mode {
            Mode::Stick => [1.0 - load, 1.0 + load],
            Mode::Slip(sign, _) => [sign * y[1], 1.0],
        }
    }
    fn transition(&self, mode: Mode, guard: usize, t: f64, y: &State<2>) -> (Mode, State<2>) {
        let rest = State::from([y[0], 0.0]);
        match mode {
            // The velocity starts from a double zero, since the load is at its limit.
            Mode::Stick => (Mode::Slip(if guard == 0 { 1.0 } else { -1.0 }, 2), rest),
            // Friction has the other sign after a turn.
            Mode::Slip(sign, _) if -sign * self.load(t, y[0]) > 1.0 => (Mode::Slip(-sign, 1), rest),
            Mode::Slip(..) => (Mode::Stick, rest),
        }
    }
    fn transition_condition(&self, mode: Mode, _: usize, t: f64, y: &State<2>) -> f64 {
        match mode {
            Mode::Stick => f64::NAN,
            Mode::Slip(sign, _) => -sign * self.load(t, y[0]) - 1.0,
        }
    }
}

pub fn shake(point: &Point) -> (Shaken, Start<Mode, 2>) {
    let system = Shaken { frequency: point.x, amplitude: point.y };
    (system, Start { mode: Mode::Slip(1.0, 1), s: 0.0, state: State::zeros() })
}
