//! What surrounds a run: systems from closures, runs backwards, output at given times, pairs at run
//! time, tolerances of components, the ends of runs, and the defined answers in the documentation.

use std::f64::consts::PI;

use stickslip_solver::{
    Closures, Dense, Direction, Dop853, Dopri5, Grazing, Guard, HybridSystem, InvalidTimes, Method,
    Number, Observer, Options, Outcome, Pair, Pole, ReadableSystem, Recorder, Run, RunError,
    Samples, Start, State, StepSize, SwitchEvent, Unfinished, UnknownPair, Weighted, run,
    run_backwards, run_over_switches, run_with,
};

/// A start in the only mode.
fn at<const N: usize>(s: f64, state: [f64; N]) -> Start<(), N> {
    Start { mode: (), s, state: State::from(state) }
}

fn fixed(h: f64) -> Options {
    Options { step_size: StepSize::Fixed(h), ..Options::default() }
}

/// The switches and touches of a run, and its end.
#[derive(Debug, Default)]
struct Log<const N: usize> {
    switches: Vec<SwitchEvent<(), N>>,
    grazings: Vec<f64>,
    poles: Vec<f64>,
    ends: Vec<f64>,
    /// The run stops after so many switches, unless this is 0.
    stop_after: usize,
}

impl<const N: usize> Log<N> {
    fn places(&self) -> Vec<f64> {
        self.switches.iter().map(|event| event.s).collect()
    }
}

impl<const N: usize> Observer<(), N> for Log<N> {
    fn on_switch(&mut self, event: &SwitchEvent<(), N>) {
        self.switches.push(*event);
    }

    fn on_grazing(&mut self, grazing: &Grazing<()>) {
        self.grazings.push(grazing.s);
    }

    fn on_pole(&mut self, pole: &Pole<()>) {
        self.poles.push(pole.s);
    }

    fn stops(&self) -> bool {
        self.stop_after > 0 && self.switches.len() >= self.stop_after
    }

    fn on_end(&mut self, (): (), s: f64, _state: &State<N>) {
        self.ends.push(s);
    }
}

/// A ball that keeps nine tenths of its speed.
fn ball() -> impl HybridSystem<2, 1, Mode = ()> {
    Closures::new(|_s, y: &State<2>| State::from([y[1], -9.81]))
        .guards([Guard::new(Direction::Below)], |_s, y| [y[0]])
        .transition(|_guard, _s, y| State::from([0.0, -0.9 * y[1]]))
}

/// The same ball, if it starts from the ground.
fn thrown() -> impl HybridSystem<2, 1, Mode = ()> {
    Closures::new(|_s, y: &State<2>| State::from([y[1], -9.81]))
        .guards([Guard::new(Direction::Below).from_zero(1)], |_s, y| [y[0]])
        .transition(|_guard, _s, y| State::from([0.0, -0.9 * y[1]]))
}

/// The place where the ball that falls from 1 bounces, counted from 0.
fn bounce(n: i32) -> f64 {
    let flights = (1.0 - 0.9_f64.powi(n)) / 0.1 * 0.9;
    (2.0_f64 / 9.81).sqrt() * (1.0 + 2.0 * flights)
}

/// y' = 1, so that s and y are the same, with guards that change nothing.
fn line<const G: usize>(
    guards: [Guard; G],
    values: impl Fn(f64) -> [f64; G],
) -> impl HybridSystem<1, G, Mode = ()> {
    Closures::new(|_s, _y: &State<1>| State::from([1.0])).guards(guards, move |s, _y| values(s))
}

/// Checks that a run reaches the end of its span.
fn reaches_end<Mode, const N: usize>(ran: Result<Run<Mode, N>, RunError>) {
    assert_eq!(ran.map(|run| run.outcome), Ok(Outcome::ReachedEnd));
}

fn close(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= tolerance, "{found} {expected}");
    }
}

// Systems from closures.

