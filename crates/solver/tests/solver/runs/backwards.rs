//! Runs backwards.

use stickslip_solver::{
    Closures, Direction, Dop853, Dopri5, EmbeddedPair, Guard, Options, Outcome, Recorder, Run,
    RunError, Start, State, SwitchEvent,
};

use super::{Log, Wave, at, ball, close, fixed, line, reaches_end, start_of_line, thrown};
use crate::erased::{run, run_backwards, run_with};

#[test]
fn a_run_backwards_is_the_run_of_the_mirrored_system() {
    let field = |s: f64, y: &State<2>| State::from([y[1], -y[0] + 0.3 * s]);
    let values = |s: f64, y: &State<2>| [y[0] - 0.1 * s, y[1] + 0.2];
    let next = |guard: usize, s: f64, y: &State<2>| {
        if guard == 0 { State::from([y[0], -0.8 * y[1] + 0.01 * s]) } else { *y }
    };
    let guards = [Guard::new(Direction::Falling), Guard::new(Direction::Either)];
    let system = Closures::new(field).guards(guards, values).transition(next);
    let mirrored = Closures::new(|tau, y| -field(-tau, y))
        .guards(guards, |tau, y| values(-tau, y))
        .transition(|guard, tau, y| next(guard, -tau, y));
    for pair in EmbeddedPair::ALL {
        let options = Options::default();
        let (mut expected, mut found) = (Recorder::default(), Recorder::default());
        let start = [0.3, 1.1];
        let forwards =
            run_with(pair, &mirrored, at(-7.0, start), 4.0, &options, &mut expected).unwrap();
        let run = match pair {
            EmbeddedPair::Dopri5 => {
                run_backwards(Dopri5, &system, at(7.0, start), -4.0, &options, &mut found)
            }
            EmbeddedPair::Dop853 => {
                run_backwards(Dop853, &system, at(7.0, start), -4.0, &options, &mut found)
            }
        };
        let run = run.unwrap();
        assert_eq!(run, Run { s: -4.0, ..forwards });
        assert!(found.switches.len() >= 3, "{:?}", found.switches);
        let turned = expected.switches.iter().map(|event| SwitchEvent { s: -event.s, ..*event });
        assert_eq!(found.switches, turned.collect::<Vec<_>>());
        // The dense output has the original s, and starts where s is largest.
        for i in 0..=110 {
            let s = 7.0 - 0.1 * f64::from(i);
            let (one, other) = (found.trajectory.at(s), expected.trajectory.at(-s));
            assert_eq!(one, other, "{s}");
            assert!(one.is_some());
        }
        assert_eq!((found.trajectory.at(7.1), found.trajectory.at(-4.1)), (None, None));
        // At a switch, the state after it in the direction of the run.
        let event = found.switches.iter().find(|event| event.guard == 0).unwrap();
        assert_eq!(found.trajectory.at(event.s), Some(((), event.after)));
    }
}

#[test]
fn there_and_back() {
    // A forced pendulum.
    let system = Closures::new(|s: f64, y: &State<2>| {
        State::from([y[1], -y[0].sin() + 0.1 * (2.0 * s).cos()])
    });
    let options = Options::with_tolerance(1e-12);
    let there = run(Dop853, &system, at(1.0, [1.0, 0.0]), 6.0, &options, &mut ()).unwrap();
    let start = Start { mode: (), s: there.s, state: there.state };
    let back = run_backwards(Dop853, &system, start, 1.0, &options, &mut ()).unwrap();
    assert_eq!(back.s, 1.0);
    assert!((back.state - State::from([1.0, 0.0])).norm() < 1e-10);
}

#[test]
fn directions_hold_in_the_direction_of_integration() {
    let fires = |direction| {
        let system = line([Guard::new(direction)], |s| [(s - 1.0) * (s - 2.0)]);
        let mut log = Log::default();
        let options = Options::default();
        reaches_end(run_backwards(Dop853, &system, at(3.0, [3.0]), 0.0, &options, &mut log));
        log.places()
    };
    // Going down, it falls at 2 and rises at 1.
    close(&fires(Direction::Falling), &[2.0], 1e-15);
    close(&fires(Direction::Rising), &[1.0], 1e-15);
    close(&fires(Direction::Either), &[2.0, 1.0], 1e-15);
}

