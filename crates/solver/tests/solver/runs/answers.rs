//! The defined answers of the documentation that have no module of their own.

use stickslip_solver::{
    Closures, Direction, Dop853, EmbeddedPair, Guard, Options, Outcome, Recorder, Samples, State,
    SwitchEvent,
};

use super::{Log, at, close, fixed, line, reaches_end, start_of_line, thrown};
use crate::erased::{run, run_with};

/// The places where a guard of this shape fires in any direction, by a step or by many.
fn fires(guard: impl Fn(Direction) -> Guard, shape: fn(f64) -> f64) -> [Vec<f64>; 4] {
    use Direction::{Below, Either, Falling, Rising};
    [Below, Falling, Rising, Either].map(|direction| {
        let places = [fixed(1.0), fixed(0.125), Options::default()].map(|options| {
            let options = Options { max_switches: 2, ..options };
            let mut log = Log::default();
            let system = line([guard(direction)], shape_of(shape));
            assert!(run(Dop853, &system, start_of_line(), 1.0, &options, &mut log).is_ok());
            log.places()
        });
        assert!(places[0] == places[1] && places[1] == places[2], "{places:?}");
        places[0].clone()
    })
}

fn shape_of(shape: fn(f64) -> f64) -> impl Fn(f64) -> [f64; 1] {
    move |s| [shape(s)]
}

#[test]
fn a_guard_that_starts_on_zero_fires_if_it_leaves_in_its_direction() {
    let (never, once): (Vec<f64>, _) = (vec![], vec![0.0]);
    // A bound of the domain goes on being negative, so it goes on firing.
    let twice = vec![0.0; 2];
    let none = || never.clone();
    let one = || once.clone();
    assert_eq!(fires(Guard::new, |s| s), [none(), none(), one(), one()]);
    assert_eq!(fires(Guard::new, |s| -s), [twice.clone(), one(), none(), one()]);
    let known = |direction| Guard::new(direction).from_zero(1);
    assert_eq!(fires(known, |s| s), [none(), none(), none(), none()]);
    assert_eq!(fires(known, |s| -s), [twice, none(), none(), none()]);
}

#[test]
fn a_touch_is_reported_and_does_not_fire() {
    let touch: fn(f64) -> f64 = |s| (s - 0.4) * (s - 0.4);
    assert!(fires(Guard::new, touch).iter().all(Vec::is_empty));
    for pair in EmbeddedPair::ALL {
        let mut log = Log::default();
        let system = line([Guard::new(Direction::Below)], shape_of(touch));
        reaches_end(run_with(pair, &system, start_of_line(), 1.0, &fixed(1.0), &mut log));
        close(&log.grazings, &[0.4], 1e-7);
    }
}

#[test]
fn the_first_guard_of_the_list_decides_unless_it_yields() {
    let guards = |first: Guard| [first.terminal(), Guard::new(Direction::Falling).terminal()];
    for (first, fires, other) in [
        (Guard::new(Direction::Falling), 0, 0b10),
        (Guard::new(Direction::Falling).priority(-1), 1, 0b01),
    ] {
        let system = line(guards(first), |s| [0.43 - s, 2.0 * (0.43 - s)]);
        let mut log = Log::default();
        let end = run(Dop853, &system, start_of_line(), 1.0, &Options::default(), &mut log);
        assert_eq!(end.unwrap().outcome, Outcome::EndedByGuard { guard: fires });
        assert_eq!((log.switches.len(), log.switches[0].simultaneous), (1, other));
    }
    // Guards that change nothing all fire, in one event.
    let system = line([Guard::new(Direction::Falling); 2], |s| [0.43 - s, 2.0 * (0.43 - s)]);
    let mut log = Log::default();
    reaches_end(run(Dop853, &system, start_of_line(), 1.0, &Options::default(), &mut log));
    assert_eq!((log.switches.len(), log.switches[0].simultaneous), (1, 0b10));
}

