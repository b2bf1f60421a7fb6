//! A mass on a spring under a relay that switches a dead time after the mass has come to ±0.2:
//! x″ + 0.6 x′ + x = ±K. The third state is the time since then.

use stickslip::solver::{Direction, Guard, HybridSystem, Start, State};
use stickslip::tracer::{Point, Window};

/// Dead time and gain K.
pub const WINDOW: Window = Window { low: Point::new(0.05, 0.5), high: Point::new(0.6, 3.0) };

pub struct Delayed {
    dead_time: f64,
    gain: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mode {
    /// With the sign of the force.
    On(f64),
    Waits(f64),
}

impl HybridSystem<3, 1> for Delayed {
    type Mode = Mode;

    fn field(&self, mode: Mode, _: f64, y: &State<3>) -> State<3> {
        let (Mode::On(sign) | Mode::Waits(sign)) = mode;
        State::from([y[1], self.gain * sign - y[0] - 0.6 * y[1], 1.0])
    }
    fn guards(&self, _: Mode) -> [Guard; 1] {
        [Guard::new(Direction::Below)]
    }
    fn guard_values(&self, mode: Mode, _: f64, y: &State<3>) -> [f64; 1] {
        match mode {
            Mode::On(sign) => [0.2 - sign * y[0]],
            Mode::Waits(_) => [self.dead_time - y[2]],
        }
    }
    fn transition(&self, mode: Mode, _: usize, _: f64, y: &State<3>) -> (Mode, State<3>) {
        match mode {
            Mode::On(sign) => (Mode::Waits(sign), State::from([y[0], y[1], 0.0])),
            Mode::Waits(sign) => (Mode::On(-sign), *y),
        }
    }
}

pub fn switch_on(point: &Point) -> (Delayed, Start<Mode, 3>) {
    let system = Delayed { dead_time: point.x, gain: point.y };
    (system, Start { mode: Mode::On(1.0), s: 0.0, state: State::zeros() })
}
