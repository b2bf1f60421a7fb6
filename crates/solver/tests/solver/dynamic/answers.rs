//! The defined answers, limits, errors and runs backwards.

use stickslip_solver::dynamic::{
    DynamicDense, DynamicEvent, DynamicObserver, DynamicStart, DynamicSwitch, DynamicSystem,
};
use stickslip_solver::{Direction, Dop853, Dopri5, Guard, Options, Outcome, RunError, StepSize};

use super::{Boxed, Plain, go, places};
use crate::erased::{run_dynamic, run_dynamic_backwards};

type Switches = Vec<DynamicSwitch<()>>;

/// y' = 1 from y = 0, with these guards.
fn clock(guards: Vec<Guard>, values: impl Fn(f64, &[f64], &mut [f64]) + 'static) -> Boxed<'static> {
    Plain { field: |_s, _y: &[f64], f: &mut [f64]| f.fill(1.0), guards, values }.boxed()
}

#[test]
fn a_hundred_guards_at_one_place_are_all_named() {
    let guards = vec![Guard::new(Direction::Falling); 100];
    let values = |s: f64, _y: &[f64], v: &mut [f64]| v.fill(0.3 - s);
    let mut switches = Switches::new();
    let run = go(Dop853, &clock(guards, values), &[0.0], 1.0, &Options::default(), &mut switches);
    assert_eq!(run.expect("a clock").outcome, Outcome::ReachedEnd);
    assert_eq!(switches.len(), 1);
    assert_eq!(switches[0].guard, 0);
    assert_eq!(switches[0].simultaneous, (1..100).collect::<Vec<_>>());
    // Each has fired once: those that end the run at the second zero have one more to go.
    let guards = vec![Guard::new(Direction::Either).terminal_after(2); 100];
    let values = |s: f64, _y: &[f64], v: &mut [f64]| v.fill((s - 0.3) * (s - 0.6));
    let mut switches = Switches::new();
    let run = go(Dop853, &clock(guards, values), &[0.0], 1.0, &Options::default(), &mut switches);
    let run = run.expect("a clock").finished().expect("a terminal guard");
    assert_eq!(run.outcome, Outcome::EndedByGuard { guard: 0 });
    assert!((run.s - 0.6).abs() < 1e-15 && switches.len() == 2);
}

#[test]
fn no_components_at_all() {
    let guards = vec![Guard::new(Direction::Rising)];
    let values = |s: f64, _y: &[f64], v: &mut [f64]| v[0] = s - 0.4;
    let system = clock(guards, values);
    for fixed in [false, true] {
        let step_size = if fixed { StepSize::Fixed(0.3) } else { StepSize::Adaptive };
        let options = Options { step_size, ..Options::default() };
        let mut switches = Switches::new();
        let run = go(Dop853, &system, &[], 1.0, &options, &mut switches).expect("a clock");
        assert!(run.state.is_empty() && run.outcome == Outcome::ReachedEnd);
        assert!((switches[0].s - 0.4).abs() < 1e-15 && switches.len() == 1);
        let run = go(Dopri5, &system, &[], 1.0, &options, &mut ()).expect("a clock");
        assert_eq!(run.statistics.switches, 1);
    }
}

/// Modes with different numbers of guards: mode k has k of them, of which the last one leads on.
struct Stairs(Vec<Guard>);

impl DynamicSystem for Stairs {
    type Mode = usize;

    fn field(&self, _mode: usize, _s: f64, _y: &[f64], slope: &mut [f64]) {
        slope.fill(1.0);
    }
    fn guards(&self, mode: usize) -> &[Guard] {
        &self.0[..mode]
    }
    fn guard_values(&self, mode: usize, s: f64, y: &[f64], values: &mut [f64]) {
        assert_eq!((values.len(), y.len()), (mode, 3));
        values.fill(1.0);
        values[mode - 1] = mode as f64 - s;
    }
    fn transition(&self, mode: usize, _guard: usize, _s: f64, y: &mut [f64]) -> usize {
        y[0] = 0.0;
        if mode == 5 { 1 } else { mode + 1 }
    }
}

#[test]
fn modes_may_have_different_numbers_of_guards() {
    let system = Stairs(vec![Guard::new(Direction::Falling); 5]);
    let start = DynamicStart { mode: 1, s: 0.0, state: &[0.0; 3] };
    let mut switches = Vec::new();
    let run = run_dynamic(Dopri5, &system, start, 9.0, &Options::default(), &mut switches);
    assert_eq!(run.expect("stairs").mode, 1);
    let expected: Vec<(f64, usize)> = (0..5).map(|k| (k as f64 + 1.0, k)).collect();
    assert_eq!(switches.len(), 5);
    for (found, expected) in places(&switches).iter().zip(expected) {
        assert!((found.0 - expected.0).abs() < 1e-14 && found.1 == expected.1);
    }
}

/// Counts what it is shown, and stops after so many switches.
#[derive(Default)]
struct Watcher {
    most: usize,
    switches: usize,
    covered: f64,
    ends: Vec<f64>,
    state: Vec<f64>,
}

impl DynamicObserver<()> for Watcher {
    const WANTS_SEGMENTS: bool = true;

    fn on_switch(&mut self, _event: &DynamicEvent<'_, ()>) {
        self.switches += 1;
    }
    fn on_segment(&mut self, (): (), dense: &DynamicDense<'_>) {
        self.covered += dense.size();
        assert_eq!(dense.dimension(), 2);
        self.state.resize(2, 0.0);
        for theta in [0.0, 0.37, 1.0] {
            let s = dense.start() + theta * dense.size();
            dense.write(theta, &mut self.state);
            assert!((self.state[0] - s.sin()).abs() < 1e-8 && dense.at(theta) == self.state);
            assert_eq!(dense.component(theta, 1), Some(self.state[1]));
            assert_eq!(dense.component(theta, 2), None);
        }
    }
    fn stops(&self, _: f64) -> bool {
        self.switches >= self.most
    }
    fn on_end(&mut self, (): (), s: f64, state: &[f64]) {
        self.ends.push(s);
        assert!((state[0] - s.sin()).abs() < 1e-8);
    }
}

fn oscillator(direction: Direction) -> Boxed<'static> {
    Plain {
        field: |_s, y: &[f64], f: &mut [f64]| (f[0], f[1]) = (y[1], -y[0]),
        guards: vec![Guard::new(direction)],
        values: |_s, y: &[f64], v: &mut [f64]| v[0] = y[0] - 0.5,
    }
    .boxed()
}

