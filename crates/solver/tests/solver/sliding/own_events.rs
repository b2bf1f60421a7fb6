//! Clocks and rest of a system that slides.

use stickslip_solver::dynamic::DynamicStart;
use stickslip_solver::sliding::{
    Filippov, SampledFilippov, SurfaceSide, Switched, SwitchedDynamic,
};
use stickslip_solver::{Direction, Dop853, Guard, Number, Options, Schedule, Start, State, Times};

use crate::erased::{run, run_dynamic};

/// A mass on a belt that turns at given times, with friction 0.8.
struct Turning(Times);

/// The velocity of the belt.
type Speed = f64;

impl Switched<2, 1, 3> for Turning {
    type Mode = Speed;

    fn field<T: Number>(&self, _: Speed, signs: &[T; 1], _: T, y: &[T; 2]) -> [T; 2] {
        [y[1], signs[0] * -0.8]
    }
    fn surfaces<T: Number>(&self, speed: Speed, _: T, y: &[T; 2]) -> [T; 1] {
        [y[1] - speed]
    }
    fn guards(&self, _: Speed) -> [Guard; 3] {
        [Guard::OFF, Guard::OFF, Guard::clock()]
    }
    fn next(&self, speed: Speed, _: usize, _: f64, _: &State<2>) -> Speed {
        -speed
    }
    fn schedule(&self, _: Speed, _: usize) -> Schedule<'_> {
        Schedule::at(&self.0)
    }
}

impl SwitchedDynamic for Turning {
    type Mode = Speed;

    fn count(&self) -> usize {
        1
    }
    fn field(&self, _: Speed, signs: &[f64], _: f64, y: &[f64], slope: &mut [f64]) {
        slope.copy_from_slice(&[y[1], -0.8 * signs[0]]);
    }
    fn surfaces(&self, speed: Speed, _: f64, y: &[f64], values: &mut [f64]) {
        values[0] = y[1] - speed;
    }
    fn guards(&self, _: Speed) -> &[Guard] {
        const { &[Guard::clock()] }
    }
    fn transition(&self, speed: Speed, _: usize, _: f64, _: &mut [f64]) -> Speed {
        -speed
    }
    fn schedule(&self, _: Speed, _: usize) -> Schedule<'_> {
        Schedule::at(&self.0)
    }
}

/// Friction turns the velocity from 0.5 to −0.5 within 1.25.
#[test]
fn a_belt_turns_at_times() {
    let times = || Times::new(vec![2.0, 4.0]).unwrap();
    let expected = [(2.0, 2), (3.25, 0), (4.0, 2), (5.25, 0)];
    let options = Options::default();

    let belt = Filippov(Turning(times()));
    let state = State::from([0.0, 0.5]);
    let start = Start { mode: belt.mode(0.5, 0.0, &state).unwrap(), s: 0.0, state };
    let mut switches = Vec::new();
    let end = run(Dop853, &belt, start, 6.0, &options, &mut switches).unwrap().finished().unwrap();
    let seen: Vec<_> = switches.iter().map(|event| (event.s, event.guard)).collect();
    assert_eq!(seen.len(), expected.len(), "{seen:?}");
    for (seen, expected) in seen.iter().zip(expected) {
        assert!((seen.0 - expected.0).abs() < 1e-13 && seen.1 == expected.1, "{seen:?}");
    }
    assert_eq!((end.mode.own, end.mode.sides()), (0.5, &[SurfaceSide::Sliding][..]));
    // After 2 it has gone 1, and then 0.15625 on and back, and 0.75 back.
    assert!((end.state[0] - 1.0).abs() < 1e-12, "{}", end.state);

    let belt = SampledFilippov::new(Turning(times()));
    let mode = belt.mode(0.5, 0.0, &[0.0, 0.5]).unwrap();
    let start = DynamicStart { mode, s: 0.0, state: &[0.0, 0.5] };
    let mut sampled = Vec::new();
    let run = run_dynamic(Dop853, &belt, start, 6.0, &options, &mut sampled);
    let sampled_end = run.unwrap().finished().unwrap();
    assert_eq!(sampled.len(), switches.len());
    for (sampled, read) in sampled.iter().zip(&switches) {
        assert!((sampled.s - read.s).abs() < 1e-13 && sampled.guard == read.guard);
    }
    assert!((sampled_end.state[0] - end.state[0]).abs() < 1e-12);
}

/// A ball that keeps half its velocity comes to rest at 3, and then slides to rest with friction
/// 0.3.
struct Landing;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Ball {
    Flies,
    Lies,
}

impl Switched<3, 1, 3> for Landing {
    type Mode = Ball;

    fn field<T: Number>(&self, mode: Ball, signs: &[T; 1], _: T, y: &[T; 3]) -> [T; 3] {
        let nothing = T::from(0.0);
        match mode {
            Ball::Flies => [y[1], T::from(-2.0), nothing],
            Ball::Lies => [nothing, nothing, signs[0] * -0.3],
        }
    }
    fn surfaces<T: Number>(&self, _: Ball, _: T, y: &[T; 3]) -> [T; 1] {
        [y[2]]
    }
    fn guards(&self, mode: Ball) -> [Guard; 3] {
        let floor = if mode == Ball::Flies { Guard::new(Direction::Below) } else { Guard::OFF };
        [Guard::OFF, Guard::OFF, floor]
    }
    fn guard_values<T: Number>(&self, _: Ball, _: T, y: &[T; 3]) -> [T; 3] {
        [T::from(1.0), T::from(1.0), y[0]]
    }
    fn reset<T: Number>(&self, _: Ball, _: usize, _: T, y: &[T; 3]) -> [T; 3] {
        [T::from(0.0), y[1] * -0.5, y[2]]
    }
    fn rest(&self, _: Ball, _: usize, _: f64, y: &State<3>) -> Option<(Ball, State<3>)> {
        Some((Ball::Lies, State::from([0.0, 0.0, y[2]])))
    }
}

#[test]
fn a_ball_that_has_landed_slides_to_rest() {
    let ball = Filippov(Landing);
    let state = State::from([1.0, 0.0, 0.6]);
    let start = Start { mode: ball.mode(Ball::Flies, 0.0, &state).unwrap(), s: 0.0, state };
    let mut switches = Vec::new();
    let options = Options::default();
    let end = run(Dop853, &ball, start, 6.0, &options, &mut switches).unwrap().finished().unwrap();
    let stops = switches.last().expect("it stops");
    assert!((stops.s - 5.0).abs() < 1e-9 && stops.guard == 0, "{stops:?}");
    assert_eq!((end.mode.own, end.mode.sides()), (Ball::Lies, &[SurfaceSide::Sliding][..]));
    assert!(end.state[2].abs() < 1e-12);
}
