//! Systems that nobody here designed for, as a stranger would write them.

use std::f64::consts::PI;

use stickslip_solver::{
    Direction, Dop853, Dopri5, Enclosure, Guard, HybridSystem, Method, Number, Options, Outcome,
    ReadableSystem, Recorder, RunError, Start, State, StepSize, SwitchEvent,
};

use crate::black_box::BlackBox;
use crate::erased::run;

/// Relaxation oscillators with a guard that varies faster than they do.
enum Oscillator {
    VanDerPol,
    Brusselator,
}

struct Observed(Oscillator, f64);

impl ReadableSystem<2, 1> for Observed {
    type Mode = ();

    fn field<T: Number>(&self, (): (), _t: T, y: &[T; 2]) -> [T; 2] {
        let [x, z] = *y;
        match self.0 {
            Oscillator::VanDerPol => [z, (-x * x + 1.0) * z * 5.0 - x],
            Oscillator::Brusselator => [x * x * z - x * 4.0 + 1.0, x * 3.0 - x * x * z],
        }
    }

    fn guards(&self, (): ()) -> [Guard; 1] {
        [Guard::new(Direction::Either)]
    }

    fn guard_values<T: Number>(&self, (): (), _t: T, y: &[T; 2]) -> [T; 1] {
        [(y[0] * 3.0 + y[1] * 2.0).sin() - self.1]
    }
}

fn sign_changes<M: Method>(method: M, system: &Observed, tolerance: f64) {
    let start = Start { mode: (), s: 0.0, state: State::from([1.5, 2.0]) };
    let options = Options::with_tolerance(tolerance);
    let value = |y: &State<2>| HybridSystem::guard_values(system, (), 0.0, y)[0];
    let check = |recorder: Recorder<(), 2>, name: &str| {
        for event in &recorder.switches {
            assert!(value(&event.before).abs() < 1e-9, "{name} {tolerance:e}: {event:?}");
        }
        // Between events that are not close together, the trajectory keeps the sign that it has
        // after the event.
        let places: Vec<f64> = recorder.switches.iter().map(|event| event.s).collect();
        for pair in places.windows(2).filter(|pair| pair[1] - pair[0] > 1e-6) {
            let signs: Vec<bool> = (1..40)
                .filter_map(|i| {
                    let s = pair[0] + f64::from(i) / 40.0 * (pair[1] - pair[0]);
                    let value = value(&recorder.trajectory.at(s)?.1);
                    // The dense output is less accurate than the events.
                    (value.abs() > 1e-3).then_some(value > 0.0)
                })
                .collect();
            let first = signs.first().copied();
            assert!(signs.iter().all(|s| Some(*s) == first), "{name} {tolerance:e} {pair:?}");
        }
        places.len()
    };
    let (mut read, mut sampled) = (Recorder::default(), Recorder::default());
    let ends = [
        run(method, system, start, 20.0, &options, &mut read),
        run(method, &BlackBox(system), start, 20.0, &options, &mut sampled),
    ];
    assert!(
        ends.iter().all(|end| end.as_ref().is_ok_and(|end| end.outcome == Outcome::ReachedEnd))
    );
    assert_eq!(check(read, "readable"), check(sampled, "black box"), "{tolerance:e}");
}

#[test]
fn sign_changes_along_oscillators_at_loose_tolerances() {
    for level in [-0.7, -0.2, 0.1, 0.5, 0.9] {
        for oscillator in [Oscillator::VanDerPol, Oscillator::Brusselator] {
            let system = Observed(oscillator, level);
            for tolerance in [1e-5, 1e-7, 1e-9] {
                sign_changes(Dop853, &system, tolerance);
                sign_changes(Dopri5, &system, tolerance);
            }
        }
    }
}

/// y' = 1 with a chain of modes that follow each other where y = 1.
struct Chain(u32);

impl ReadableSystem<1, 1> for Chain {
    type Mode = u32;

    fn field<T: Number>(&self, _mode: u32, _t: T, _y: &[T; 1]) -> [T; 1] {
        [T::from(1.0)]
    }

    fn guards(&self, mode: u32) -> [Guard; 1] {
        [if mode < self.0 { Guard::new(Direction::Below) } else { Guard::OFF }]
    }

    fn guard_values<T: Number>(&self, _mode: u32, _t: T, y: &[T; 1]) -> [T; 1] {
        [-y[0] + 1.0]
    }

    fn transition(&self, mode: u32, _: usize, _t: f64, y: &State<1>) -> (u32, State<1>) {
        (mode + 1, *y)
    }
}