#[test]
fn a_guard_that_crosses_at_the_end_of_the_span_fires() {
    for end in [1.0, 0.7, 3.3] {
        for options in [Options::default(), fixed(0.1), fixed(5.0)] {
            let values = move |s: f64| [end - s];
            let mut log = Log::default();
            let system = line([Guard::new(Direction::Falling)], values);
            reaches_end(run(Dop853, &system, start_of_line(), end, &options, &mut log));
            close(&log.places(), &[end], 1e-14);
            let system = line([Guard::new(Direction::Falling).terminal()], values);
            let ran = run(Dop853, &system, start_of_line(), end, &options, &mut ()).unwrap();
            assert_eq!(ran.outcome, Outcome::EndedByGuard { guard: 0 });
        }
    }
}

#[test]
fn the_state_comes_up_to_the_place_where_a_note_ends_the_run() {
    // The step goes beyond the switch, where the run ends.
    let system = line([Guard::new(Direction::Either)], |s| [s - 0.7]);
    let limit = Options { max_switches: 1, ..fixed(1.0) };
    for (options, stop_after) in [(limit, 0), (fixed(1.0), 1)] {
        for pair in EmbeddedPair::ALL {
            let observed = (Samples::at(&[0.25, 0.5, 0.75]).unwrap(), Recorder::default());
            let mut observed = (observed, Log { stop_after, ..Log::default() });
            let end = run_with(pair, &system, start_of_line(), 1.0, &options, &mut observed);
            let end = end.unwrap();
            assert!((end.s - 0.7).abs() < 1e-14, "{end:?}");
            let (samples, recorder) = observed.0;
            assert_eq!(samples.missing(), [0.75]);
            close(
                &samples.samples.iter().map(|at| at.state[0]).collect::<Vec<_>>(),
                &[0.25, 0.5],
                1e-15,
            );
            assert!(recorder.trajectory.at(end.s).is_some());
            assert_eq!(recorder.trajectory.at(0.75), None);
        }
    }
}

#[test]
fn crossings_of_a_guard_at_the_same_place_all_count() {
    // The second guard crosses together with the first one, and once more a hair behind.
    let values = |s: f64| [s - 0.43, (s - 0.43) * (s - 0.43 - 1e-13)];
    for pair in EmbeddedPair::ALL {
        let mut log = Log::default();
        let system = line([Guard::new(Direction::Either); 2], values);
        reaches_end(run_with(pair, &system, start_of_line(), 1.0, &fixed(1.0), &mut log));
        let times = |guard: usize| {
            let named = |e: &&_| fired(e, guard);
            log.switches.iter().filter(named).count()
        };
        // Rounding may leave the pair a touch, but not one of the two.
        assert_eq!((times(0), times(1) % 2), (1, 0), "{:?}", log.switches);
        assert!(log.switches.windows(2).all(|pair| pair[0].s <= pair[1].s));
    }
}

fn fired<const N: usize>(event: &SwitchEvent<(), N>, guard: usize) -> bool {
    event.guard == guard || event.simultaneous >> guard & 1 == 1
}

#[test]
fn the_list_decides_at_the_start_and_at_the_end_too() {
    // At the start: the first guard falls from zero, and the second one is negative.
    let guards = [Guard::new(Direction::Falling), Guard::new(Direction::Below)];
    let system = line(guards.map(Guard::terminal), |s| [-s - s * s, -1.0 - s]);
    let mut log = Log::default();
    let end = run(Dop853, &system, start_of_line(), 1.0, &fixed(0.25), &mut log).unwrap();
    assert_eq!((end.outcome, end.s), (Outcome::EndedByGuard { guard: 0 }, 0.0));
    assert!(fired(&log.switches[0], 1));
    // At the end of the span: the first guard yields.
    for (first, decides, other) in [
        (Guard::new(Direction::Falling), 0, 0b10),
        (Guard::new(Direction::Falling).priority(-1), 1, 0b01),
    ] {
        let guards = [first, Guard::new(Direction::Falling)].map(Guard::terminal);
        let system = line(guards, |s| [1e-170 * (1.0 - s), 2.0 * (1.0 - s)]);
        for options in [fixed(1.0), fixed(0.1), Options::default()] {
            let mut log = Log::default();
            let end = run(Dop853, &system, start_of_line(), 1.0, &options, &mut log).unwrap();
            assert_eq!(end.outcome, Outcome::EndedByGuard { guard: decides });
            assert_eq!((log.switches.len(), log.switches[0].simultaneous), (1, other));
        }
    }
}

