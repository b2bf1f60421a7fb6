//! What surrounds a run, and the systems with which it is tested.

mod after_switches;
mod answers;
mod backwards;
mod closures;
mod ends;
mod goes_on;
mod observers;
mod pairs;
mod samples;
mod steps;
mod unlocated;
mod weighted;

use std::f64::consts::PI;

use stickslip_solver::{
    Closures, Direction, Grazing, Guard, HybridSystem, Number, Observer, Options, Outcome,
    ReadableSystem, Run, RunError, Start, State, StepSize, SwitchEvent, hybrid::Pole,
};

/// A start in the only mode.
pub fn at<const N: usize>(s: f64, state: [f64; N]) -> Start<(), N> {
    Start { mode: (), s, state: State::from(state) }
}

pub fn fixed(h: f64) -> Options {
    Options { step_size: StepSize::Fixed(h), ..Options::default() }
}

/// The switches and touches of a run, and its end.
#[derive(Debug, Default)]
pub struct Log<const N: usize> {
    pub switches: Vec<SwitchEvent<(), N>>,
    pub grazings: Vec<f64>,
    pub poles: Vec<f64>,
    pub ends: Vec<f64>,
    /// The run stops after so many switches, unless this is 0.
    pub stop_after: usize,
}

impl<const N: usize> Log<N> {
    pub fn places(&self) -> Vec<f64> {
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

    fn forget(&mut self, switches: usize) {
        self.switches.truncate(self.switches.len() - switches);
    }

    fn stops(&self, _: f64) -> bool {
        self.stop_after > 0 && self.switches.len() >= self.stop_after
    }

    fn on_end(&mut self, (): (), s: f64, _state: &State<N>) {
        self.ends.push(s);
    }
}

/// A ball that keeps nine tenths of its speed.
pub fn ball() -> impl HybridSystem<2, 1, Mode = ()> {
    Closures::new(|_s, y: &State<2>| State::from([y[1], -9.81]))
        .guards([Guard::new(Direction::Below)], |_s, y| [y[0]])
        .transition(|_guard, _s, y| State::from([0.0, -0.9 * y[1]]))
}

/// The same ball, if it starts from the ground.
pub fn thrown() -> impl HybridSystem<2, 1, Mode = ()> {
    Closures::new(|_s, y: &State<2>| State::from([y[1], -9.81]))
        .guards([Guard::new(Direction::Below).from_zero(1)], |_s, y| [y[0]])
        .transition(|_guard, _s, y| State::from([0.0, -0.9 * y[1]]))
}

/// The place where the ball that falls from 1 bounces, counted from 0.
pub fn bounce(n: i32) -> f64 {
    let flights = (1.0 - 0.9_f64.powi(n)) / 0.1 * 0.9;
    (2.0_f64 / 9.81).sqrt() * (1.0 + 2.0 * flights)
}

/// y' = 1, so that s and y are the same, with guards that change nothing.
pub fn line<const G: usize>(
    guards: [Guard; G],
    values: impl Fn(f64) -> [f64; G],
) -> impl HybridSystem<1, G, Mode = ()> {
    Closures::new(|_s, _y: &State<1>| State::from([1.0])).guards(guards, move |s, _y| values(s))
}

/// Checks that a run reaches the end of its span.
pub fn reaches_end<Mode, const N: usize>(ran: Result<Run<Mode, N>, RunError>) {
    assert_eq!(ran.map(|run| run.outcome), Ok(Outcome::ReachedEnd));
}

pub fn close(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= tolerance, "{found} {expected}");
    }
}

/// The start of a line.
pub fn start_of_line() -> Start<(), 1> {
    at(0.0, [0.0])
}

/// y' = 1 with a wave that an enclosure resolves and samples do not.
pub struct Wave;

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