#[test]
fn finitely_many_transitions_at_one_instant_are_not_an_accumulation() {
    let start = Start { mode: 0, s: 0.0, state: State::zeros() };
    for zeno in [0.0, 1e-13] {
        let options = Options { zeno, ..Options::default() };
        for count in [1, 12, 100, 900] {
            let end = run(Dop853, &Chain(count), start, 2.0, &options, &mut ()).unwrap();
            assert_eq!((end.outcome, end.mode), (Outcome::ReachedEnd, count));
            assert!((end.state[0] - 2.0).abs() < 1e-14);
        }
        let mut switches = Vec::new();
        let error = run(Dop853, &Chain(2000), start, 2.0, &options, &mut switches).unwrap_err();
        let RunError::Cycle { s, count: 1000, cycle } = error else { panic!("{error:?}") };
        assert!(
            (s - 1.0).abs() < 1e-14
                && cycle.len() == 8
                && cycle.iter().all(|(guard, _)| *guard == 0)
        );
        assert!(switches.is_empty());
    }
}

/// y' = 1 with 64 guards that fall at one place, at different slopes.
struct Together;

impl ReadableSystem<1, 64> for Together {
    type Mode = ();

    fn field<T: Number>(&self, (): (), _t: T, _y: &[T; 1]) -> [T; 1] {
        [T::from(1.0)]
    }

    fn guards(&self, (): ()) -> [Guard; 64] {
        [Guard::new(Direction::Falling); 64]
    }

    fn guard_values<T: Number>(&self, (): (), _t: T, y: &[T; 1]) -> [T; 64] {
        std::array::from_fn(|k| (-y[0] + 0.7) * (1.0 + k as f64))
    }
}

#[test]
fn sixty_four_guards_fall_together() {
    let start = Start { mode: (), s: 0.0, state: State::zeros() };
    let mut events: Vec<SwitchEvent<(), 1>> = Vec::new();
    let mut sampled = events.clone();
    let options = Options::default();
    let end = run(Dop853, &Together, start, 1.0, &options, &mut events).unwrap();
    assert_eq!(end.outcome, Outcome::ReachedEnd);
    let end = run(Dop853, &BlackBox(&Together), start, 1.0, &options, &mut sampled).unwrap();
    assert_eq!(end.outcome, Outcome::ReachedEnd);
    for events in [events, sampled] {
        assert!(events.iter().all(|event| (event.s - 0.7).abs() < 1e-14));
        let mut fired: Vec<usize> = events
            .iter()
            .flat_map(|event| {
                let others = (0..64).filter(|other| event.simultaneous >> other & 1 == 1);
                others.chain([event.guard])
            })
            .collect();
        fired.sort_unstable();
        assert_eq!(fired, (0..64).collect::<Vec<_>>());
    }
}

/// A ball that bounces and may count its bounces. Its apex is noted.
struct Ball {
    counts: bool,
    restitution: f64,
}

impl ReadableSystem<2, 2> for Ball {
    type Mode = u32;

    fn field<T: Number>(&self, _bounces: u32, _t: T, y: &[T; 2]) -> [T; 2] {
        [y[1], T::from(-9.81)]
    }

    fn guards(&self, _bounces: u32) -> [Guard; 2] {
        let apex = Guard::new(Direction::Falling);
        [Guard::new(Direction::Below), if self.counts { Guard::OFF } else { apex }]
    }

    fn guard_values<T: Number>(&self, _bounces: u32, _t: T, y: &[T; 2]) -> [T; 2] {
        *y
    }

    fn transition(&self, bounces: u32, guard: usize, _t: f64, y: &State<2>) -> (u32, State<2>) {
        match guard {
            // The height stays as rounding left it.
            0 if self.counts => (bounces + 1, State::from([y[0], -self.restitution * y[1]])),
            0 => (bounces, State::from([0.0, -self.restitution * y[1]])),
            _ => (bounces, *y),
        }
    }
}

#[test]
fn a_ball_whose_apex_is_noted_comes_to_rest() {
    for restitution in [0.1, 0.5, 0.9, 0.99] {
        let ball = Ball { counts: false, restitution };
        let start = Start { mode: 0, s: 0.0, state: State::from([1.5, 0.0]) };
        let rest = (3.0_f64 / 9.81).sqrt() * (1.0 + restitution) / (1.0 - restitution);
        let options = Options::default();
        let ends = [
            run(Dop853, &ball, start, f64::INFINITY, &options, &mut ()),
            run(Dopri5, &BlackBox(&ball), start, f64::INFINITY, &options, &mut ()),
        ];
        for end in ends {
            let Outcome::Zeno { accumulation } = end.as_ref().unwrap().outcome else {
                panic!("{restitution}: {end:?}")
            };
            assert!((accumulation / rest - 1.0).abs() < 1e-11, "{restitution}: {accumulation}");
        }
    }
}

