//! Output at given times.

use stickslip_solver::runs::run_over_switches;
use stickslip_solver::{
    Closures, Direction, Dop853, Dopri5, Guard, InvalidValue, Options, Outcome, Recorder, Samples,
    State,
};

use super::{Log, at, ball, line, reaches_end, start_of_line};
use crate::erased::{run, run_backwards};

#[test]
fn samples_are_those_of_the_trajectory() {
    let times: Vec<f64> = (0..=3000).map(|i| f64::from(i) * 1e-3).collect();
    let mut both = (Samples::new(times.clone()).unwrap(), Recorder::default());
    let end = run(Dopri5, &ball(), at(0.0, [1.0, 0.0]), 3.0, &Options::default(), &mut both);
    let end = end.unwrap();
    let (samples, recorder) = both;
    assert_eq!(samples.samples.len(), times.len());
    assert_eq!(samples.switches, recorder.switches);
    assert!(samples.missing().is_empty());
    for (sample, s) in samples.samples.iter().zip(times) {
        assert_eq!(sample.s, s);
        if s < 3.0 {
            assert_eq!(Some((sample.mode, sample.state)), recorder.trajectory.at(s), "{s}");
        } else {
            assert_eq!(sample.state, end.state);
        }
    }
}

#[test]
fn samples_at_switches_and_ends_are_exact() {
    // The run is repeated with the places that it reports as times.
    let system = Closures::new(|_s, y: &State<2>| State::from([y[1], -9.81]))
        .guards([Guard::new(Direction::Below).terminal_after(3)], |_s, y| [y[0]])
        .transition(|_guard, _s, y| State::from([0.0, -0.9 * y[1]]));
    let start = at(0.1, [1.0, 0.0]);
    let options = Options::default();
    let mut bounces = Vec::new();
    let end = run(Dop853, &system, start, 9.0, &options, &mut bounces).unwrap();
    assert_eq!(end.outcome, Outcome::EndedByGuard { guard: 0 });
    assert_eq!(bounces.len(), 3);
    let times = [0.0, 0.1, bounces[0].s, bounces[1].s, end.s, end.s, end.s.next_up()];
    let mut samples = Samples::at(&times).unwrap();
    assert_eq!(run(Dop853, &system, start, 9.0, &options, &mut samples).unwrap().s, end.s);
    let states: Vec<_> = samples.samples.iter().map(|sample| sample.state).collect();
    assert_eq!(states, [start.state, bounces[0].after, bounces[1].after, end.state, end.state]);
    assert_eq!(samples.missing(), [0.0, end.s.next_up()]);
    assert_eq!(samples.switches, bounces);
    // Just before a switch, the state has not jumped.
    let mut samples = Samples::at(&[bounces[0].s.next_down()]).unwrap();
    assert_eq!(run(Dop853, &system, start, 9.0, &options, &mut samples).unwrap().s, end.s);
    assert!((samples.samples[0].state - bounces[0].before).norm() < 1e-12);
}

#[test]
fn samples_are_in_the_order_of_the_run() {
    let system = line([], |_| []);
    for times in [[-1.0, 0.0, 0.25, 0.25, 1.0, 2.0], [2.0, 1.0, 0.25, 0.25, 0.0, -1.0]] {
        let mut samples = Samples::at(&times).unwrap();
        reaches_end(run(Dop853, &system, start_of_line(), 1.0, &Options::default(), &mut samples));
        let places: Vec<_> = samples.samples.iter().map(|sample| sample.s).collect();
        assert_eq!(places, [0.0, 0.25, 0.25, 1.0]);
        assert_eq!(samples.missing(), [-1.0, 2.0]);
        let mut samples = Samples::at(&times).unwrap();
        let start = at(1.0, [1.0]);
        reaches_end(run_backwards(Dop853, &system, start, 0.0, &Options::default(), &mut samples));
        let places: Vec<_> = samples.samples.iter().map(|sample| sample.s).collect();
        assert_eq!(places, [1.0, 0.25, 0.25, 0.0]);
        assert_eq!(samples.missing(), [2.0, -1.0]);
        for sample in samples.samples {
            assert!((sample.state[0] - sample.s).abs() < 1e-15);
        }
    }
}

#[test]
fn times_out_of_order_are_named() {
    let offends = |times: &[f64]| {
        let error = Samples::<(), 1>::at(times).err()?;
        (0..times.len()).find(|index| error.name == format!("times[{index}]"))
    };
    assert_eq!(offends(&[]), None);
    assert_eq!(offends(&[1.0, 1.0, 1.0]), None);
    assert_eq!(offends(&[f64::NEG_INFINITY, 1.0, f64::INFINITY]), None);
    assert_eq!(offends(&[0.0, 1.0, 0.5]), Some(2));
    assert_eq!(offends(&[1.0, 1.0, 0.0, 0.5]), Some(3));
    assert_eq!(offends(&[0.0, f64::NAN, 1.0]), Some(1));
    assert_eq!(offends(&[f64::NAN, f64::NAN]), Some(0));
    let error = Samples::<(), 1>::at(&[0.0, 1.0, 0.5]).unwrap_err();
    let expected = "numbers in ascending or in descending order";
    assert_eq!(error, InvalidValue::new("times[2]", 0.5, expected));
}

#[test]
fn a_run_without_a_step_has_the_sample_of_its_start() {
    // The guard is negative at once and ends the run.
    let system = line([Guard::new(Direction::Below).terminal()], |_| [-1.0]);
    let mut samples = Samples::at(&[0.0, 0.5]).unwrap();
    let end = run(Dop853, &system, start_of_line(), 1.0, &Options::default(), &mut samples);
    assert_eq!(end.unwrap().s, 0.0);
    assert_eq!(samples.samples.len(), 1);
    assert_eq!(samples.samples[0].state, State::from([0.0]));
    assert_eq!(samples.missing(), [0.5]);
}

#[test]
fn the_end_is_told_once_and_not_if_the_run_fails() {
    let system = line([Guard::new(Direction::Falling)], |s| [0.5 - s]);
    let mut log = (Log::default(), Log::default());
    let options = Options::default();
    reaches_end(run(Dop853, &system, start_of_line(), 1.0, &options, &mut log));
    assert_eq!(log.0.ends, log.1.ends);
    assert_eq!(log.0.ends.len(), 1);
    let mut log = Log::default();
    reaches_end(run_over_switches(
        Dop853,
        &line([], |_| []),
        start_of_line(),
        1.0,
        0.3,
        9,
        &mut log,
    ));
    assert_eq!(log.ends, [1.0]);
    let mut log = Log::default();
    let nan = line([Guard::new(Direction::Below)], |s| [if s > 0.5 { f64::NAN } else { 1.0 }]);
    assert!(run(Dop853, &nan, start_of_line(), 1.0, &options, &mut log).is_err());
    assert!(log.ends.is_empty());
}
