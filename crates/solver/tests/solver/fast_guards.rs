//! Guards of black boxes that go up and down often on one step and name their time scale. Their
//! zeros are no poles, and the poles of others are.

use std::f64::consts::{FRAC_PI_2, PI};

use fastrand::Rng;
use stickslip_solver::dynamic::{DynamicEvent, DynamicObserver, DynamicStart, run_dynamic_with};
use stickslip_solver::{
    Closures, Direction, EmbeddedPair, Guard, Observer, Options, Outcome, RunError, State,
    SwitchEvent, hybrid::Pole,
};

use super::dynamic::Plain;
use super::runs::{at, close, fixed};
use crate::erased::run_with;

/// The places of switches and poles.
#[derive(Default)]
struct Found {
    switches: Vec<f64>,
    poles: Vec<f64>,
    jumps: usize,
}

impl Observer<(), 1> for Found {
    fn on_switch(&mut self, event: &SwitchEvent<(), 1>) {
        self.switches.push(event.s);
        self.jumps += usize::from(event.jump);
    }

    fn on_pole(&mut self, pole: &Pole<()>) {
        self.poles.push(pole.s);
    }
}

impl DynamicObserver<()> for Found {
    fn on_switch(&mut self, event: &DynamicEvent<'_, ()>) {
        self.switches.push(event.s);
        self.jumps += usize::from(event.jump);
    }

    fn on_pole(&mut self, pole: &Pole<()>) {
        self.poles.push(pole.s);
    }
}

/// What runs along y' = 1 from y = s find of a guard, by both pairs, in fixed and in any dimension.
fn each(
    guard: impl Fn(f64, f64) -> f64 + Copy + 'static,
    (start, end): (f64, f64),
    options: &Options,
    mut check: impl FnMut(&str, &Found),
) {
    let either = Guard::new(Direction::Either);
    let system = Closures::new(|_s, _y: &State<1>| State::from([1.0]))
        .guards([either], move |s, y| [guard(s, y[0])]);
    let dynamic = Plain {
        field: |_s, _y: &[f64], slope: &mut [f64]| slope[0] = 1.0,
        guards: vec![either],
        values: move |s, y: &[f64], values: &mut [f64]| values[0] = guard(s, y[0]),
    }
    .boxed();
    let reached = |outcome: Result<Outcome, RunError>| {
        assert_eq!(outcome, Ok(Outcome::ReachedEnd));
    };
    for pair in EmbeddedPair::ALL {
        let mut found = Found::default();
        let run = run_with(pair, &system, at(start, [start]), end, options, &mut found);
        reached(run.map(|run| run.outcome));
        check(&format!("{pair:?}, fixed"), &found);
        let mut found = Found::default();
        let from = DynamicStart { mode: (), s: start, state: &[start] };
        let run = run_dynamic_with(pair, &dynamic, from, end, options, &mut found);
        reached(run.map(|run| run.outcome));
        check(&format!("{pair:?}, dynamic"), &found);
    }
}

/// The places first, first + period, … in ]start, end[.
fn repeated(first: f64, period: f64, (start, end): (f64, f64)) -> impl Iterator<Item = f64> {
    let begin = ((start - first) / period).ceil();
    (0..).map(move |k| first + (begin + f64::from(k)) * period).take_while(move |s| *s < end)
}

#[test]
fn zeros_of_a_fast_guard_on_long_steps_are_no_poles() {
    let options = Options { guard_scale: Some(0.01), ..Options::default() };
    let expected: Vec<f64> = (1..=955).map(|k| (PI * f64::from(k) - 1.0) / 300.0).collect();
    each(
        |_s, y| (300.0 * y + 1.0).sin(),
        (0.0, 10.0),
        &options,
        |name, found| {
            assert!(found.poles.is_empty() && found.jumps == 0, "{name}: {:?}", found.poles);
            // Measured: 7e-15.
            close(&found.switches, &expected, 1.5e-14);
        },
    );
}

#[test]
#[ignore = "long; .ci/run --long runs it"]
fn zeros_of_random_fast_guards_on_long_steps_are_no_poles() {
    let mut rng = Rng::with_seed(17);
    for case in 0..50 {
        let omega = 20.0 * 15_f64.powf(rng.f64());
        let phase = 6.2 * rng.f64();
        let level = if rng.bool() { 0.0 } else { 1.9 * rng.f64() - 0.95 };
        let start = if rng.bool() { 0.0 } else { 6.0 * rng.f64() - 3.0 };
        let span = (start, start + 1.0 + 9.0 * rng.f64());
        let tolerance = 10_f64.powf(-4.0 - 9.0 * rng.f64());
        let guard_scale = Some((0.2 + 0.8 * rng.f64()) / omega);
        let options = Options { guard_scale, ..Options::with_tolerance(tolerance) };
        let by_time = rng.bool();
        let angle: f64 = f64::asin(level);
        let zeros = |angle: f64| repeated((angle - phase) / omega, 2.0 * PI / omega, span);
        let mut expected: Vec<f64> = zeros(angle).chain(zeros(PI - angle)).collect();
        expected.sort_by(f64::total_cmp);
        each(
            move |s, y| (omega * if by_time { s } else { y } + phase).sin() - level,
            span,
            &options,
            |name, found| {
                assert!(found.poles.is_empty(), "{case}, {name}: {:?}", found.poles);
                assert_eq!(found.jumps, 0, "{case}, {name}");
                // Measured: 1.5e-14.
                close(&found.switches, &expected, 3e-14);
            },
        );
    }
}

#[test]
fn poles_on_long_steps_are_poles() {
    let mut rng = Rng::with_seed(18);
    for case in 0..100 {
        let start = if rng.bool() { 0.0 } else { 6.0 * rng.f64() - 3.0 };
        let span = (start, start + 1.0 + 9.0 * rng.f64());
        let place = span.0 + (0.02 + 0.96 * rng.f64()) * (span.1 - span.0);
        let guard_scale = rng.bool().then(|| 0.01 + rng.f64());
        let tolerance = 10_f64.powf(-4.0 - 9.0 * rng.f64());
        let options = Options { guard_scale, ..Options::with_tolerance(tolerance) };
        let by_time = rng.bool();
        each(
            move |s, y| 1.0 / (if by_time { s } else { y } - place),
            span,
            &options,
            |name, found| {
                assert!(found.switches.is_empty(), "{case}, {name}: {:?}", found.switches);
                // Measured: 1.5e-14.
                close(&found.poles, &[place], 3e-14);
            },
        );
    }
}

#[test]
fn poles_and_zeros_of_tan_are_told_apart() {
    let span = (0.5, 20.0);
    let places = |angle: f64| -> Vec<f64> { repeated(angle, PI, span).collect() };
    for h in [0.01, 0.1, 0.3, 1.0] {
        each(
            |s, _y| s.tan(),
            span,
            &fixed(h),
            |name, found| {
                assert_eq!(found.jumps, 0, "{h}, {name}");
                close(&found.switches, &places(0.0), 1e-13);
                close(&found.poles, &places(FRAC_PI_2), 1e-13);
            },
        );
    }
}