/// A ball above a floor at some height, which rounding makes coarse.
struct Above {
    floor: f64,
    restitution: f64,
    guard: Guard,
}

impl ReadableSystem<2, 1> for Above {
    type Mode = ();

    fn field<T: Number>(&self, (): (), _t: T, y: &[T; 2]) -> [T; 2] {
        [y[1], T::from(-9.8)]
    }

    fn guards(&self, (): ()) -> [Guard; 1] {
        [self.guard]
    }

    fn guard_values<T: Number>(&self, (): (), _t: T, y: &[T; 2]) -> [T; 1] {
        [y[0] - self.floor]
    }

    fn transition(&self, (): (), _guard: usize, _t: f64, y: &State<2>) -> ((), State<2>) {
        ((), State::from([y[0], -self.restitution * y[1]]))
    }
}

#[test]
fn a_ball_comes_to_rest_on_any_floor() {
    for floor in [0.0, 1e-6, 0.1, 1.0, -3.0, 1e3] {
        for restitution in [0.1, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95] {
            for direction in [Direction::Falling, Direction::Below] {
                let ball = Above { floor, restitution, guard: Guard::new(direction) };
                for height in [0.3, 1.0, 10.0] {
                    let start =
                        Start { mode: (), s: 0.0, state: State::from([floor + height, 0.0]) };
                    let fall = (2.0 * height / 9.8_f64).sqrt();
                    let rest = fall * (1.0 + restitution) / (1.0 - restitution);
                    let (end, options) = (20.0 * rest, Options::default());
                    let ends = [
                        run(Dop853, &ball, start, end, &options, &mut ()),
                        run(Dopri5, &ball, start, end, &options, &mut ()),
                        run(Dop853, &BlackBox(&ball), start, end, &options, &mut ()),
                        run(Dopri5, &BlackBox(&ball), start, end, &options, &mut ()),
                    ];
                    for end in ends {
                        // A condition of a black box may be refused where rounding leaves it at 0.
                        if matches!(end, Err(RunError::GuardIdenticallyZero { .. })) {
                            assert_eq!(direction, Direction::Below);
                            continue;
                        }
                        let Outcome::Zeno { accumulation } = end.as_ref().unwrap().outcome else {
                            panic!("{floor} {restitution} {height} {direction:?}: {end:?}")
                        };
                        let error = accumulation / rest - 1.0;
                        assert!(error.abs() < 1e-5, "{floor} {restitution} {direction:?}: {error}");
                    }
                }
            }
        }
    }
}

/// A height that rounding left a hair below the floor is on it.
#[test]
fn a_ball_that_counts_its_bounces_does_not_fall_through() {
    let mut random = fastrand::Rng::with_seed(7);
    for _ in 0..2000 {
        let height = 0.1 + 3.0 * random.f64();
        let ball = Ball { counts: true, restitution: 0.8 };
        let start = Start { mode: 0, s: 0.0, state: State::from([height, 0.0]) };
        let fall = (2.0 * height / 9.81).sqrt();
        // In the middle of the flight after twelve bounces.
        let time = |bounces: i32| fall * (1.0 + 1.6 * (1.0 - 0.8_f64.powi(bounces)) / 0.2);
        let until = 0.5 * (time(11) + time(12));
        for end in [
            run(Dop853, &ball, start, until, &Options::default(), &mut ()),
            run(Dopri5, &BlackBox(&ball), start, until, &Options::default(), &mut ()),
        ] {
            let end = end.unwrap();
            assert_eq!((end.outcome, end.mode), (Outcome::ReachedEnd, 12), "{height}");
            let apex = height * 0.8_f64.powi(24);
            assert!((end.state[0] - apex).abs() < 1e-9, "{height}: {} {apex}", end.state[0]);
        }
    }
}

/// y' = −1 from a guard that is zero at the start.
struct Falls;

impl ReadableSystem<1, 1> for Falls {
    type Mode = bool;

    fn field<T: Number>(&self, _fired: bool, _t: T, _y: &[T; 1]) -> [T; 1] {
        [T::from(-1.0)]
    }

    fn guards(&self, fired: bool) -> [Guard; 1] {
        [if fired { Guard::OFF } else { Guard::new(Direction::Falling) }]
    }

    fn guard_values<T: Number>(&self, _fired: bool, _t: T, y: &[T; 1]) -> [T; 1] {
        [y[0]]
    }

