//! Times of runs with and without switches, as JSON for `tests/battery/speed.py`.
//!
//! Each problem is run at three tolerances, with both methods, and in up to three readings: as a
//! readable system, as the same with its guards declared to be smooth, and as a black box. The time
//! is that of the fastest of many runs in one thread.
//!
//! `cargo run --release -p validation --example speed -- kepler-10` runs only the problems whose
//! name begins like this.

use std::f64::consts::TAU;
use std::time::Instant;

use serde_json::{Value, json};
use stickslip_solver::{
    Direction, Dop853, Dopri5, Guard, HybridSystem, Method, Number, Observer, Options,
    ReadableSystem, Run, Start, State, SwitchEvent, run,
};

/// The seconds for which each run is repeated.
const REPEATED: f64 = 0.15;

/// A satellite on Arenstorf's orbit around earth and moon, without guards.
struct Arenstorf;

impl ReadableSystem<4, 0> for Arenstorf {
    type Mode = ();

    fn field<T: Number>(&self, (): (), _time: T, y: &[T; 4]) -> [T; 4] {
        const MOON: f64 = 0.012277471;
        const EARTH: f64 = 1.0 - MOON;
        let cube = |x: T| {
            let square = x * x + y[1] * y[1];
            square * square.sqrt()
        };
        let (to_earth, to_moon) = (y[0] + MOON, y[0] - EARTH);
        let (earth, moon) = (T::from(EARTH) / cube(to_earth), T::from(MOON) / cube(to_moon));
        [
            y[2],
            y[3],
            y[0] + y[3] * 2.0 - earth * to_earth - moon * to_moon,
            y[1] - y[2] * 2.0 - (earth + moon) * y[1],
        ]
    }
    fn guards(&self, (): ()) -> [Guard; 0] {
        []
    }
    fn guard_values<T: Number>(&self, (): (), _time: T, _y: &[T; 4]) -> [T; 0] {
        []
    }
}

/// A planet, whose apsides are noted.
struct Kepler;

impl ReadableSystem<4, 1> for Kepler {
    type Mode = ();

    fn field<T: Number>(&self, (): (), _time: T, y: &[T; 4]) -> [T; 4] {
        let square = y[0] * y[0] + y[1] * y[1];
        let pull = T::from(-1.0) / (square * square.sqrt());
        [y[2], y[3], y[0] * pull, y[1] * pull]
    }
    fn guards(&self, (): ()) -> [Guard; 1] {
        [Guard::new(Direction::Either)]
    }
    fn guard_values<T: Number>(&self, (): (), _time: T, y: &[T; 4]) -> [T; 1] {
        [y[0] * y[2] + y[1] * y[3]]
    }
}

/// A ball that bounces on a table.
struct Ball;

impl ReadableSystem<2, 1> for Ball {
    type Mode = ();

    fn field<T: Number>(&self, (): (), _time: T, y: &[T; 2]) -> [T; 2] {
        [y[1], T::from(-9.81)]
    }
    fn guards(&self, (): ()) -> [Guard; 1] {
        [Guard::new(Direction::Below)]
    }
    fn guard_values<T: Number>(&self, (): (), _time: T, y: &[T; 2]) -> [T; 1] {
        [y[0]]
    }
    fn transition(&self, (): (), _guard: usize, _time: f64, y: &State<2>) -> ((), State<2>) {
        ((), State::from([0.0, -0.9 * y[1]]))
    }
}

/// A ball that bounces on a table that moves up and down.
struct Table;

/// The height of the table.
fn table<T: Number>(time: T) -> T {
    (time * 2.0).sin() * 0.1
}

impl ReadableSystem<2, 1> for Table {
    type Mode = ();

    fn field<T: Number>(&self, (): (), _time: T, y: &[T; 2]) -> [T; 2] {
        [y[1], T::from(-9.81)]
    }
    fn guards(&self, (): ()) -> [Guard; 1] {
        [Guard::new(Direction::Below)]
    }
    fn guard_values<T: Number>(&self, (): (), time: T, y: &[T; 2]) -> [T; 1] {
        [y[0] - table(time)]
    }
    fn transition(&self, (): (), _guard: usize, time: f64, y: &State<2>) -> ((), State<2>) {
        let velocity = 0.2 * (2.0 * time).cos();
        ((), State::from([table(time), velocity - 0.9 * (y[1] - velocity)]))
    }
}