#[test]
fn what_others_are_named_does_not_depend_on_the_observer() {
    // A steep guard fires where another one touches.
    let values = |s: f64| [(1e3 * (s - 0.37)).tanh(), (s - 0.37) * (s - 0.37)];
    let guards = [Guard::new(Direction::Rising).terminal(), Guard::new(Direction::Falling)];
    let named = |switches: &[SwitchEvent<(), 1>]| switches[0].simultaneous;
    let (system, mut log, mut recorder) =
        (line(guards, values), Log::default(), Recorder::default());
    for options in [fixed(1.0), Options::default()] {
        let ran = run(Dop853, &system, start_of_line(), 1.0, &options, &mut log);
        assert!(ran.unwrap().finished().is_ok());
        let ran = run(Dop853, &system, start_of_line(), 1.0, &options, &mut recorder);
        assert!(ran.unwrap().finished().is_ok());
        assert_eq!(named(&log.switches), named(&recorder.switches));
    }
}

#[test]
fn touches_are_told_once_in_order_and_not_behind_the_end() {
    let touches = |s: f64| 1.0 - (40.0 * s).cos();
    let expected: Vec<f64> = (1..=6).map(|k| std::f64::consts::TAU / 40.0 * f64::from(k)).collect();
    for pair in EmbeddedPair::ALL {
        for options in [fixed(1.0), fixed(0.3), Options::default()] {
            // All of them, with more than a step may be expected to have.
            for direction in [Direction::Either, Direction::Falling, Direction::Below] {
                let system = line([Guard::new(direction)], move |s| [touches(s + 0.01)]);
                let mut log = Log::default();
                reaches_end(run_with(pair, &system, start_of_line(), 1.0, &options, &mut log));
                let expected: Vec<f64> = expected.iter().map(|s| s - 0.01).collect();
                close(&log.grazings, &expected, 1e-6);
            }
            // Not those behind the switch that ends the run.
            let guards = [Guard::new(Direction::Falling).terminal(), Guard::new(Direction::Either)];
            let system = line(guards, move |s| [0.4 - s, touches(s + 0.01)]);
            let mut log = Log::default();
            let end = run_with(pair, &system, start_of_line(), 1.0, &options, &mut log).unwrap();
            assert_eq!((end.outcome, log.switches.len()), (Outcome::EndedByGuard { guard: 0 }, 1));
            close(&log.grazings, &[expected[0] - 0.01, expected[1] - 0.01], 1e-6);
            assert_eq!(end.statistics.grazings, 2);
        }
    }
    let many = line([Guard::new(Direction::Either)], |s| [1.0 - (100.0 * (s + 0.001)).cos()]);
    let mut log = Log::default();
    reaches_end(run(Dop853, &many, start_of_line(), 1.0, &fixed(1.0), &mut log));
    assert_eq!(log.grazings.len(), 15);
}

#[test]
fn a_recorded_run_ends_behind_its_last_switch() {
    let ball = thrown();
    let start = at(0.0, [0.0, 9.81]);
    let options = Options { max_switches: 1, ..Options::default() };
    let mut recorder = Recorder::default();
    let end = run(Dop853, &ball, start, 10.0, &options, &mut recorder).unwrap();
    assert_eq!(end.outcome, Outcome::SwitchLimit);
    let ((), last) = recorder.trajectory.at(end.s).unwrap();
    assert!(last == end.state && last[1] > 0.0, "{last:?}");
}

#[test]
fn tiny_tolerances_have_a_first_step() {
    let circle = Closures::new(|_s, y: &State<2>| State::from([y[1], -y[0]]));
    for pair in EmbeddedPair::ALL {
        for atol in [1e-300, f64::MIN_POSITIVE] {
            let options = Options { rtol: 1e-8, atol, max_steps: 5000, ..Options::default() };
            let end = run_with(pair, &circle, at(0.0, [1.0, 0.0]), 3.0, &options, &mut ()).unwrap();
            assert_eq!(end.outcome, Outcome::ReachedEnd);
            assert!((end.state[0] - 3.0_f64.cos()).abs() < 1e-6);
        }
    }
}
