//! Inputs that nobody designed for.

use stickslip_solver::dynamic::{DynamicEvent, DynamicObserver, DynamicSwitch, DynamicSystem};
use stickslip_solver::{
    Direction, Dop853, Dopri5, Grazing, Guard, Method, Options, Outcome, StepSize,
};

use super::{Plain, go, places};

type Switches = Vec<DynamicSwitch<()>>;

/// Components of very different sizes, and a guard that is a small difference of large ones.
#[test]
fn components_from_tiny_to_huge() {
    let sizes: Vec<f64> = (-15..=15).map(|k| 10_f64.powi(10 * k)).collect();
    let system = Plain {
        field: |_s, y: &[f64], f: &mut [f64]| {
            for (f, y) in f.iter_mut().zip(y) {
                *f = -y;
            }
        },
        guards: vec![Guard::new(Direction::Falling); 31],
        values: |_s, y: &[f64], v: &mut [f64]| {
            for ((v, y), size) in v.iter_mut().zip(y).zip(&sizes) {
                *v = y / size - 0.5;
            }
        },
    }
    .boxed();
    for step_size in [StepSize::Adaptive, StepSize::Fixed(0.1)] {
        let options = Options { atol: 1e-300, step_size, ..Options::default() };
        let mut found = Switches::new();
        let run = go(Dop853, &system, &sizes, 2.0, &options, &mut found).expect("a decay");
        assert_eq!(run.outcome, Outcome::ReachedEnd);
        let count: usize = found.iter().map(|switch| 1 + switch.simultaneous.len()).sum();
        assert_eq!(count, 31, "{:?}", places(&found));
        assert!(found.iter().all(|switch| (switch.s - 2.0_f64.ln()).abs() < 1e-9));
    }
}

/// The mean of many components that all cross together, whose signs alternate.
#[test]
fn coherent_sums_of_many_components() {
    for n in [9, 100, 10_001] {
        let system = Plain {
            field: |_s, y: &[f64], f: &mut [f64]| {
                let n = y.len() / 2;
                for i in 0..n {
                    (f[i], f[n + i]) = (y[n + i], -y[i]);
                }
                f[2 * n..].fill(0.0);
            },
            guards: vec![Guard::new(Direction::Either), Guard::new(Direction::Below)],
            values: |_s, y: &[f64], v: &mut [f64]| {
                let n = y.len() / 2;
                let signed = y[..n].iter().enumerate();
                v[0] = signed.map(|(i, y)| if i % 2 == 0 { *y } else { -y }).sum::<f64>();
                v[1] = 1e-13 + y[..n].iter().map(|y| y * y).sum::<f64>();
            },
        }
        .boxed();
        let state: Vec<f64> = (0..2 * n)
            .map(|i| {
                if i < n {
                    0.0
                } else if i % 2 == 0 {
                    1.0
                } else {
                    -1.0
                }
            })
            .collect();
        let mut found = Switches::new();
        let options = Options { max_switches: 100, ..Options::default() };
        let run = go(Dop853, &system, &state, 10.0, &options, &mut found).expect("oscillators");
        assert_eq!(run.outcome, Outcome::ReachedEnd, "{n}: {:?}", places(&found));
        // The first guard starts from zero in its direction, and then crosses at multiples of π.
        let expected = [0.0, 1.0, 2.0, 3.0].map(|k| k * std::f64::consts::PI);
        assert_eq!(found.len(), 4, "{n}: {:?}", places(&found));
        for (switch, expected) in found.iter().zip(expected) {
            assert!((switch.s - expected).abs() < 1e-9 && switch.guard == 0, "{n}: {}", switch.s);
        }
    }
}

/// Counts touches.
#[derive(Default)]
struct Touches(usize, usize);

impl DynamicObserver<()> for Touches {
    fn on_grazing(&mut self, _grazing: &Grazing<()>) {
        self.0 += 1;
    }
    fn on_switch(&mut self, _event: &DynamicEvent<'_, ()>) {
        self.1 += 1;
    }
}

