//! A guard that fires, changes the mode, and goes on from where it fired.

use stickslip_solver::{Direction, Dop853, Guard, HybridSystem, Options, Start, State};

use crate::erased::run;

/// The guard sin(ωs + φ), whose rounding is that of its angle. Each zero changes the mode.
#[derive(Clone, Copy)]
struct Wave {
    frequency: f64,
    phase: f64,
    direction: Direction,
}

impl Wave {
    fn value(&self, s: f64) -> f64 {
        (self.frequency * s + self.phase).sin()
    }
}

impl HybridSystem<1, 1> for Wave {
    type Mode = u32;

    fn field(&self, _: u32, _: f64, _: &State<1>) -> State<1> {
        State::from([1.0])
    }
    fn guards(&self, _: u32) -> [Guard; 1] {
        [Guard::new(self.direction)]
    }
    fn guard_values(&self, _: u32, s: f64, _: &State<1>) -> [f64; 1] {
        [self.value(s)]
    }
    fn transition(&self, mode: u32, _: usize, _: f64, y: &State<1>) -> (u32, State<1>) {
        (mode + 1, *y)
    }
}

/// No zero fires twice, however far its place is off by rounding.
#[test]
fn each_zero_fires_once() {
    let mut random = fastrand::Rng::with_seed(7);
    let options = Options { max_step: 0.2, ..Options::with_tolerance(1e-13) };
    for direction in [Direction::Rising, Direction::Falling, Direction::Either] {
        for _ in 0..2000 {
            let wave = Wave {
                frequency: 1.0 + 4.0 * random.f64(),
                phase: 1.0 + 1e3_f64.powf(random.f64()),
                direction,
            };
            let start = Start { mode: 0, s: 0.0, state: State::from([0.0]) };
            let found = run(Dop853, &wave, start, 3.0, &options, &mut ()).expect("a run");
            // Half turns up to the start and up to the end.
            let turns = |s: f64| ((wave.frequency * s + wave.phase) / std::f64::consts::PI).floor();
            let [first, last] = [turns(0.0), turns(3.0)];
            let turns = std::iter::successors(Some(first + 1.0), |turn| Some(turn + 1.0));
            let zeros = turns.take_while(|turn| *turn <= last).filter(|turn| match direction {
                Direction::Rising => turn.rem_euclid(2.0) == 0.0,
                Direction::Falling => turn.rem_euclid(2.0) == 1.0,
                _ => true,
            });
            assert_eq!(
                found.mode as usize,
                zeros.count(),
                "{direction:?} {} {}",
                wave.frequency,
                wave.phase
            );
        }
    }
}

/// Three modes whose guards are negative where they begin: −5, −1, and time itself in the last one.
struct Stairs;

impl HybridSystem<1, 1> for Stairs {
    type Mode = u32;

    fn field(&self, _: u32, _: f64, _: &State<1>) -> State<1> {
        State::from([1.0])
    }
    fn guards(&self, _: u32) -> [Guard; 1] {
        [Guard::new(Direction::Below)]
    }
    fn guard_values(&self, mode: u32, s: f64, _: &State<1>) -> [f64; 1] {
        [match mode {
            0 => -5.0 + 20.0 * s,
            1 => -1.0 + 30.0 * s,
            _ => 1.0,
        }]
    }
    fn transition(&self, mode: u32, _: usize, _: f64, y: &State<1>) -> (u32, State<1>) {
        (mode + 1, *y)
    }
}

/// A guard that fires at once has not been located: how negative it is says nothing about rounding
/// of the guards behind it.
#[test]
fn guards_fire_at_once_one_after_the_other() {
    for tolerance in [1e-13, 1e-10, 1e-6, 1e-3] {
        let options = Options { first_step: Some(0.1), ..Options::with_tolerance(tolerance) };
        let start = Start { mode: 0, s: 0.0, state: State::from([0.0]) };
        let found = run(Dop853, &Stairs, start, 1.0, &options, &mut ()).expect("a run");
        assert_eq!(found.mode, 2, "{tolerance}");
    }
}