#[test]
fn closures_are_a_system() {
    let mut bounces = Vec::new();
    let end = run(Dop853, &ball(), at(0.0, [1.0, 0.0]), 3.0, &Options::default(), &mut bounces);
    let end = end.unwrap();
    assert_eq!(end.outcome, Outcome::ReachedEnd);
    assert_eq!(bounces.len(), 4);
    for (n, event) in (0..).zip(&bounces) {
        assert!((event.s - bounce(n)).abs() < 1e-12, "{n}");
        // The state comes with the event: on the guard before, and after the transition.
        assert!(event.before[0].abs() < 1e-13 && event.before[1] < 0.0);
        assert_eq!(event.after, State::from([0.0, -0.9 * event.before[1]]));
    }
}

#[test]
fn without_a_transition_events_are_only_noted() {
    let circle = |_s: f64, y: &State<2>| State::from([y[1], -y[0]]);
    let plain = Closures::new(circle);
    let noted = plain.guards([Guard::new(Direction::Either)], |_s, y| [y[0]]);
    let start = at(0.0, [0.5, 1.0]);
    let mut log = Log::default();
    let one = run(Dop853, &plain, start, 10.0, &Options::default(), &mut ()).unwrap();
    let other = run(Dop853, &noted, start, 10.0, &Options::default(), &mut log).unwrap();
    assert_eq!((one.state, one.s), (other.state, other.s));
    let first = PI - 0.5_f64.atan();
    close(&log.places(), &[first, first + PI, first + 2.0 * PI], 1e-9);
    assert!(log.switches.iter().all(|event| event.before == event.after));
}

