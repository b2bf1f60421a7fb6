//! Runs in fixed steps that step over their switches.

use stickslip_solver::runs::run_over_switches;
use stickslip_solver::{
    Direction, Dop853, Dopri5, Guard, HybridSystem, Options, Outcome, Recorder, RunError, Start,
    State, StepSize,
};

use crate::erased::run;

/// y' = 1 with one guard, which is a function of s and changes nothing.
struct Planted(Direction, fn(f64) -> f64);

impl HybridSystem<1, 1> for Planted {
    type Mode = ();

    fn field(&self, (): (), _s: f64, _y: &State<1>) -> State<1> {
        State::from([1.0])
    }

    fn guards(&self, (): ()) -> [Guard; 1] {
        [Guard::new(self.0)]
    }

    fn guard_values(&self, (): (), s: f64, _y: &State<1>) -> [f64; 1] {
        [self.1(s)]
    }

    fn transition(&self, (): (), _: usize, _s: f64, y: &State<1>) -> ((), State<1>) {
        ((), *y)
    }
}

fn start() -> Start<(), 1> {
    Start { mode: (), s: 0.0, state: State::zeros() }
}

/// The places where a run from 0 to 1 in steps of 1/8 switches.
fn switches(direction: Direction, guard: fn(f64) -> f64) -> Vec<f64> {
    let mut recorder = Recorder::default();
    let system = Planted(direction, guard);
    let end = run_over_switches(Dopri5, &system, start(), 1.0, 0.125, 100, &mut recorder);
    let end = end.unwrap();
    assert_eq!((end.outcome, end.s), (Outcome::ReachedEnd, 1.0));
    assert!((end.state[0] - 1.0).abs() < 1e-15);
    assert_eq!(end.statistics.switches, recorder.switches.len());
    recorder.switches.iter().map(|event| event.s).collect()
}

#[test]
fn switches_are_at_the_ends_of_steps_and_pairs_within_one_are_missed() {
    assert_eq!(switches(Direction::Falling, |s| 0.3 - s), [0.375]);
    let pair: fn(f64) -> f64 = |s| (s - 0.4) * (s - 0.45);
    assert_eq!(switches(Direction::Either, pair), [0.0; 0]);
    let mut recorder = Recorder::default();
    let options = Options { step_size: StepSize::Fixed(0.125), ..Options::default() };
    let located =
        run(Dopri5, &Planted(Direction::Either, pair), start(), 1.0, &options, &mut recorder);
    assert_eq!(located.unwrap().outcome, Outcome::ReachedEnd);
    assert_eq!(recorder.switches.len(), 2);
}

#[test]
fn every_direction_fires_when_it_should() {
    let wave = |s: f64| (2.0 * std::f64::consts::PI * s + 0.1).sin();
    assert_eq!(switches(Direction::Falling, wave), [0.5]);
    assert_eq!(switches(Direction::Rising, wave), [1.0]);
    assert_eq!(switches(Direction::Either, wave), [0.5, 1.0]);
    assert_eq!(switches(Direction::Below, wave), [0.5, 0.625, 0.75, 0.875]);
    assert_eq!(switches(Direction::Off, |_| f64::NAN), [0.0; 0]);
}

#[test]
fn work_is_counted_and_errors_are_reported() {
    let system = Planted(Direction::Falling, |s| 0.3 - s);
    let go = |h, steps, end| {
        run_over_switches(Dop853, &system, start(), end, h, steps, &mut ()).map(|run| {
            (run.outcome, run.statistics.accepted, run.statistics.field, run.statistics.guards)
        })
    };
    // Each step takes twelve right-hand sides, and the start takes one.
    assert_eq!(go(0.125, 100, 1.0), Ok((Outcome::ReachedEnd, 8, 8 * 12, 8 + 2)));
    assert_eq!(go(0.125, 3, 1.0), Ok((Outcome::StepLimit, 3, 3 * 12 + 1, 3 + 2)));
    assert!(matches!(go(0.0, 9, 1.0), Err(RunError::Option(_))));
    assert!(matches!(go(0.1, 9, -1.0), Err(RunError::Span { .. })));
    let nan = Planted(Direction::Below, |s| if s > 0.2 { f64::NAN } else { 1.0 });
    let failed = run_over_switches(Dop853, &nan, start(), 1.0, 0.125, 9, &mut ());
    assert_eq!(failed.unwrap_err(), RunError::GuardNotANumber { guard: 0, s: 0.125 });
}