    fn transition(&self, _fired: bool, _: usize, _t: f64, y: &State<1>) -> (bool, State<1>) {
        (true, *y)
    }
}

#[test]
fn a_guard_that_falls_from_zero_at_the_start_costs_little_wherever_that_is() {
    for s in [0.0, 1.0, -3.0, 1e9] {
        let start = Start { mode: false, s, state: State::zeros() };
        let options = Options::default();
        for end in [
            run(Dop853, &Falls, start, s + 1.0, &options, &mut ()),
            run(Dop853, &BlackBox(&Falls), start, s + 1.0, &options, &mut ()),
        ] {
            let end = end.unwrap();
            assert!(end.mode && end.statistics.switches == 1, "{s}: {end:?}");
            // Seven steps alone take 84.
            assert!(end.statistics.field < 150, "{s}: {:?}", end.statistics);
        }
    }
}

/// A stone that falls on a table that shakes at 100 Hz, and the first impact.
struct Table;

const SHAKE: (f64, f64) = (0.01, 200.0 * PI);

impl ReadableSystem<2, 1> for Table {
    type Mode = ();

    fn field<T: Number>(&self, (): (), _t: T, y: &[T; 2]) -> [T; 2] {
        [y[1], T::from(-9.81)]
    }

    fn guards(&self, (): ()) -> [Guard; 1] {
        [Guard::new(Direction::Below).terminal()]
    }

    fn guard_values<T: Number>(&self, (): (), t: T, y: &[T; 2]) -> [T; 1] {
        [y[0] - (t * SHAKE.1).sin() * SHAKE.0]
    }
}

/// The first impact of a stone from `height`, by a scan that the curvature of the gap makes safe.
fn first_impact(height: f64) -> f64 {
    let gap = |t: f64| height - 0.5 * 9.81 * t * t - SHAKE.0 * (SHAKE.1 * t).sin();
    let curvature = 9.81 + SHAKE.0 * SHAKE.1 * SHAKE.1;
    let mut t = 0.0;
    loop {
        // Between t and t + d the gap stays above g + g' d − c d²/2.
        let slope = -9.81 * t - SHAKE.0 * SHAKE.1 * (SHAKE.1 * t).cos();
        let safe = (slope + (slope * slope + 2.0 * curvature * gap(t)).sqrt()) / curvature;
        if safe <= 1e-15 * t {
            return t;
        }
        t += safe;
    }
}

#[test]
fn the_first_impact_on_a_shaking_table() {
    for k in 0..300 {
        let height = 0.3 + 0.01 * f64::from(k);
        let expected = first_impact(height);
        let start = Start { mode: (), s: 0.0, state: State::from([height, 0.0]) };
        let (read, scale) =
            (Options::default(), Options { guard_scale: Some(1e-3), ..Options::default() });
        for end in [
            run(Dop853, &Table, start, 2.0, &read, &mut ()),
            run(Dopri5, &Table, start, 2.0, &read, &mut ()),
            run(Dop853, &BlackBox(&Table), start, 2.0, &scale, &mut ()),
        ] {
            let end = end.unwrap();
            assert!((end.s - expected).abs() < 1e-7, "{height}: {} {expected}", end.s);
        }
    }
}

/// A clock with a guard of the time.
struct Timed<F>(F);

impl<F: Fn(f64) -> f64> HybridSystem<1, 1> for Timed<F> {
    type Mode = ();

    fn field(&self, (): (), _t: f64, _y: &State<1>) -> State<1> {
        State::from([1.0])
    }

    fn guards(&self, (): ()) -> [Guard; 1] {
        [Guard::new(Direction::Either)]
    }

    fn guard_values(&self, (): (), t: f64, _y: &State<1>) -> [f64; 1] {
        [(self.0)(t)]
    }
}

#[test]
fn poles_of_tan_are_not_zeros() {
    let start = Start { mode: (), s: 0.5, state: State::zeros() };
    for h in [0.01, 0.1, 0.3, 1.0] {
        let options = Options { step_size: StepSize::Fixed(h), ..Options::default() };
        let mut events: Vec<SwitchEvent<(), 1>> = Vec::new();
        let end = run(Dop853, &Timed(f64::tan), start, 20.0, &options, &mut events).unwrap();
        assert_eq!(end.outcome, Outcome::ReachedEnd);
        let zeros: Vec<f64> = (1..=6).map(|k| PI * f64::from(k)).collect();
        assert_eq!(events.len(), zeros.len(), "{h}: {events:?}");
        for (event, zero) in events.iter().zip(zeros) {
            assert!((event.s - zero).abs() < 1e-13, "{h}: {}", event.s);
        }
    }
}

