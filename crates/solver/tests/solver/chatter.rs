//! A ball that comes to rest on a shaking table hops, in the end, by less than the rounding of its
//! height. It must not fall through, and its hops accumulate.

use stickslip_solver::{
    Direction, Dop853, Dopri5, Guard, Method, Number, Options, Outcome, ReadableSystem, Start,
    State,
};

use crate::erased::run;

struct Ball {
    amplitude: f64,
    restitution: f64,
    floor: Direction,
}

const RATE: f64 = std::f64::consts::TAU;

impl ReadableSystem<3, 2> for Ball {
    type Mode = ();

    fn field<T: Number>(&self, (): (), _s: T, y: &[T; 3]) -> [T; 3] {
        [y[1], T::from(-1.0), T::from(RATE)]
    }

    fn guards(&self, (): ()) -> [Guard; 2] {
        [Guard::new(self.floor), Guard::new(Direction::Rising)]
    }

    fn guard_values<T: Number>(&self, (): (), _s: T, y: &[T; 3]) -> [T; 2] {
        [y[0] - y[2].sin() * self.amplitude, y[2] - RATE]
    }

    fn transition(&self, (): (), guard: usize, _s: f64, y: &State<3>) -> ((), State<3>) {
        let mut y = *y;
        if guard == 0 {
            y[0] = self.amplitude * y[2].sin();
            let table = self.amplitude * RATE * y[2].cos();
            y[1] = (1.0 + self.restitution) * table - self.restitution * y[1];
        } else {
            y[2] -= RATE;
        }
        ((), y)
    }
}

/// How many of 40 tables a ball comes to rest on within 150 periods.
fn rests(method: impl Method, floor: Direction) -> usize {
    let mut rests = 0;
    for index in 0..40 {
        let amplitude = 0.034 + 6e-4 * f64::from(index);
        let ball = Ball { amplitude, restitution: 0.7, floor };
        let start = Start { mode: (), s: 0.0, state: State::from([0.015, 0.5, 0.8]) };
        let options = Options::default();
        let end = run(method, &ball, start, 150.0, &options, &mut ()).unwrap();
        let table = amplitude * end.state[2].sin();
        assert!(end.state[0] >= table - 1e-12, "{amplitude} {floor:?}: {end:?}");
        match end.outcome {
            Outcome::Zeno { .. } => rests += 1,
            Outcome::ReachedEnd => {}
            other => panic!("{amplitude} {floor:?}: {other:?}"),
        }
    }
    rests
}

#[test]
fn a_ball_comes_to_rest_on_a_shaking_table_and_does_not_fall_through() {
    for floor in [Direction::Falling, Direction::Below] {
        assert!(rests(Dop853, floor) > 10);
        assert!(rests(Dopri5, floor) > 10);
    }
}