/// A guard on a large state that only touches zero does not fire.
#[test]
fn touches_of_large_states() {
    for n in [2, 8, 10, 1000] {
        for direction in [Direction::Below, Direction::Falling, Direction::Either] {
            let system = Plain {
                field: |_s, y: &[f64], f: &mut [f64]| {
                    for (f, y) in f.chunks_exact_mut(2).zip(y.chunks_exact(2)) {
                        (f[0], f[1]) = (y[1], -y[0]);
                    }
                },
                guards: vec![Guard::new(direction)],
                values: |_s, y: &[f64], v: &mut [f64]| v[0] = y[0] * y[0],
            }
            .boxed();
            let state: Vec<f64> = (0..n).map(|i| f64::from(u8::from(i % 2 == 0))).collect();
            let mut touches = Touches::default();
            let run = go(Dop853, &system, &state, 30.0, &Options::default(), &mut touches);
            assert!(run.expect("a touch").finished().is_ok());
            assert_eq!(touches.1, 0, "{n}, {direction:?}");
            assert!(touches.0 > 0, "{n}, {direction:?}");
        }
    }
}

/// Floors, kinks, jumps and poles.
#[test]
fn guards_that_are_not_smooth() {
    let with = |value: fn(f64) -> f64, direction: Direction| {
        let mut found = Switches::new();
        let system = Plain {
            field: |_s, _y: &[f64], f: &mut [f64]| f.fill(1.0),
            guards: vec![Guard::new(direction)],
            values: move |_s, y: &[f64], v: &mut [f64]| v[0] = value(y[11]),
        }
        .boxed();
        let run = go(Dopri5, &system, &[0.0; 12], 1.0, &Options::default(), &mut found);
        assert_eq!(run.expect("a guard").outcome, Outcome::ReachedEnd);
        found
    };
    let jump = with(|y| if y < 0.3 { 1.0 } else { -1.0 }, Direction::Falling);
    assert!(jump.len() == 1 && jump[0].jump && (jump[0].s - 0.3).abs() < 1e-14, "{jump:?}");
    let kink = with(|y| (y - 0.3).abs() - 0.1, Direction::Either);
    assert!(kink.len() == 2 && (kink[0].s - 0.2).abs() < 1e-14 && !kink[0].jump, "{kink:?}");
    assert!(with(|y| (y - 0.3).abs(), Direction::Either).is_empty());
    assert!(with(|y| 1.0 / (y - 0.3), Direction::Either).is_empty());
    let floor = with(|y| (y * 4.0).floor() - 1.5, Direction::Rising);
    assert!(floor.len() == 1 && (floor[0].s - 0.5).abs() < 1e-14, "{floor:?}");
}

/// Two noted guards and one that changes the state, closer and closer together.
#[test]
fn guards_close_together_keep_their_order() {
    for exponent in 2..18 {
        let apart = 10_f64.powi(-exponent);
        let system = Plain {
            field: |_s, _y: &[f64], f: &mut [f64]| f.fill(1.0),
            guards: vec![Guard::new(Direction::Falling); 3],
            values: |_s, y: &[f64], v: &mut [f64]| {
                v[0] = 0.5 - y[0];
                v[1] = (0.5 + apart) - y[1];
                v[2] = ((0.5 + 2.0 * apart) - y[2]) * (2.0 + y[0]);
            },
        }
        .boxed();
        for step_size in [StepSize::Adaptive, StepSize::Fixed(0.1), StepSize::Fixed(1.0)] {
            let mut found = Switches::new();
            let options = Options { step_size, ..Options::default() };
            let run = go(Dop853, &system, &[0.0; 3], 1.0, &options, &mut found);
            assert!(run.expect("three guards").finished().is_ok());
            let mut fired = Vec::new();
            for switch in &found {
                fired.push(switch.guard);
                fired.extend(&switch.simultaneous);
                let place = 0.5 + apart * switch.guard as f64;
                assert!((switch.s - place).abs() < 1e-14 + 2e-12 * step_size_of(step_size));
            }
            fired.sort_unstable();
            assert_eq!(fired, [0, 1, 2], "{apart:e} {step_size:?}: {:?}", places(&found));
        }
    }
}

fn step_size_of(step_size: StepSize) -> f64 {
    if let StepSize::Fixed(h) = step_size { h } else { 1.0 }
}

