//! Systems with many guards and components: work and time of an event.
//!
//! `cargo run --release -p validation --example many_guards` runs balls that bounce on one floor,
//! and thermostats that switch their heaters, as formulas and as black boxes, with dop853 at rtol =
//! 1e-10 and atol = 1e-12. For each it prints the number of events, the right-hand sides and the
//! evaluations of all guards for an event, and the time.

#[path = "../../solver/tests/solver/dynamic/rooms.rs"]
mod rooms;

use std::time::Instant;

use stickslip::solver::dynamic::{
    DynamicStart, DynamicSwitch, DynamicSystem, ReadableDynamic, run_dynamic,
};
use stickslip::solver::{Direction, Dop853, Guard, Number, Options};

use rooms::Rooms;

/// Balls that keep 0.8 of their velocity where they bounce; heights and velocities in turn.
struct Balls {
    guards: Vec<Guard>,
    reads: Vec<usize>,
}

impl ReadableDynamic for Balls {
    type Mode = ();
    fn field<T: Number>(&self, (): (), _: T, y: &[T], slope: &mut [T]) {
        for (slope, y) in slope.chunks_exact_mut(2).zip(y.chunks_exact(2)) {
            (slope[0], slope[1]) = (y[1], T::from(-9.81));
        }
    }
    fn guards(&self, (): ()) -> &[Guard] {
        &self.guards
    }
    fn reads(&self, (): ()) -> &[usize] {
        &self.reads
    }
    fn guard_values<T: Number>(&self, (): (), _: T, y: &[T], values: &mut [T]) {
        for (value, y) in values.iter_mut().zip(y.chunks_exact(2)) {
            *value = y[0];
        }
    }
    fn transition(&self, (): (), guard: usize, _: f64, y: &mut [f64]) {
        (y[2 * guard], y[2 * guard + 1]) = (0.0, -0.8 * y[2 * guard + 1]);
    }
}

/// A system whose formulas are not read.
struct BlackBox<S>(S);

impl<S: ReadableDynamic> DynamicSystem for BlackBox<S> {
    type Mode = S::Mode;
    fn field(&self, mode: S::Mode, s: f64, y: &[f64], slope: &mut [f64]) {
        ReadableDynamic::field(&self.0, mode, s, y, slope);
    }
    fn guards(&self, mode: S::Mode) -> &[Guard] {
        ReadableDynamic::guards(&self.0, mode)
    }
    fn guard_values(&self, mode: S::Mode, s: f64, y: &[f64], values: &mut [f64]) {
        ReadableDynamic::guard_values(&self.0, mode, s, y, values);
    }
    fn transition(&self, mode: S::Mode, guard: usize, s: f64, y: &mut [f64]) -> S::Mode {
        ReadableDynamic::transition(&self.0, mode, guard, s, y)
    }
}

fn measure<S: DynamicSystem<Mode = ()>>(name: &str, system: &S, state: &[f64], end: f64) {
    let options = Options { rtol: 1e-10, atol: 1e-12, ..Options::default() };
    let options = Options { max_switches: 1_000_000, max_steps: 10_000_000, ..options };
    let start = DynamicStart { mode: (), s: 0.0, state };
    let mut switches: Vec<DynamicSwitch<()>> = Vec::new();
    let begun = Instant::now();
    let run = run_dynamic(Dop853, system, start, end, &options, &mut switches).expect("a run");
    let (took, work) = (begun.elapsed().as_secs_f64(), run.statistics);
    let each = |count: usize| count as f64 / switches.len() as f64;
    println!(
        "| {name} | {} | {:.1} | {:.1} | {:.1} | {:.3} |",
        switches.len(),
        each(work.field),
        each(work.guards),
        each(work.enclosures),
        1e3 * took
    );
}

fn balls(n: usize) {
    let state: Vec<_> = (0..n).flat_map(|i| [1.0 + i as f64 / n as f64, 0.0]).collect();
    let guards = || vec![Guard::new(Direction::Falling); n];
    let balls = || Balls { guards: guards(), reads: (0..n).map(|i| 2 * i).collect() };
    measure(&format!("{n} balls"), &balls(), &state, 2.0);
    measure(&format!("{n} balls, black box"), &BlackBox(balls()), &state, 2.0);
}

fn rooms(n: usize, end: f64) {
    let (rooms, state) = (Rooms::new(n), Rooms::cold(n));
    measure(&format!("{n} thermostats"), &rooms, &state, end);
    measure(&format!("{n} thermostats, black box"), &BlackBox(rooms), &state, end);
}

fn main() {
    println!("| | events | right-hand sides | guards | bounds | time in ms |");
    println!("|---|---|---|---|---|---|");
    for n in [1, 10, 100, 200, 1000] {
        balls(n);
    }
    rooms(50, 10.0);
    for n in [1, 2, 5, 20, 100, 250, 500] {
        rooms(n, 4.0);
    }
}
