//! A slender block that rocks on shaking ground (Housner, 1963): it stands until the ground
//! accelerates by more than g tan α, turns about an edge, and changes the edge at an impact.

use stickslip::solver::{Direction, Guard, HybridSystem, Start, State};
use stickslip::tracer::{Point, Window};

/// Frequency of the ground, and its acceleration in units of α g.
pub const WINDOW: Window = Window { low: Point::new(1.5, 0.5), high: Point::new(6.0, 3.0) };

/// The angle α between the edge and the line from its corner to the centre.
const SLENDERNESS: f64 = 0.25;

pub struct Block {
    frequency: f64,
    amplitude: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mode {
    Stands,
    /// With the sign of the angle.
    Rocks(f64),
}

impl Block {
    fn ground(&self, t: f64) -> f64 {
        self.amplitude * SLENDERNESS * (self.frequency * t).sin()
    }
}

impl HybridSystem<2, 2> for Block {
    type Mode = Mode;

    fn field(&self, mode: Mode, t: f64, y: &State<2>) -> State<2> {
        let Mode::Rocks(sign) = mode else { return State::zeros() };
        let (sine, cosine) = (sign * SLENDERNESS - y[0]).sin_cos();
        State::from([y[1], self.ground(t) * cosine - sine])
    }
    fn guards(&self, mode: Mode) -> [Guard; 2] {
        let second = if mode == Mode::Stands { Guard::new(Direction::Below) } else { Guard::OFF };
        [Guard::new(Direction::Below), second]
    }
    fn guard_values(&self, mode: Mode, t: f64, y: &State<2>) -> [f64; 2] {
        let least = SLENDERNESS.tan();
        match mode {
            Mode::Stands => [least - self.ground(t), least + self.ground(t)],
            Mode::Rocks(sign) => [sign * y[0], 1.0],
        }
    }
    fn transition(&self, mode: Mode, guard: usize, _: f64, y: &State<2>) -> (Mode, State<2>) {
        match mode {
            Mode::Stands => (Mode::Rocks(if guard == 0 { 1.0 } else { -1.0 }), State::zeros()),
            Mode::Rocks(sign) => {
                let kept = 1.0 - 1.5 * SLENDERNESS.sin().powi(2);
                (Mode::Rocks(-sign), State::from([0.0, kept * y[1]]))
            }
        }
    }
}

pub fn shake(point: &Point) -> (Block, Start<Mode, 2>) {
    let system = Block { frequency: point.x, amplitude: point.y };
    (system, Start { mode: Mode::Stands, s: 0.0, state: State::zeros() })
}
