//! A relay with hysteresis h that drives an oscillator: x″ + 2ζx′ + x = ±1, where the sign changes
//! to − when x rises to h, and to + when x falls to −h.

use stickslip::solver::{Direction, Guard, HybridSystem, Start, State};
use stickslip::tracer::{Point, Window};

/// Damping and hysteresis.
pub const WINDOW: Window = Window { low: Point::new(0.05, 0.1), high: Point::new(0.6, 2.5) };
pub const AXES: [&str; 2] = ["damping ratio ζ", "hysteresis h in units of the relay's force"];

pub struct Relay {
    damping: f64,
    hysteresis: f64,
}

impl HybridSystem<2, 1> for Relay {
    /// Whether the relay pushes.
    type Mode = bool;

    fn field(&self, pushes: bool, _: f64, y: &State<2>) -> State<2> {
        let force = if pushes { 1.0 } else { -1.0 };
        State::from([y[1], force - y[0] - 2.0 * self.damping * y[1]])
    }
    fn guards(&self, _: bool) -> [Guard; 1] {
        [Guard::new(Direction::Below)]
    }
    fn guard_values(&self, pushes: bool, _: f64, y: &State<2>) -> [f64; 1] {
        [self.hysteresis + if pushes { -y[0] } else { y[0] }]
    }
    fn transition(&self, pushes: bool, _: usize, _: f64, y: &State<2>) -> (bool, State<2>) {
        (!pushes, *y)
    }
}

pub fn start(point: &Point) -> (Relay, Start<bool, 2>) {
    let relay = Relay { damping: point.x, hysteresis: point.y };
    (relay, Start { mode: true, s: 0.0, state: State::zeros() })
}

/// Whether the relay never switches: its hysteresis is above the first peak of the step response,
/// 1 + exp(−πζ/√(1 − ζ²)). K. Ogata, *Modern Control Engineering* (2010), section 5-3.
pub fn is_still(point: &Point) -> bool {
    let (damping, hysteresis) = (point.x, point.y);
    let overshoot = (-std::f64::consts::PI * damping / (1.0 - damping * damping).sqrt()).exp();
    hysteresis > 1.0 + overshoot
}
