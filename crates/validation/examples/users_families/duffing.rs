//! A Duffing oscillator, x″ + x′/10 − x + x³ = A cos Ωt, that starts from rest in the well at
//! x = 1. It is smooth; what counts are its passages through x = 1/2, in both directions.

use stickslip::solver::{Direction, Guard, HybridSystem, Start, State};
use stickslip::tracer::{Point, Window};

/// Frequency Ω and amplitude A.
pub const WINDOW: Window = Window { low: Point::new(0.6, 0.2), high: Point::new(1.6, 0.9) };

pub struct Duffing {
    frequency: f64,
    amplitude: f64,
}

const SECTION: f64 = 0.5;

impl HybridSystem<2, 1> for Duffing {
    type Mode = ();

    fn field(&self, (): (), t: f64, y: &State<2>) -> State<2> {
        let force = self.amplitude * (self.frequency * t).cos();
        State::from([y[1], force + y[0] - y[0].powi(3) - 0.1 * y[1]])
    }
    fn guards(&self, (): ()) -> [Guard; 1] {
        [Guard::new(Direction::Either)]
    }
    fn guard_values(&self, (): (), _: f64, y: &State<2>) -> [f64; 1] {
        [y[0] - SECTION]
    }
    fn transition(&self, (): (), _: usize, _: f64, y: &State<2>) -> ((), State<2>) {
        ((), *y)
    }
}

pub fn shake(point: &Point) -> (Duffing, Start<(), 2>) {
    let system = Duffing { frequency: point.x, amplitude: point.y };
    (system, Start { mode: (), s: 0.0, state: State::from([1.0, 0.0]) })
}