#[test]
fn readable_guards_are_bounded_backwards_too() {
    let mut log = Log::default();
    let run = run_backwards(Dop853, &Wave, at(1.0, [1.0]), 0.0, &fixed(0.5), &mut log).unwrap();
    assert!(run.statistics.enclosures > 0);
    let mut places: Vec<f64> = (0..50)
        .flat_map(|k| [7.0, 11.0].map(|twelfths| (f64::from(k) + twelfths / 12.0) / 50.0))
        .collect();
    places.reverse();
    close(&log.places(), &places, 1e-12);
}

#[test]
fn touches_and_poles_have_the_original_place() {
    let near = |places: &[f64], place: f64| {
        assert!(
            !places.is_empty() && places.iter().all(|s| (s - place).abs() < 1e-6),
            "{places:?}"
        );
    };
    let touch = line([Guard::new(Direction::Falling)], |s| [(s - 0.3) * (s - 0.3)]);
    let pole = line([Guard::new(Direction::Either)], |s| [1.0 / (s - 0.61)]);
    let (mut touched, mut divided) = (Log::default(), Log::default());
    let start = at(1.0, [1.0]);
    reaches_end(run_backwards(Dop853, &touch, start, 0.0, &fixed(1.0), &mut touched));
    reaches_end(run_backwards(Dop853, &pole, start, 0.0, &fixed(1.0), &mut divided));
    near(&touched.grazings, 0.3);
    near(&divided.poles, 0.61);
    assert_eq!((touched.ends, divided.ends), (vec![0.0], vec![0.0]));
    assert!(touched.switches.is_empty() && divided.switches.is_empty());
}

#[test]
fn ends_and_errors_of_runs_backwards_have_the_original_place() {
    let options = Options::default();
    let ball = ball();
    let start = at(0.0, [0.0, 0.0]);
    for (from, to) in [(0.0, 0.0), (0.0, 1.0), (0.0, f64::NAN), (f64::INFINITY, 0.0)] {
        let error = run_backwards(Dop853, &ball, at(from, [0.0; 2]), to, &options, &mut ());
        let Err(RunError::Span { from: a, to: b }) = error else { panic!("{error:?}") };
        assert!(a == from && (b == to || to.is_nan()), "{a} {b}");
    }
    let bad = Options { rtol: 1.0, ..options };
    let error = run_backwards(Dop853, &ball, start, -1.0, &bad, &mut ());
    assert!(matches!(error, Err(RunError::Option(_))));
    // Gravity has the square of the time, so the ball bounces backwards as it does forwards.
    let mut bounces = Log::default();
    let start = at(5.0, [0.0, -0.981]);
    let run = run_backwards(Dop853, &thrown(), start, -100.0, &options, &mut bounces).unwrap();
    let Outcome::Zeno { accumulation } = run.outcome else { panic!("{run:?}") };
    assert!((accumulation - 3.0).abs() < 1e-11, "{accumulation}");
    close(&bounces.places()[..2], &[4.8, 4.8 - 0.18], 1e-12);
    assert_eq!(bounces.ends, [run.s]);
    // To −∞, up to a terminal guard.
    let terminal = line([Guard::new(Direction::Falling).terminal()], |s| [s + 40.0]);
    let run =
        run_backwards(Dop853, &terminal, start_of_line(), f64::NEG_INFINITY, &options, &mut ());
    let run = run.unwrap();
    assert_eq!(run.outcome, Outcome::EndedByGuard { guard: 0 });
    assert!((run.s + 40.0).abs() < 1e-12);
    // A right-hand side that is not finite below 2.
    let field = |s: f64, _y: &State<1>| State::from([if s < 2.0 { f64::NAN } else { 1.0 }]);
    let error =
        run_backwards(Dop853, &Closures::new(field), at(3.0, [0.0]), 0.0, &options, &mut ());
    let Err(RunError::Field { s, .. }) = error else { panic!("{error:?}") };
    assert!((s - 2.0).abs() < 1e-9);
}