#[test]
fn a_jump_is_reported_as_one() {
    let start = Start { mode: (), s: 0.0, state: State::zeros() };
    let mut events: Vec<SwitchEvent<(), 1>> = Vec::new();
    let jump = |t: f64| if t < 0.3 { 1.0 } else { -2.0 };
    let end = run(Dop853, &Timed(jump), start, 1.0, &Options::default(), &mut events).unwrap();
    assert_eq!((end.outcome, events.len()), (Outcome::ReachedEnd, 1));
    assert!((events[0].s - 0.3).abs() < 1e-14 && events[0].jump);
}

/// y' = −r y with a guard that ends the run.
struct Decay<const N: usize> {
    rate: f64,
    ends: f64,
}

impl<const N: usize> ReadableSystem<N, 1> for Decay<N> {
    type Mode = ();

    fn field<T: Number>(&self, (): (), _t: T, y: &[T; N]) -> [T; N] {
        y.map(|y| y * -self.rate)
    }

    fn guards(&self, (): ()) -> [Guard; 1] {
        [Guard::new(Direction::Falling).terminal()]
    }

    fn guard_values<T: Number>(&self, (): (), t: T, _y: &[T; N]) -> [T; 1] {
        [-t + self.ends]
    }
}

#[test]
fn a_terminal_zero_exactly_at_the_end_of_the_span_ends_the_run() {
    let start = Start { mode: (), s: 0.0, state: State::from([1.0]) };
    for end in [1.0, 0.1, 3.0, 1e-3, 7.7] {
        for options in [
            Options::default(),
            Options { step_size: StepSize::Fixed(0.25 * end), ..Options::default() },
        ] {
            for found in [
                run(Dop853, &Decay::<1> { rate: 1.0, ends: end }, start, end, &options, &mut ()),
                run(
                    Dopri5,
                    &BlackBox(&Decay::<1> { rate: 1.0, ends: end }),
                    start,
                    end,
                    &options,
                    &mut (),
                ),
            ] {
                let found = found.unwrap();
                assert_eq!(found.outcome, Outcome::EndedByGuard { guard: 0 }, "{end} {options:?}");
                assert_eq!(found.s, end);
            }
        }
        // A zero after the end does not fire.
        let after = run(
            Dop853,
            &Decay::<1> { rate: 1.0, ends: end * 1.001 },
            start,
            end,
            &Options::default(),
            &mut (),
        );
        assert_eq!(after.unwrap().outcome, Outcome::ReachedEnd);
    }
}

#[test]
fn the_whole_range_of_numbers_is_usable() {
    let go = |rate: f64, state: [f64; 2], options: &Options| {
        let system = Decay::<2> { rate, ends: f64::INFINITY };
        let start = Start { mode: (), s: 0.0, state: State::from(state) };
        run(Dop853, &system, start, 1.0, options, &mut ()).unwrap().finished().unwrap().state
    };
    let decayed = (-1.0_f64).exp();
    for atol in [1e-312, 5e-324, 1e-200, 1e300] {
        let options = Options { atol, ..Options::default() };
        let end = go(1.0, [1.0, 0.0], &options);
        let error = (end[0] - decayed).abs();
        assert!(error < if atol < 1.0 { 1e-9 } else { 1.0 } && end[1] == 0.0, "{atol:e}: {end}");
    }
    for step_size in [StepSize::Fixed(0.01), StepSize::Adaptive] {
        let options = Options { step_size, ..Options::default() };
        for size in [1e306, 1e-300, 1e150] {
            let options = Options { atol: 1e-12 * size, ..options };
            let end = go(1.0, [size, -size], &options);
            assert!((end[0] / size - decayed).abs() < 1e-9, "{size:e} {step_size:?}: {end}");
            assert_eq!(end[1], -end[0]);
        }
        // The sum of these components is out of range.
        assert_eq!(go(0.0, [1.2e308; 2], &options), State::from([1.2e308; 2]));
    }
}

/// Bounds of one guard do not depend on other guards that are not finite.
#[test]
fn enclosures_of_a_system_are_those_of_its_formulas() {
    let bounds = HybridSystem::enclose_guards(
        &Table,
        (),
        Enclosure::from(0.25),
        &[Enclosure::from(1.0), Enclosure::from(0.0)],
    );
    let value = HybridSystem::guard_values(&Table, (), 0.25, &State::from([1.0, 0.0]))[0];
    assert!(bounds[0].value.contains(value) && bounds[0].value.width() < 1e-13);
}