/// A mass on a spring, on a belt on which it sticks and slips.
struct Belt;

impl ReadableSystem<2, 1> for Belt {
    /// Whether the mass sticks.
    type Mode = bool;

    fn field<T: Number>(&self, sticks: bool, _time: T, y: &[T; 2]) -> [T; 2] {
        [y[1], if sticks { T::from(0.0) } else { -y[0] + 0.6 }]
    }
    fn guards(&self, _sticks: bool) -> [Guard; 1] {
        [Guard::new(Direction::Below)]
    }
    fn guard_values<T: Number>(&self, sticks: bool, _time: T, y: &[T; 2]) -> [T; 1] {
        [if sticks { -y[0] + 1.0 } else { -y[1] + 0.5 }]
    }
    fn transition(&self, sticks: bool, _: usize, _time: f64, y: &State<2>) -> (bool, State<2>) {
        (!sticks, State::from([y[0], 0.5]))
    }
}

/// How the solver may read a system.
#[derive(Clone, Copy)]
enum Reading {
    /// Its guards are bounded.
    Readable,
    /// Its guards are bounded where six values do not tell enough.
    Smooth,
    /// Its guards are sampled.
    BlackBox,
}

/// A readable system with guards that are declared to be smooth.
struct Smooth<'a, S>(&'a S);

impl<S: ReadableSystem<N, G>, const N: usize, const G: usize> ReadableSystem<N, G>
    for Smooth<'_, S>
{
    type Mode = S::Mode;

    fn field<T: Number>(&self, mode: S::Mode, s: T, y: &[T; N]) -> [T; N] {
        ReadableSystem::field(self.0, mode, s, y)
    }
    fn guards(&self, mode: S::Mode) -> [Guard; G] {
        ReadableSystem::guards(self.0, mode).map(Guard::smooth)
    }
    fn guard_values<T: Number>(&self, mode: S::Mode, s: T, y: &[T; N]) -> [T; G] {
        ReadableSystem::guard_values(self.0, mode, s, y)
    }
    fn transition(&self, mode: S::Mode, guard: usize, s: f64, y: &State<N>) -> (S::Mode, State<N>) {
        ReadableSystem::transition(self.0, mode, guard, s, y)
    }
}

/// A readable system whose formulas are hidden from the solver.
struct BlackBox<'a, S>(&'a S);

impl<S: ReadableSystem<N, G>, const N: usize, const G: usize> HybridSystem<N, G>
    for BlackBox<'_, S>
{
    type Mode = S::Mode;

    fn field(&self, mode: S::Mode, s: f64, y: &State<N>) -> State<N> {
        HybridSystem::field(self.0, mode, s, y)
    }
    fn guards(&self, mode: S::Mode) -> [Guard; G] {
        HybridSystem::guards(self.0, mode)
    }
    fn guard_values(&self, mode: S::Mode, s: f64, y: &State<N>) -> [f64; G] {
        HybridSystem::guard_values(self.0, mode, s, y)
    }
    fn transition(&self, mode: S::Mode, guard: usize, s: f64, y: &State<N>) -> (S::Mode, State<N>) {
        HybridSystem::transition(self.0, mode, guard, s, y)
    }
}

/// Keeps the places of events.
#[derive(Default)]
struct Places(Vec<f64>);

impl<Mode, const N: usize> Observer<Mode, N> for Places {
    fn on_switch(&mut self, event: &SwitchEvent<Mode, N>) {
        self.0.push(event.s);
    }
}

