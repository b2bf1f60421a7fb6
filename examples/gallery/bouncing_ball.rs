//! A ball of restitution y that is dropped from the height x, in units in which g = 1.

use stickslip::solver::{Direction, Guard, HybridSystem, Start, State};
use stickslip::tracer::{Point, Window};

pub const WINDOW: Window = Window { low: Point::new(0.5, 0.3), high: Point::new(2.0, 0.8) };
pub const AXES: [&str; 2] = ["height of the drop (g = 1)", "restitution"];

pub struct Ball {
    restitution: f64,
}

impl HybridSystem<2, 1> for Ball {
    type Mode = ();

    fn field(&self, (): (), _: f64, y: &State<2>) -> State<2> {
        State::from([y[1], -1.0])
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

pub fn drop(point: &Point) -> (Ball, Start<(), 2>) {
    let start = Start { mode: (), s: 0.0, state: State::from([point.x, 0.0]) };
    (Ball { restitution: point.y }, start)
}

/// The number of bounces before the time 5, in closed form: the k-th one is at √(2x) times
/// 1 + 2(y + … + yᵏ⁻¹).
pub fn bounces(point: &Point) -> usize {
    let (fall, mut hop, mut time) = ((2.0 * point.x).sqrt(), 1.0, 0.0);
    let mut count = 0;
    loop {
        time += if count == 0 { fall } else { 2.0 * fall * hop };
        if time > 5.0 || count == 100 {
            return count;
        }
        count += 1;
        hop *= point.y;
    }
}
