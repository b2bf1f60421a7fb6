//! The defined answers of the documentation that have no module of their own.

use stickslip_solver::{
    Direction, Dop853, Guard, Options, Outcome, Pair, Recorder, Samples, run, run_with,
};

use super::{Log, close, fixed, line, reaches_end, start_of_line};

/// The places where a guard of this shape fires in any direction, by a step or by many.
fn fires(guard: impl Fn(Direction) -> Guard, shape: fn(f64) -> f64) -> [Vec<f64>; 4] {
    use Direction::{Below, Either, Falling, Rising};
    [Below, Falling, Rising, Either].map(|direction| {
        let places = [fixed(1.0), fixed(0.125), Options::default()].map(|options| {
            let options = Options { max_at_one_instant: 2, ..options };
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
    for pair in Pair::ALL {
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
        (Guard::new(Direction::Falling).yielding(), 1, 0b01),
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
        for pair in Pair::ALL {
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
