//! Times and errors of two systems of one's own, for comparison with Python.
//!
//! A ball that bounces 15 times, and a mass on a belt with friction for 15 periods, 31 switches:
//! the systems of `python/benches/own_systems.py`, with its tolerances and pair. A time is the
//! least of 2000; an error is the largest one of the times of all switches.
//!
//! `cargo run --release -p validation --example own_systems`

use std::error::Error;
use std::time::Instant;

use stickslip::solver::{
    Direction, Dop853, Guard, HybridSystem, Observer, Options, Start, State, SwitchEvent, run,
};

/// A ball that keeps half of its velocity at each bounce.
struct Ball;

impl HybridSystem<2, 1> for Ball {
    type Mode = ();

    fn field(&self, (): (), _time: f64, y: &State<2>) -> State<2> {
        State::from([y[1], -9.81])
    }
    fn guards(&self, (): ()) -> [Guard; 1] {
        [Guard::new(Direction::Below).smooth()]
    }
    fn guard_values(&self, (): (), _time: f64, y: &State<2>) -> [f64; 1] {
        [y[0]]
    }
    fn transition(&self, (): (), _: usize, _time: f64, y: &State<2>) -> ((), State<2>) {
        ((), State::from([0.0, -0.5 * y[1]]))
    }
}

/// A mass on a belt, held by a spring, with static friction 1 and kinetic friction 0.6.
struct Belt;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Contact {
    Stick,
    Slip,
}

impl HybridSystem<2, 1> for Belt {
    type Mode = Contact;

    fn field(&self, contact: Contact, _time: f64, y: &State<2>) -> State<2> {
        match contact {
            Contact::Stick => State::from([y[1], 0.0]),
            Contact::Slip => State::from([y[1], 0.6 - y[0]]),
        }
    }
    fn guards(&self, _: Contact) -> [Guard; 1] {
        [Guard::new(Direction::Below).smooth()]
    }
    fn guard_values(&self, contact: Contact, _time: f64, y: &State<2>) -> [f64; 1] {
        match contact {
            Contact::Stick => [1.0 - y[0]],
            Contact::Slip => [0.5 - y[1]],
        }
    }
    fn transition(
        &self,
        contact: Contact,
        _: usize,
        _time: f64,
        y: &State<2>,
    ) -> (Contact, State<2>) {
        let next = match contact {
            Contact::Stick => Contact::Slip,
            Contact::Slip => Contact::Stick,
        };
        (next, State::from([y[0], 0.5]))
    }
}

/// The times of switches.
struct Times(Vec<f64>);

impl<Mode> Observer<Mode, 2> for Times {
    fn on_switch(&mut self, event: &SwitchEvent<Mode, 2>) {
        self.0.push(event.s);
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let bounces: Vec<f64> = (0..15).map(|k| 3.0 - 2.0 * 0.5_f64.powi(k)).collect();
    let ball = Start { mode: (), s: 0.0, state: State::from([4.905, 0.0]) };
    report("ball", &Ball, ball, 2.9999, &bounces)?;

    let slip = std::f64::consts::TAU - 2.0 * 0.8_f64.atan();
    let period = slip + 1.6;
    let mut switches: Vec<f64> = (0..16).map(|k| 2.0 + period * f64::from(k)).collect();
    switches.extend((0..15).map(|k| 2.0 + slip + period * f64::from(k)));
    switches.sort_by(f64::total_cmp);
    let belt = Start { mode: Contact::Stick, s: 0.0, state: State::from([0.0, 0.5]) };
    report("belt", &Belt, belt, 2.0 + 15.0 * period + 0.1, &switches)
}

/// Runs a system 2000 times, and prints the least time and the largest error.
fn report<S: HybridSystem<2, 1>>(
    name: &str,
    system: &S,
    start: Start<S::Mode, 2>,
    end: f64,
    expected: &[f64],
) -> Result<(), Box<dyn Error>> {
    let options = Options { rtol: 1e-10, atol: 1e-12, ..Options::default() };
    let mut least = f64::INFINITY;
    let mut times = Times(Vec::new());
    for _ in 0..2000 {
        times.0.clear();
        let begun = Instant::now();
        let _run = run(Dop853, system, start, end, &options, &mut times)?.finished()?;
        least = least.min(begun.elapsed().as_secs_f64());
    }
    let errors = times.0.iter().zip(expected).map(|(found, exact)| (found - exact).abs());
    let largest = errors.fold(0.0, f64::max);
    println!(
        "{name}: {:.1} µs, {} switches, largest error {largest:.1e}",
        1e6 * least,
        times.0.len()
    );
    if times.0.len() == expected.len() { Ok(()) } else { Err("a switch is missing".into()) }
}