/// Runs a system again and again. Returns the shortest time, the last run and its events.
fn fastest<M: Method, S: HybridSystem<N, G>, const N: usize, const G: usize>(
    method: M,
    system: &S,
    (start, end): (Start<S::Mode, N>, f64),
    tolerance: f64,
) -> (f64, Run<S::Mode, N>, Vec<f64>) {
    let options = Options::with_tolerance(tolerance);
    let mut places = Places::default();
    let (mut shortest, began) = (f64::INFINITY, Instant::now());
    loop {
        places.0.clear();
        let now = Instant::now();
        let done = run(method, system, start, end, &options, &mut places);
        shortest = shortest.min(now.elapsed().as_secs_f64());
        let done = done.expect("a run");
        if began.elapsed().as_secs_f64() > REPEATED {
            return (shortest, done, places.0);
        }
    }
}

/// Runs a problem at all tolerances, with both methods.
fn measure<S: ReadableSystem<N, G>, const N: usize, const G: usize>(
    name: &str,
    system: &S,
    readings: &[Reading],
    (mode, state, end): (S::Mode, [f64; N], f64),
    results: &mut Vec<Value>,
) {
    if std::env::args().nth(1).is_some_and(|only| !name.starts_with(&only)) {
        return;
    }
    let start = Start { mode, s: 0.0, state: State::from(state) };
    for tolerance in [1e-6, 1e-9, 1e-12] {
        for &reading in readings {
            for method in ["dop853", "dopri5"] {
                let (seconds, run, events) = match (reading, method) {
                    (Reading::Readable, "dop853") => {
                        fastest(Dop853, system, (start, end), tolerance)
                    }
                    (Reading::Readable, _) => fastest(Dopri5, system, (start, end), tolerance),
                    (Reading::Smooth, "dop853") => {
                        fastest(Dop853, &Smooth(system), (start, end), tolerance)
                    }
                    (Reading::Smooth, _) => {
                        fastest(Dopri5, &Smooth(system), (start, end), tolerance)
                    }
                    (Reading::BlackBox, "dop853") => {
                        fastest(Dop853, &BlackBox(system), (start, end), tolerance)
                    }
                    (Reading::BlackBox, _) => {
                        fastest(Dopri5, &BlackBox(system), (start, end), tolerance)
                    }
                };
                let reading = match reading {
                    Reading::Readable => "readable",
                    Reading::Smooth => "smooth",
                    Reading::BlackBox => "black box",
                };
                let work = run.statistics;
                results.push(json!({
                    "problem": name,
                    "tolerance": tolerance,
                    "program": format!("{method}, {reading}"),
                    "seconds": seconds,
                    "end": run.state.as_slice(),
                    "events": events,
                    "steps": work.accepted + work.rejected,
                    "field": work.field,
                    "guards": work.guards,
                    "enclosures": work.enclosures,
                    "isolations": work.isolations,
                    "resteps": work.resteps,
                }));
            }
        }
    }
}

fn main() {
    use Reading::{BlackBox, Readable, Smooth};
    let mut results = Vec::new();
    let orbit = [0.994, 0.0, 0.0, -2.00158510637908252240537862224];
    let period = 17.0652165601579625588917206249;
    measure("arenstorf", &Arenstorf, &[Readable], ((), orbit, period), &mut results);
    // The eccentricity is 1/2, and the eccentric anomaly 1.
    let ((sine, cosine), minor) = (1.0_f64.sin_cos(), 0.75_f64.sqrt());
    let rate = 1.0 / (1.0 - 0.5 * cosine);
    let planet = [cosine - 0.5, minor * sine, -sine * rate, minor * cosine * rate];
    for turns in [10.0, 100.0] {
        let (name, readings) = (format!("kepler-{turns}"), [Readable, Smooth, BlackBox]);
        measure(&name, &Kepler, &readings, ((), planet, turns * TAU), &mut results);
    }
    let all = [Readable, Smooth, BlackBox];
    measure("ball", &Ball, &all, ((), [1.5, 0.0], 10.0), &mut results);
    measure("table", &Table, &[Readable, BlackBox], ((), [1.5, 0.0], 8.0), &mut results);
    let period = TAU - 2.0 * 0.8_f64.atan() + 1.6;
    measure("belt", &Belt, &all, (true, [0.0, 0.5], 3.0 + 50.0 * period), &mut results);
    println!("{}", serde_json::to_string_pretty(&results).expect("numbers"));
}
