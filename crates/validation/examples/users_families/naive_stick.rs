//! A shaken mass with dry friction, written without a thought of sliding modes: x″ + x = A cos Ωt −
//! F while it slips to the right. It slips until its velocity vanishes, then it sticks; and it
//! sticks until |A cos Ωt − x| exceeds 1, which may be at once. Nothing is said of the zeros from
//! which guards start.
//!
//! If F is below 1 the velocity leaves its zero with a slope. If F is 1 too, it starts from a
//! double zero, and rounding decides whether the mass sticks again at once:
//! [`Guard::from_zero`](stickslip::solver::Guard::from_zero) would have to say so.

use stickslip::solver::{Direction, Guard, HybridSystem, Start, State};
use stickslip::tracer::Point;

pub struct Shaken {
    frequency: f64,
    amplitude: f64,
    /// The friction F while the mass slips.
    kinetic: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mode {
    Stick,
    /// With the sign of the velocity.
    Slip(f64),
}

impl Shaken {
    fn force(&self, t: f64, x: f64) -> f64 {
        self.amplitude * (self.frequency * t).cos() - x
    }
}

impl HybridSystem<2, 1> for Shaken {
    type Mode = Mode;

    fn field(&self, mode: Mode, t: f64, y: &State<2>) -> State<2> {
        match mode {
            Mode::Stick => State::zeros(),
            Mode::Slip(sign) => State::from([y[1], self.force(t, y[0]) - sign * self.kinetic]),
        }
    }
    fn guards(&self, _: Mode) -> [Guard; 1] {
        [Guard::new(Direction::Below)]
    }
    fn guard_values(&self, mode: Mode, t: f64, y: &State<2>) -> [f64; 1] {
        match mode {
            Mode::Stick => [1.0 - self.force(t, y[0]).abs()],
            Mode::Slip(sign) => [sign * y[1]],
        }
    }
    fn transition(&self, mode: Mode, _: usize, t: f64, y: &State<2>) -> (Mode, State<2>) {
        let next = match mode {
            Mode::Stick => Mode::Slip(self.force(t, y[0]).signum()),
            Mode::Slip(_) => Mode::Stick,
        };
        (next, State::from([y[0], 0.0]))
    }
}

pub fn shake(point: &Point) -> (Shaken, Start<Mode, 2>) {
    with_friction(point, 0.6)
}

pub fn shake_with_one_friction(point: &Point) -> (Shaken, Start<Mode, 2>) {
    with_friction(point, 1.0)
}

fn with_friction(point: &Point, kinetic: f64) -> (Shaken, Start<Mode, 2>) {
    let system = Shaken { frequency: point.x, amplitude: point.y, kinetic };
    (system, Start { mode: Mode::Stick, s: 0.0, state: State::zeros() })
}
