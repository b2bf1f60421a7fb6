//! A pendulum that is pushed from side to side between two stops, at which it loses two fifths of
//! its velocity: θ″ + θ′/5 + sin θ = A sin Ωt for −0.5 < θ < 0.4.

use stickslip::solver::{Direction, Guard, HybridSystem, Start, State};
use stickslip::tracer::{Point, Window};

/// Frequency and amplitude.
pub const WINDOW: Window = Window { low: Point::new(0.5, 0.3), high: Point::new(2.5, 1.5) };

const STOPS: [f64; 2] = [0.4, -0.5];

pub struct Pendulum {
    frequency: f64,
    amplitude: f64,
}

impl HybridSystem<2, 2> for Pendulum {
    type Mode = ();

    fn field(&self, (): (), t: f64, y: &State<2>) -> State<2> {
        let push = self.amplitude * (self.frequency * t).sin();
        State::from([y[1], push - y[0].sin() - 0.2 * y[1]])
    }
    fn guards(&self, (): ()) -> [Guard; 2] {
        [Guard::new(Direction::Below), Guard::new(Direction::Below)]
    }
    fn guard_values(&self, (): (), _: f64, y: &State<2>) -> [f64; 2] {
        [STOPS[0] - y[0], y[0] - STOPS[1]]
    }
    fn transition(&self, (): (), guard: usize, _: f64, y: &State<2>) -> ((), State<2>) {
        ((), State::from([STOPS[guard], -0.6 * y[1]]))
    }
}

pub fn push(point: &Point) -> (Pendulum, Start<(), 2>) {
    let system = Pendulum { frequency: point.x, amplitude: point.y };
    (system, Start { mode: (), s: 0.0, state: State::from([0.1, 0.0]) })
}