// Runs backwards.

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
    for pair in Pair::ALL {
        let options = Options::default();
        let (mut expected, mut found) = (Recorder::default(), Recorder::default());
        let start = [0.3, 1.1];
        let forwards =
            run_with(pair, &mirrored, at(-7.0, start), 4.0, &options, &mut expected).unwrap();
        let run = match pair {
            Pair::Dopri5 => {
                run_backwards(Dopri5, &system, at(7.0, start), -4.0, &options, &mut found)
            }
            Pair::Dop853 => {
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

/// y' = 1 with a wave that an enclosure resolves and samples do not.
struct Wave;

impl ReadableSystem<1, 1> for Wave {
    type Mode = ();

    fn field<T: Number>(&self, (): (), _s: T, _y: &[T; 1]) -> [T; 1] {
        [T::from(1.0)]
    }

    fn guards(&self, (): ()) -> [Guard; 1] {
        [Guard::new(Direction::Either)]
    }

    fn guard_values<T: Number>(&self, (): (), s: T, y: &[T; 1]) -> [T; 1] {
        [((s + y[0]) * (50.0 * PI)).sin() + 0.5]
    }
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

fn start_of_line() -> Start<(), 1> {
    at(0.0, [0.0])
}

// Output at given times.

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
    let offends = |times: &[f64]| Samples::<(), 1>::at(times).err().map(|error| error.index);
    assert_eq!(offends(&[]), None);
    assert_eq!(offends(&[1.0, 1.0, 1.0]), None);
    assert_eq!(offends(&[f64::NEG_INFINITY, 1.0, f64::INFINITY]), None);
    assert_eq!(offends(&[0.0, 1.0, 0.5]), Some(2));
    assert_eq!(offends(&[1.0, 1.0, 0.0, 0.5]), Some(3));
    assert_eq!(offends(&[0.0, f64::NAN, 1.0]), Some(1));
    assert_eq!(offends(&[f64::NAN, f64::NAN]), Some(0));
    let error = Samples::<(), 1>::at(&[0.0, 1.0, 0.5]).unwrap_err();
    assert_eq!(error, InvalidTimes { index: 2, value: 0.5 });
    assert!(error.to_string().contains("0.5 at index 2"));
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

// Two observers.

/// Counts segments that it did not ask for.
struct Segments(usize);
impl Observer<(), 1> for Segments {
    fn on_segment(&mut self, (): (), _dense: &Dense<1>) {
        self.0 += 1;
    }
}

#[test]
fn two_observers_see_the_same_and_either_stops() {
    let system = line([Guard::new(Direction::Either)], |s| [(4.0 * PI * s + 0.1).sin()]);
    for stop_after in [(0, 3), (3, 0)] {
        let mut both = (
            Log { stop_after: stop_after.0, ..Log::default() },
            Log { stop_after: stop_after.1, ..Log::default() },
        );
        let end = run(Dop853, &system, start_of_line(), 1.0, &Options::default(), &mut both);
        assert_eq!(end.unwrap().outcome, Outcome::Stopped);
        assert_eq!(both.0.switches, both.1.switches);
        assert_eq!(both.0.switches.len(), 3);
    }
    // Segments go only to those that want them.
    let mut both = (Segments(0), Recorder::default());
    reaches_end(run(Dop853, &system, start_of_line(), 1.0, &fixed(0.25), &mut both));
    assert_eq!((both.0.0, both.1.trajectory.segments().len()), (0, 4));
}

// Pairs at run time.

#[test]
fn a_pair_at_run_time_is_the_method() {
    let start = at(0.0, [1.0, 0.0]);
    let options = Options::default();
    let one = run(Dopri5, &ball(), start, 3.0, &options, &mut ()).unwrap();
    let other = run(Dop853, &ball(), start, 3.0, &options, &mut ()).unwrap();
    let by = |pair: Pair| run_with(pair, &ball(), start, 3.0, &options, &mut ()).unwrap();
    assert_eq!((by(Pair::Dopri5), by(Pair::Dop853)), (one, other));
    assert_ne!(one.statistics, other.statistics);
}

#[test]
fn pairs_have_the_names_and_numbers_of_methods() {
    fn is<M: Method>(pair: Pair) {
        assert_eq!(pair.to_string(), M::NAME);
        assert_eq!(M::NAME.parse(), Ok(pair));
        assert_eq!(
            (pair.order(), pair.stages(), pair.dense_degree()),
            (M::ORDER, M::STAGES, M::DENSE_DEGREE)
        );
    }
    is::<Dopri5>(Pair::Dopri5);
    is::<Dop853>(Pair::Dop853);
    assert_eq!(format!("{:>8}", Pair::Dopri5), "  dopri5");
    assert_eq!("RK45".parse::<Pair>(), Err(UnknownPair { name: "RK45".to_owned() }));
}

// Tolerances of components.

#[test]
fn equal_tolerances_of_components_change_nothing() {
    let ball = ball();
    let options = Options { rtol: 1e-8, atol: 1e-9, ..Options::default() };
    let weighted = Weighted::new(&ball, [(1e-8, 1e-9); 2]).unwrap();
    for pair in Pair::ALL {
        let one = run_with(pair, &ball, at(0.0, [1.0, 0.0]), 3.0, &options, &mut ());
        let other = run_with(pair, &weighted, at(0.0, [1.0, 0.0]), 3.0, &options, &mut ());
        assert_eq!(one, other);
    }
    const { assert!(<Weighted<Wave, 1> as HybridSystem<1, 1>>::READABLE) };
}

#[test]
fn each_component_has_its_tolerance() {
    // Two oscillators of very different speed, each with its error at the end.
    let field = |_s: f64, y: &State<4>| State::from([y[1], -y[0], 30.0 * y[3], -30.0 * y[2]]);
    let system = Closures::new(field);
    let go = |slow: f64, fast: f64| {
        let tolerances = [(slow, slow), (slow, slow), (fast, fast), (fast, fast)];
        let weighted = Weighted::new(&system, tolerances).unwrap();
        let start = at(0.0, [0.0, 1.0, 0.0, 1.0]);
        let end = run(Dop853, &weighted, start, 3.0, &Options::default(), &mut ()).unwrap();
        let back = run_backwards(Dop853, &weighted, start, -3.0, &Options::default(), &mut ());
        assert_eq!(back.unwrap().statistics, end.statistics);
        let error = |i: usize, speed: f64| (end.state[i] - (3.0 * speed).sin()).abs();
        (error(0, 1.0), error(2, 30.0), end.statistics.accepted)
    };
    let (_, strict, many) = go(1e-11, 1e-11);
    let (slow, loose, few) = go(1e-11, 1e-4);
    assert!(strict < 1e-8 && many > 2 * few, "{strict} {many} {few}");
    assert!(loose > 1e-6 && loose < 0.1 && slow < 1e-9, "{loose} {slow}");
}

#[test]
fn tolerances_of_components_are_checked() {
    let ball = ball();
    let refused = |tolerances| Weighted::new(&ball, tolerances).err().map(|e| (e.name, e.value));
    assert_eq!(refused([(1e-6, 1e-6), (1e-15, 1e300)]), None);
    assert_eq!(refused([(1e-6, 1e-6), (0.2, 1.0)]), Some(("rtol of a component", 0.2)));
    assert_eq!(refused([(1e-6, 0.0), (0.2, 1.0)]), Some(("atol of a component", 0.0)));
    assert!(refused([(f64::NAN, 1.0), (1e-3, 1.0)]).is_some());
    assert!(refused([(1e-3, f64::INFINITY), (1e-3, 1.0)]).is_some());
}

// The ends of runs.

#[test]
fn a_terminal_guard_ends_the_run_when_it_fires_often_enough() {
    for count in [1, 2, 5, 9] {
        // Several firings within one step, which change nothing.
        for h in [1.0, 0.125, 0.01] {
            for (direction, first, every) in
                [(Direction::Either, 1.0, 1.0), (Direction::Falling, 1.0, 2.0)]
            {
                let guard = Guard::new(direction).terminal_after(count);
                let system = line([guard], |s| [(20.0 * PI * (s + 0.003)).sin()]);
                let options = Options { guard_scale: Some(0.02), ..fixed(h) };
                let mut log = Log::default();
                let end = run(Dop853, &system, start_of_line(), 2.0, &options, &mut log).unwrap();
                let place = (first + every * f64::from(count - 1)) / 20.0 - 0.003;
                assert_eq!(end.outcome, Outcome::EndedByGuard { guard: 0 });
                assert!((end.s - place).abs() < 1e-14, "{count} {h}: {} {place}", end.s);
                assert_eq!(log.switches.len(), count as usize);
                assert_eq!(end.statistics.switches, count as usize - 1);
                assert_eq!((log.switches[count as usize - 1].s, log.ends[0]), (end.s, end.s));
            }
        }
    }
    // Firings that change the state.
    let system = Closures::new(|_s, y: &State<2>| State::from([y[1], -9.81]))
        .guards([Guard::new(Direction::Below).terminal_after(4)], |_s, y| [y[0]])
        .transition(|_guard, _s, y| State::from([0.0, -0.9 * y[1]]));
    let end = run(Dop853, &system, at(0.0, [1.0, 0.0]), 9.0, &Options::default(), &mut ()).unwrap();
    assert!((end.s - bounce(3)).abs() < 1e-12 && end.finished().is_ok());
    // Never.
    let never =
        line([Guard::new(Direction::Either).terminal_after(0)], |s| [(9.0 * s + 0.1).sin()]);
    let end = run(Dop853, &never, start_of_line(), 2.0, &Options::default(), &mut ()).unwrap();
    assert_eq!((end.outcome, end.statistics.switches), (Outcome::ReachedEnd, 5));
}

#[test]
fn firings_together_with_another_guard_are_counted() {
    for h in [1.0, 0.5, 0.125, 0.01] {
        for count in [2, 3, 4] {
            let guards = [
                Guard::new(Direction::Either),
                Guard::new(Direction::Either).terminal_after(count),
            ];
            let system = line(guards, |s| [(10.0 * PI * (s + 0.01)).sin(); 2]);
            let options = Options { guard_scale: Some(0.05), ..fixed(h) };
            let end = run(Dop853, &system, start_of_line(), 2.0, &options, &mut ()).unwrap();
            let place = f64::from(count) / 10.0 - 0.01;
            assert_eq!(end.outcome, Outcome::EndedByGuard { guard: 1 }, "{h} {count}");
            assert!((end.s - place).abs() < 1e-14, "{h} {count}: {} {place}", end.s);
        }
    }
}

/// Counts steps, and stops after the third.
struct Steps(usize);
impl Observer<(), 1> for Steps {
    const WANTS_SEGMENTS: bool = true;
    fn on_segment(&mut self, (): (), _dense: &Dense<1>) {
        self.0 += 1;
    }
    fn stops(&self) -> bool {
        self.0 == 3
    }
}

#[test]
fn an_observer_stops_the_run() {
    let wave = line([Guard::new(Direction::Either)], |s| [(20.0 * PI * (s + 0.003)).sin()]);
    for (h, stop_after) in [(1.0, 1), (1.0, 3), (0.1, 3), (0.01, 7)] {
        let options = Options { guard_scale: Some(0.02), ..fixed(h) };
        let mut log = Log { stop_after, ..Log::default() };
        let end = run(Dop853, &wave, start_of_line(), 2.0, &options, &mut log).unwrap();
        // It stops at the switch, though the step went further.
        assert_eq!((end.outcome, log.switches.len()), (Outcome::Stopped, stop_after));
        let place = stop_after as f64 / 20.0 - 0.003;
        assert!((end.s - place).abs() < 1e-14 && (end.state[0] - place).abs() < 1e-14);
        assert_eq!(end.finished(), Err(Unfinished { outcome: Outcome::Stopped, s: end.s }));
    }
    // At a switch that changes something, with the state after it.
    let mut log = Log { stop_after: 2, ..Log::default() };
    let end =
        run(Dop853, &ball(), at(0.0, [1.0, 0.0]), 9.0, &Options::default(), &mut log).unwrap();
    assert_eq!(
        (end.outcome, end.s, end.state),
        (Outcome::Stopped, log.switches[1].s, log.switches[1].after)
    );
    // Without a switch, after a step.
    let end = run(Dop853, &line([], |_| []), start_of_line(), 2.0, &fixed(0.25), &mut Steps(0));
    let end = end.unwrap();
    assert_eq!((end.outcome, end.s), (Outcome::Stopped, 0.75));
}

#[test]
fn transitions_at_one_instant_end_the_run() {
    // At s = 0.5 the guard stays negative, whatever the transition does.
    let system = Closures::new(|_s, _y: &State<1>| State::from([1.0]))
        .guards([Guard::new(Direction::Below)], |s, _y| [0.5 - s])
        .transition(|_guard, _s, y| State::from([y[0] + 1.0]));
    let options = Options { max_at_one_instant: 7, ..Options::default() };
    let (mut log, mut back) = (Log::default(), Log::default());
    let end = run(Dop853, &system, start_of_line(), 1.0, &options, &mut log).unwrap();
    let Outcome::InstantLimit { s } = end.outcome else { panic!("{end:?}") };
    assert!((s - 0.5).abs() < 1e-15 && end.s == s);
    let last = &log.switches[log.switches.len() - 7..];
    assert!(last.iter().all(|event| event.s == s));
    assert_eq!(end.state, last[6].after);
    assert_eq!(end.finished(), Err(Unfinished { outcome: end.outcome, s }));
    let mirrored = Closures::new(|_s, _y: &State<1>| State::from([1.0]))
        .guards([Guard::new(Direction::Below)], |s, _y| [0.5 + s])
        .transition(|_guard, _s, y| State::from([y[0] + 1.0]));
    let end = run_backwards(Dop853, &mirrored, start_of_line(), -1.0, &options, &mut back).unwrap();
    assert_eq!(end.outcome, Outcome::InstantLimit { s: -s });
}

#[test]
fn only_regular_ends_are_finished() {
    let start = at(0.0, [1.0, 0.0]);
    let go =
        |options: Options, end: f64| run(Dop853, &ball(), start, end, &options, &mut ()).unwrap();
    let regular = go(Options::default(), 1.0);
    assert_eq!(regular.finished(), Ok(regular));
    for (options, expected) in [
        (Options { max_steps: 3, ..Options::default() }, Outcome::StepLimit),
        (Options { max_switches: 2, ..Options::default() }, Outcome::SwitchLimit),
    ] {
        let early = go(options, 5.0);
        assert_eq!(early.outcome, expected);
        assert_eq!(early.finished(), Err(Unfinished { outcome: expected, s: early.s }));
    }
    let start = at(0.0, [0.0, 1.0]);
    let zeno = run(Dop853, &thrown(), start, 100.0, &Options::default(), &mut ()).unwrap();
    assert!(matches!(zeno.outcome, Outcome::Zeno { .. }));
    let error = zeno.finished().unwrap_err();
    assert_eq!((error.outcome, error.s), (zeno.outcome, zeno.s));
    assert!(error.to_string().contains("ended early"));
}

// The defined answers that are not above.

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
            let values = |s: f64| [end - s];
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
