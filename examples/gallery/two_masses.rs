//! Two masses on a belt, each on a spring to the wall and both coupled by a third one. Each sticks
//! to the belt while its load is below the friction, which is 1 for the first and 1.3 for the
//! second mass, and slips slower than the belt otherwise, with kinetic friction of 0.6 of that.

use stickslip::solver::{Direction, Guard, HybridSystem, Start, State};
use stickslip::tracer::{Point, Window};

/// Stiffness of the coupling, and velocity of the belt.
pub const WINDOW: Window = Window { low: Point::new(0.3, 0.1), high: Point::new(2.0, 0.6) };
pub const AXES: [&str; 2] =
    ["stiffness of the coupling in units of k", "velocity of the belt in units of F/√(km)"];

pub struct Masses {
    coupling: f64,
    belt: f64,
}

const FRICTION: [f64; 2] = [1.0, 1.3];
const KINETIC: f64 = 0.6;

impl Masses {
    /// What the springs pull with against the belt.
    fn loads(&self, y: &State<4>) -> [f64; 2] {
        let between = self.coupling * (y[0] - y[1]);
        [y[0] + between, y[1] - between]
    }
}

impl HybridSystem<4, 2> for Masses {
    /// Whether each mass slips.
    type Mode = [bool; 2];

    fn field(&self, slips: [bool; 2], _: f64, y: &State<4>) -> State<4> {
        let loads = self.loads(y);
        let mut rates = [0.0; 4];
        for mass in 0..2 {
            rates[mass] = if slips[mass] { y[2 + mass] } else { self.belt };
            rates[2 + mass] =
                if slips[mass] { KINETIC * FRICTION[mass] - loads[mass] } else { 0.0 };
        }
        State::from(rates)
    }
    fn guards(&self, slips: [bool; 2]) -> [Guard; 2] {
        // A mass that begins to slip has the velocity of the belt, exactly.
        slips.map(|_| Guard::new(Direction::Below))
    }
    fn guard_values(&self, slips: [bool; 2], _: f64, y: &State<4>) -> [f64; 2] {
        let loads = self.loads(y);
        std::array::from_fn(|mass| {
            if slips[mass] { self.belt - y[2 + mass] } else { FRICTION[mass] - loads[mass] }
        })
    }
    fn transition(
        &self,
        mut slips: [bool; 2],
        mass: usize,
        _: f64,
        y: &State<4>,
    ) -> ([bool; 2], State<4>) {
        slips[mass] = !slips[mass];
        let mut after = *y;
        after[2 + mass] = self.belt;
        (slips, after)
    }
}

pub fn belt(point: &Point) -> (Masses, Start<[bool; 2], 4>) {
    let masses = Masses { coupling: point.x, belt: point.y };
    let state = State::from([0.0, 0.3, point.y, point.y]);
    (masses, Start { mode: [false; 2], s: 0.0, state })
}