#[test]
fn segments_cover_the_run_and_an_observer_stops_it() {
    for most in [1, 3, 100] {
        for backwards in [false, true] {
            let mut watcher = Watcher { most, ..Watcher::default() };
            let start = DynamicStart { mode: (), s: 0.0, state: &[0.0, 1.0] };
            let (system, options) = (oscillator(Direction::Either), Options::default());
            let run = if backwards {
                run_dynamic_backwards(Dop853, &system, start, -40.0, &options, &mut watcher)
            } else {
                run_dynamic(Dop853, &system, start, 40.0, &options, &mut watcher)
            };
            let run = run.expect("an oscillation");
            let stopped = most < 100;
            assert_eq!(run.outcome == Outcome::Stopped, stopped, "{:?}", run.outcome);
            assert_eq!(watcher.switches, if stopped { most } else { 13 - usize::from(backwards) });
            assert!((watcher.covered - run.s).abs() < 1e-12 && watcher.ends == [run.s]);
            assert_eq!(run.s < 0.0, backwards);
            assert_eq!(run.finished().is_err(), stopped);
        }
    }
}

#[test]
fn backwards_finds_the_places_of_forwards() {
    let start = DynamicStart { mode: (), s: 40.0, state: &[40.0_f64.sin(), 40.0_f64.cos()] };
    let mut backwards = Switches::new();
    let (system, options) = (oscillator(Direction::Falling), Options::default());
    let run = run_dynamic_backwards(Dop853, &system, start, 0.0, &options, &mut backwards);
    assert!(run.expect("an oscillation").state[0].abs() < 1e-9);
    let pi = std::f64::consts::PI;
    // Up to 40, where the run starts.
    let mut expected: Vec<f64> =
        (0..7).map(|k| pi / 6.0 + 2.0 * pi * f64::from(k)).filter(|&s| s < 40.0).collect();
    expected.reverse();
    assert_eq!(backwards.len(), expected.len());
    for (found, expected) in backwards.iter().zip(expected) {
        assert!((found.s - expected).abs() < 1e-9);
    }
}

/// A transition that leads to below the guard, again and again.
struct Trap(Guard);
impl DynamicSystem for Trap {
    type Mode = bool;
    fn field(&self, _: bool, _s: f64, _y: &[f64], slope: &mut [f64]) {
        slope.fill(-1.0);
    }
    fn guards(&self, _: bool) -> &[Guard] {
        std::slice::from_ref(&self.0)
    }
    fn guard_values(&self, _: bool, _s: f64, y: &[f64], values: &mut [f64]) {
        values[0] = y[0];
    }
    fn transition(&self, mode: bool, _: usize, _s: f64, y: &mut [f64]) -> bool {
        y[0] = -1.0;
        !mode
    }
}

