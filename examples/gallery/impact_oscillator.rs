//! A forced oscillator that hits a wall at x = 0.2: x″ + x′/10 + x = cos Ωt below the wall, and
//! x′ → −r x′ at it.

use stickslip::solver::{Direction, Guard, HybridSystem, Start, State};
use stickslip::tracer::{Point, Window};

/// Frequency and restitution.
pub const WINDOW: Window = Window { low: Point::new(2.0, 0.2), high: Point::new(3.5, 0.95) };
pub const AXES: [&str; 2] = ["frequency Ω in units of √(k/m)", "restitution"];

pub struct Oscillator {
    pub frequency: f64,
    pub restitution: f64,
    /// The place of the wall.
    pub gap: f64,
}

impl HybridSystem<2, 1> for Oscillator {
    type Mode = ();

    fn field(&self, (): (), t: f64, y: &State<2>) -> State<2> {
        State::from([y[1], (self.frequency * t).cos() - y[0] - 0.1 * y[1]])
    }
    fn guards(&self, (): ()) -> [Guard; 1] {
        [Guard::new(Direction::Below)]
    }
    fn guard_values(&self, (): (), _: f64, y: &State<2>) -> [f64; 1] {
        [self.gap - y[0]]
    }
    fn transition(&self, (): (), _: usize, _: f64, y: &State<2>) -> ((), State<2>) {
        ((), State::from([self.gap, -self.restitution * y[1]]))
    }
}

pub fn start(point: &Point) -> (Oscillator, Start<(), 2>) {
    let oscillator = Oscillator { frequency: point.x, restitution: point.y, gap: 0.2 };
    (oscillator, Start { mode: (), s: 0.0, state: State::zeros() })
}