/// Times far from zero, and steps that hardly move them.
#[test]
fn late_times_and_short_spans() {
    let system = Plain {
        field: |_s, y: &[f64], f: &mut [f64]| (f[0], f[1]) = (y[1], -y[0]),
        guards: vec![Guard::new(Direction::Either)],
        values: |_s, y: &[f64], v: &mut [f64]| v[0] = y[0],
    }
    .boxed();
    let start =
        |s: f64| stickslip_solver::dynamic::DynamicStart { mode: (), s, state: &[0.5, 1.0] };
    for s in [1e6, 1e12, -1e12] {
        let mut found = Switches::new();
        let options = Options::default();
        let run = stickslip_solver::dynamic::run_dynamic(
            Dop853,
            &system,
            start(s),
            s + 9.0,
            &options,
            &mut found,
        );
        assert_eq!(run.expect("late").outcome, Outcome::ReachedEnd);
        let first = std::f64::consts::PI - 0.5_f64.atan();
        assert_eq!(found.len(), 3);
        assert!((found[0].s - s - first).abs() < 1e-9 + 4.0 * f64::EPSILON * s.abs());
    }
    for end in [1e-300, 1e-20, 1e-8] {
        let run = go(Dopri5, &system, &[0.5, 1.0], end, &Options::default(), &mut ());
        assert_eq!(run.expect("short").s, end);
    }
}

/// The floor changes the state, the apex is only noted; steps grow beyond all flights.
struct Ball([Guard; 2]);

impl DynamicSystem for Ball {
    type Mode = ();

    fn field(&self, (): (), _s: f64, y: &[f64], slope: &mut [f64]) {
        (slope[0], slope[1]) = (y[1], -9.81);
    }
    fn guards(&self, (): ()) -> &[Guard] {
        &self.0
    }
    fn guard_values(&self, (): (), _s: f64, y: &[f64], values: &mut [f64]) {
        values.copy_from_slice(y);
    }
    fn transition(&self, (): (), guard: usize, _s: f64, y: &mut [f64]) {
        if guard == 0 {
            (y[0], y[1]) = (0.0, -0.9 * y[1]);
        }
    }
}

#[test]
fn a_ball_whose_apex_is_noted_comes_to_rest() {
    let ball = Ball([Guard::new(Direction::Below), Guard::new(Direction::Falling)]);
    let rest = (3.0_f64 / 9.81).sqrt() * 1.9 / 0.1;
    let options = Options::default();
    for run in [
        go(Dop853, &ball, &[1.5, 0.0], f64::INFINITY, &options, &mut ()),
        go(Dopri5, &ball, &[1.5, 0.0], f64::INFINITY, &options, &mut ()),
    ] {
        let Outcome::Zeno { accumulation } = run.expect("a ball").outcome else {
            panic!("no accumulation")
        };
        assert!((accumulation / rest - 1.0).abs() < 1e-11, "{accumulation} {rest}");
    }
}

/// Guards that divide by the distance from their place have no value there, and fire.
#[test]
fn a_jump_by_division_fires() {
    fn fires<M: Method>(method: M, place: f64, options: &Options, root: bool) {
        let system = Plain {
            field: |_s, _y: &[f64], f: &mut [f64]| f[0] = 1.0,
            guards: vec![Guard::new(Direction::Rising)],
            values: move |_s, y: &[f64], g: &mut [f64]| {
                let d = y[0] - place;
                g[0] = if root { d / d.abs().sqrt() } else { d / d.abs() };
            },
        };
        let mut switches = Switches::new();
        let end = go(method, &system.boxed(), &[0.0], 1.0, options, &mut switches);
        let end = end.unwrap_or_else(|error| panic!("{place} {options:?}: {error}"));
        assert_eq!(end.outcome, Outcome::ReachedEnd);
        let found = places(&switches);
        assert!(found.len() == 1 && (found[0].0 - place).abs() < 1e-14, "{place} {found:?}");
        assert_eq!(switches[0].jump, !root, "{place} {options:?}");
    }
    for place in [0.3, 0.5, 0.613, 0.999] {
        for step_size in [StepSize::Adaptive, StepSize::Fixed(1.0), StepSize::Fixed(0.1)] {
            let options = Options { step_size, ..Options::default() };
            for root in [false, true] {
                fires(Dop853, place, &options, root);
                fires(Dopri5, place, &options, root);
            }
        }
    }
}
