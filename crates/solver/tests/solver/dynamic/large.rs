//! Many components, and many guards.

use allocation_counter::measure;
use stickslip_solver::dynamic::{DynamicRun, DynamicStart, DynamicSwitch, run_dynamic};
use stickslip_solver::{Direction, Dop853, Dopri5, Guard, Method, Options, StepSize};

use super::rooms::Rooms;
use super::{Plain, go};

/// A chain of `n` masses with fixed ends; the first half of the state are places, the second half
/// velocities.
fn chain(y: &[f64], slope: &mut [f64]) {
    let n = y.len() / 2;
    slope[..n].copy_from_slice(&y[n..]);
    for i in 0..n {
        let left = if i > 0 { y[i - 1] } else { 0.0 };
        let right = if i + 1 < n { y[i + 1] } else { 0.0 };
        slope[n + i] = left - 2.0 * y[i] + right;
    }
}

/// The normal mode `k` of a chain of `n` masses at rest, and its angular frequency.
fn normal_mode(n: usize, k: usize) -> (Vec<f64>, f64) {
    let wave = std::f64::consts::PI * k as f64 / (n + 1) as f64;
    let places = (1..=n).map(|i| (wave * i as f64).sin());
    let state = places.chain(std::iter::repeat_n(0.0, n)).collect();
    (state, 2.0 * (0.5 * wave).sin())
}

type Switches = Vec<DynamicSwitch<()>>;

fn run_chain<M: Method>(
    method: M,
    n: usize,
    end: f64,
    direction: Direction,
) -> (DynamicRun<()>, Switches, f64) {
    // A mode with an antinode near the mass that is watched.
    let (state, omega) = normal_mode(n, n / 2 - 1);
    let watched = (0..n).max_by(|&a, &b| state[a].total_cmp(&state[b])).expect("a mass");
    let system = Plain {
        field: |_s, y: &[f64], f: &mut [f64]| chain(y, f),
        guards: vec![Guard::new(direction)],
        values: |_s, y: &[f64], v: &mut [f64]| v[0] = y[watched],
    }
    .boxed();
    let mut switches = Vec::new();
    let options = Options::with_tolerance(1e-9);
    let run = go(method, &system, &state, end, &options, &mut switches).expect("a chain");
    (run, switches, omega)
}

#[test]
fn twenty_thousand_components_run_in_a_small_stack() {
    let run = || {
        for either in [true, false] {
            let n = 10_000;
            let end = 10.0;
            let (run, switches, omega) = if either {
                run_chain(Dop853, n, end, Direction::Either)
            } else {
                run_chain(Dopri5, n, end, Direction::Either)
            };
            assert_eq!(run.state.len(), 2 * n);
            let quarter = std::f64::consts::FRAC_PI_2 / omega;
            let expected = (0..100).filter(|k| quarter * f64::from(2 * k + 1) <= end).count();
            assert_eq!(switches.len(), expected);
            for (k, switch) in switches.iter().enumerate() {
                let place = quarter * (2 * k + 1) as f64;
                assert!((switch.s - place).abs() < 1e-8, "{} {place}", switch.s);
            }
            let (state, _) = normal_mode(n, n / 2 - 1);
            let error = (0..n)
                .map(|i| (run.state[i] - state[i] * (omega * end).cos()).abs())
                .fold(0.0, f64::max);
            assert!(error < 1e-7, "{error}");
        }
    };
    let small = std::thread::Builder::new().stack_size(256 * 1024).spawn(run).expect("a thread");
    small.join().expect("a run");
}

/// Allocations of a run without event and with one guard, in so many steps.
fn allocations<M: Method>(method: M, steps: usize) -> u64 {
    let system = Plain {
        field: |_s, y: &[f64], f: &mut [f64]| chain(y, f),
        // One guard far from zero, one that oscillates around zero without falling, one that nears
        // zero so that it is isolated again and again.
        guards: vec![Guard::new(Direction::Below), Guard::OFF, Guard::new(Direction::Falling)],
        values: |s: f64, y: &[f64], v: &mut [f64]| {
            v[0] = 2.0 + y[0];
            v[1] = y[0];
            v[2] = 1e-3 + (s * 7.0).sin().powi(2);
        },
    }
    .boxed();
    let (state, _) = normal_mode(50, 3);
    let options = Options { step_size: StepSize::Fixed(0.1), ..Options::default() };
    let mut isolations = 0;
    let counted = measure(|| {
        let end = 0.1 * steps as f64;
        let run = go(method, &system, &state, end, &options, &mut ()).expect("a chain");
        isolations = run.statistics.isolations;
    });
    assert!(isolations > 0);
    counted.count_total
}

#[test]
fn steps_without_event_allocate_nothing() {
    assert_eq!(allocations(Dop853, 20), allocations(Dop853, 2000));
    assert_eq!(allocations(Dopri5, 20), allocations(Dopri5, 2000));
    assert!(allocations(Dop853, 20) < 100);
}

/// All guards are evaluated and bounded at once, so that the work of an event is linear in their
/// number. It was quadratic: each guard bounded all.
#[test]
fn the_evaluations_of_an_event_do_not_grow_with_the_number_of_guards() {
    for n in [4, 40, 200] {
        let (rooms, state) = (Rooms::new(n), Rooms::cold(n));
        let start = DynamicStart { mode: (), s: 0.0, state: &state };
        let mut switches: Vec<DynamicSwitch<()>> = Vec::new();
        let options = Options { max_switches: 10_000, ..Options::with_tolerance(1e-10) };
        let run = run_dynamic(Dop853, &rooms, start, 3.0, &options, &mut switches).unwrap();
        let times = (0..n).flat_map(|room| {
            let rate = 1.0 + room as f64 / n as f64;
            let switches =
                (0..20).map(move |k| (3.0_f64.ln() + 2.0_f64.ln() * f64::from(k)) / rate);
            switches.filter(|time| *time < 3.0)
        });
        let mut times: Vec<_> = times.collect();
        times.sort_by(f64::total_cmp);
        assert_eq!(switches.len(), times.len());
        for (switch, time) in switches.iter().zip(times) {
            assert!((switch.s - time).abs() < 1e-9, "{} {time}", switch.s);
        }
        let work = run.statistics;
        let each = |count: usize| count as f64 / switches.len() as f64;
        let (field, guards, bounds) = (each(work.field), each(work.guards), each(work.enclosures));
        assert!(field < 40.0 && guards < 40.0 && bounds < 4.0, "{n}: {field} {guards} {bounds}");
    }
}