#[test]
fn limits() {
    let system = oscillator(Direction::Either);
    let run = |options: Options, end: f64| {
        go(Dop853, &system, &[0.0, 1.0], end, &options, &mut ()).expect("an oscillation")
    };
    let options = Options::default();
    assert_eq!(run(Options { max_steps: 3, ..options }, 40.0).outcome, Outcome::StepLimit);
    let limited = run(Options { max_switches: 2, ..options }, f64::INFINITY);
    assert_eq!(limited.outcome, Outcome::SwitchLimit);
    assert!((limited.s - 5.0 * std::f64::consts::PI / 6.0).abs() < 1e-9);
    assert!(limited.finished().is_err());
    let start = DynamicStart { mode: true, s: 0.0, state: &[0.25] };
    let trapped =
        run_dynamic(Dop853, &Trap(Guard::new(Direction::Below)), start, 1.0, &options, &mut ());
    let Err(RunError::Cycle { s, .. }) = trapped else { panic!("no limit") };
    assert!((s - 0.25).abs() < 1e-15);
}

#[test]
fn bad_input_gives_typed_errors() {
    let system = oscillator(Direction::Either);
    let options = Options::default();
    let error = |state: &[f64], end: f64, options: &Options| {
        go(Dop853, &system, state, end, options, &mut ()).expect_err("bad input")
    };
    for end in [0.0, -1.0, f64::NAN, f64::NEG_INFINITY] {
        assert!(matches!(error(&[0.0, 1.0], end, &options), RunError::Span { .. }));
    }
    let bad = Options { rtol: f64::NAN, ..options };
    assert!(matches!(error(&[0.0, 1.0], 1.0, &bad), RunError::Option(_)));
    let found = error(&[0.0, f64::INFINITY], 1.0, &options);
    assert_eq!(found, RunError::State { s: 0.0, component: 1 });
    let found = error(&[f64::NAN, 1.0], 1.0, &options);
    assert_eq!(found, RunError::GuardNotANumber { guard: 0, s: 0.0 });
    let start = DynamicStart { mode: (), s: f64::NAN, state: &[0.0, 1.0] };
    let found = run_dynamic(Dop853, &system, start, 1.0, &options, &mut ());
    assert!(matches!(found, Err(RunError::Span { .. })));
    let start = DynamicStart { mode: (), s: 1.0, state: &[0.0, 1.0] };
    let found = run_dynamic_backwards(Dop853, &system, start, 2.0, &options, &mut ());
    assert_eq!(found.expect_err("not back"), RunError::Span { from: 1.0, to: 2.0 });
}

#[test]
fn fields_and_guards_without_value() {
    let options = Options::default();
    for fixed in [false, true] {
        let step_size = if fixed { StepSize::Fixed(0.1) } else { StepSize::Adaptive };
        let options = Options { step_size, ..options };
        // A field that ends at y = 1/2.
        let ends = Plain {
            field: |_s, y: &[f64], f: &mut [f64]| f[0] = if y[0] < 0.5 { 1.0 } else { f64::NAN },
            guards: Vec::new(),
            values: |_s, _y: &[f64], _v: &mut [f64]| {},
        }
        .boxed();
        let found = go(Dopri5, &ends, &[0.0], 1.0, &options, &mut ());
        assert!(matches!(found, Err(RunError::Field { .. })), "{found:?}");
        // A guard whose domain ends before it fires.
        let guards = vec![Guard::new(Direction::Falling)];
        let never = clock(guards.clone(), |s: f64, _y: &[f64], v: &mut [f64]| {
            v[0] = (0.5 - s).sqrt() + 0.1;
        });
        let found = go(Dop853, &never, &[0.0], 1.0, &options, &mut ());
        let unresolved = matches!(
            found,
            Err(RunError::GuardUnresolved { .. } | RunError::GuardNotANumber { .. })
        );
        assert!(unresolved, "{found:?}");
        let zero = clock(guards.clone(), |_s, _y: &[f64], v: &mut [f64]| v[0] = 0.0);
        let found = go(Dop853, &zero, &[0.0], 1.0, &options, &mut ());
        assert_eq!(found, Err(RunError::GuardIdenticallyZero { guard: 0, s: 0.0 }));
        // Two guards, one of which has no value behind the zero of the other.
        let two = vec![Guard::new(Direction::Below).terminal(), guards[0]];
        let domain = clock(two, |s: f64, _y: &[f64], v: &mut [f64]| {
            v[0] = 0.5 - s;
            v[1] = 1.0 + (0.500_001 - s).sqrt();
        });
        let run = go(Dop853, &domain, &[0.0], 1.0, &options, &mut ()).expect("a domain");
        assert!((run.s - 0.5).abs() < 1e-15 && run.outcome == Outcome::EndedByGuard { guard: 0 });
        // A stiff tolerance.
        let blows_up = Plain {
            field: |_s, y: &[f64], f: &mut [f64]| f[0] = y[0] * y[0],
            guards: Vec::new(),
            values: |_s, _y: &[f64], _v: &mut [f64]| {},
        }
        .boxed();
        assert!(go(Dop853, &blows_up, &[1.0], 2.0, &options, &mut ()).is_err() || fixed);
    }
}
