//! A ball on a vibrating table, thrown up from it. The table has the height A sin t; the parameters
//! are its amplitude A, as an acceleration in units of gravity, and the restitution.

use stickslip::solver::{Direction, Guard, HybridSystem, Start, State};
use stickslip::tracer::{Point, Window};

pub const WINDOW: Window = Window { low: Point::new(0.3, 0.3), high: Point::new(1.5, 0.9) };
pub const AXES: [&str; 2] = ["amplitude of the table's acceleration in units of g", "restitution"];

pub struct Table {
    amplitude: f64,
    restitution: f64,
}

impl HybridSystem<2, 1> for Table {
    type Mode = ();

    /// The height above the table and its rate.
    fn field(&self, (): (), t: f64, y: &State<2>) -> State<2> {
        State::from([y[1], -1.0 + self.amplitude * t.sin()])
    }
    fn guards(&self, (): ()) -> [Guard; 1] {
        [Guard::new(Direction::Below)]
    }
    fn guard_values(&self, (): (), _: f64, y: &State<2>) -> [f64; 1] {
        [y[0]]
    }
    fn transition(&self, (): (), _: usize, _: f64, y: &State<2>) -> ((), State<2>) {
        ((), State::from([0.0, -self.restitution * y[1]]))
    }
}

pub fn throw(point: &Point) -> (Table, Start<(), 2>) {
    let start = Start { mode: (), s: 0.0, state: State::from([0.0, 1.0]) };
    (Table { amplitude: point.x, restitution: point.y }, start)
}
