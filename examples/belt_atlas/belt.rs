//! A mass on a spring, on a belt with dry friction, which is shaken harmonically: the system
//! itself.

use stickslip::solver::{Direction, Guard, HybridSystem, Start, State};
use stickslip::tracer::{Point, Window, hybrid::Problem};

/// The velocity of the belt.
pub const BELT: f64 = 0.3;
/// The position at which the mass starts.
pub const POSITION: f64 = 0.5;
/// The time at which a run ends.
pub const OBSERVED: f64 = 18.0;
pub const WINDOW: Window = Window { low: Point::new(0.25, 0.5), high: Point::new(0.45, 1.2) };

/// The belt with frequency Ω and amplitude f.
#[derive(Clone, Copy)]
pub struct Belt {
    pub frequency: f64,
    pub amplitude: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mode {
    Stick,
    Slip,
}

impl HybridSystem<2, 2> for Belt {
    type Mode = Mode;

    fn field(&self, mode: Mode, t: f64, y: &State<2>) -> State<2> {
        let rise = BELT - y[0] + self.amplitude * self.frequency * (self.frequency * t).sin();
        State::from([if mode == Mode::Slip { y[1] } else { 0.0 }, rise])
    }

    fn guards(&self, mode: Mode) -> [Guard; 2] {
        let guard = Guard::new(Direction::Below);
        [guard.from_zero(if mode == Mode::Slip { 2 } else { 0 }), guard.terminal()]
    }

    fn guard_values(&self, mode: Mode, t: f64, y: &State<2>) -> [f64; 2] {
        [if mode == Mode::Slip { y[0] } else { -y[1] }, OBSERVED - t]
    }

    fn transition(&self, mode: Mode, _: usize, _: f64, y: &State<2>) -> (Mode, State<2>) {
        match mode {
            Mode::Stick => (Mode::Slip, State::zeros()),
            Mode::Slip => (Mode::Stick, State::from([0.0, y[1]])),
        }
    }
}

/// The belts of all points of the plane.
pub struct Belts;

impl Problem<2, 2> for Belts {
    type System = Belt;

    fn at(&self, point: &Point) -> (Belt, Start<Mode, 2>) {
        let state = State::from([0.0, POSITION - point.y - 1.0]);
        let start = Start { mode: Mode::Stick, s: 0.0, state };
        (Belt { frequency: point.x, amplitude: point.y }, start)
    }
}
