//! A boost converter under current control. A clock closes the switch at every whole time; it opens
//! when the current reaches its reference. Then the diode conducts until the current vanishes.

use stickslip::solver::{Direction, Guard, HybridSystem, Start, State};
use stickslip::tracer::{Point, Window, hybrid::Itinerary};

/// Supply and reference.
pub const WINDOW: Window = Window { low: Point::new(0.5, 0.5), high: Point::new(1.5, 2.0) };
pub const AXES: [&str; 2] = ["supply voltage (inductance and period 1)", "reference current"];

const LOAD: f64 = 2.0;
const CAPACITY: f64 = 2.0;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Switch {
    Closed,
    Open,
    /// The switch is open, and no current flows.
    Idle,
}

pub struct Converter {
    supply: f64,
    reference: f64,
}

impl HybridSystem<2, 3> for Converter {
    /// The switch, and the number of the next tick.
    type Mode = (Switch, u32);

    /// Current and voltage; the inductance is 1.
    fn field(&self, (switch, _): (Switch, u32), _: f64, y: &State<2>) -> State<2> {
        let drain = -y[1] / LOAD;
        match switch {
            Switch::Closed => State::from([self.supply, drain / CAPACITY]),
            Switch::Open => State::from([self.supply - y[1], (y[0] + drain) / CAPACITY]),
            Switch::Idle => State::from([0.0, drain / CAPACITY]),
        }
    }
    /// The tick, the reference, and the end of the current.
    fn guards(&self, (switch, _): (Switch, u32)) -> [Guard; 3] {
        let guard = Guard::new(Direction::Below);
        let [reference, current] = match switch {
            Switch::Closed => [guard, Guard::OFF],
            Switch::Open => [Guard::OFF, guard],
            Switch::Idle => [Guard::OFF, Guard::OFF],
        };
        [guard, reference, current]
    }
    fn guard_values(&self, (_, tick): (Switch, u32), t: f64, y: &State<2>) -> [f64; 3] {
        [f64::from(tick) - t, self.reference - y[0], y[0]]
    }
    fn transition(
        &self,
        (_, tick): (Switch, u32),
        guard: usize,
        _: f64,
        y: &State<2>,
    ) -> ((Switch, u32), State<2>) {
        match guard {
            0 => ((Switch::Closed, tick + 1), *y),
            1 => ((Switch::Open, tick), *y),
            _ => ((Switch::Idle, tick), State::from([0.0, y[1]])),
        }
    }
}

pub fn boost(point: &Point) -> (Converter, Start<(Switch, u32), 2>) {
    let converter = Converter { supply: point.x, reference: point.y };
    (converter, Start { mode: (Switch::Closed, 1), s: 0.0, state: State::zeros() })
}

/// The current rises as Et, so that k ticks come before it reaches a reference between kE and
/// (k + 1)E.
pub fn fits(point: &Point, label: &Itinerary) -> bool {
    let fired = label.fired().unwrap_or_default();
    let ticks = fired.iter().take_while(|guard| **guard == 0).count();
    ticks as f64 == (point.y / point.x).floor()
}
