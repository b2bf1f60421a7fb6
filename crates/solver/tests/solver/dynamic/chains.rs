//! Several guards that fire at one instant.

use std::f64::consts::{PI, TAU};

use stickslip_solver::dynamic::DynamicStart;
use stickslip_solver::{
    Direction, Dop853, Guard, HybridSystem, Options, Start, State, SwitchEvent,
};

use super::{Of, places};
use crate::erased::{run, run_dynamic};

/// A guard sin(ωs + φ). Whenever it fires, a bound is violated until that fires too, at the same
/// instant. Then the first guard stands on its own zero, which rounding may move to either side.
struct Answered {
    direction: Direction,
    frequency: f64,
    phase: f64,
}

impl HybridSystem<1, 2> for Answered {
    type Mode = bool;

    fn field(&self, _violated: bool, _: f64, _: &State<1>) -> State<1> {
        State::from([self.frequency])
    }
    fn guards(&self, violated: bool) -> [Guard; 2] {
        let bound = if violated { Guard::new(Direction::Below) } else { Guard::OFF };
        [Guard::new(self.direction), bound]
    }
    fn guard_values(&self, _violated: bool, _: f64, y: &State<1>) -> [f64; 2] {
        [(y[0] + self.phase).sin(), -0.3]
    }
    fn transition(&self, _: bool, guard: usize, _: f64, y: &State<1>) -> (bool, State<1>) {
        (guard == 0, *y)
    }
}

impl Answered {
    /// The zeros at which the first guard fires, up to `end`.
    fn zeros(&self, end: f64) -> Vec<f64> {
        let zeros = (0..).map(|k| (f64::from(k) * PI - self.phase) / self.frequency);
        let fires = |(k, _): &(usize, f64)| match self.direction {
            Direction::Rising => k % 2 == 0,
            Direction::Falling => k % 2 == 1,
            _ => true,
        };
        let zeros = zeros.take_while(|&zero| zero < end).enumerate().filter(fires);
        zeros.map(|(_, zero)| zero).filter(|&zero| zero > 0.0).collect()
    }
}

#[test]
fn a_guard_does_not_fire_again_when_another_one_answers_it() {
    let mut random = fastrand::Rng::with_seed(3);
    for direction in [Direction::Rising, Direction::Falling, Direction::Either] {
        for _ in 0..200 {
            let (frequency, phase) = (0.5 + 2.0 * random.f64(), 0.1 + (TAU - 0.2) * random.f64());
            let system = Answered { direction, frequency, phase };
            let end = 10.0;
            let zeros = system.zeros(end);
            let options = Options::with_tolerance(1e-12);
            let start = Start { mode: false, s: 0.0, state: State::from([0.0]) };
            let (mut fixed, mut free) = (Vec::<SwitchEvent<bool, 1>>::new(), Vec::new());
            let _run = run(Dop853, &system, start, end, &options, &mut fixed).expect("a run");
            let of = Of::new(&system, &[false, true]);
            let start = DynamicStart { mode: false, s: 0.0, state: &[0.0] };
            let _run = run_dynamic(Dop853, &of, start, end, &options, &mut free).expect("a run");
            let fixed = fixed.iter().map(|event| (event.s, event.guard)).collect();
            for found in [fixed, places::<bool>(&free)] {
                let guards: Vec<usize> = found.iter().map(|(_, guard)| *guard).collect();
                assert_eq!(guards, [0, 1].repeat(zeros.len()), "{direction:?} {frequency} {phase}");
                for ((s, _), zero) in found.iter().step_by(2).zip(&zeros) {
                    assert!((s - zero).abs() < 1e-11, "{s} {zero}");
                }
            }
        }
    }
}
