//! Events at given times: at the start, at the end, periodic ones.

use stickslip_solver::{Guard, Number, Options, Schedule, StepSize, Times};

use super::forms::{Report, all, runs};
use super::{FALLING, OFF, RISING};

/// Doses of 10 every 24 hours, of what decays as y′ = −y. The mode counts the doses.
struct Daily;

impl Report for Daily {
    fn field<T: Number>(&self, _: u8, _: T, y: [T; 4]) -> [T; 4] {
        [-y[0], T::from(0.0), T::from(0.0), T::from(0.0)]
    }
    fn guards(&self, _: u8) -> [Guard; 3] {
        [RISING, OFF, OFF]
    }
    fn values<T: Number>(&self, mode: u8, s: T, _: [T; 4]) -> [T; 3] {
        [s - 24.0 * f64::from(mode), s, s]
    }
    fn act(&self, mode: u8, _: usize, _: f64, y: &mut [f64; 4]) -> u8 {
        y[0] += 10.0;
        mode + 1
    }
}

/// ModelingToolkit.jl 2528, DifferentialEquations.jl 1022, AMICI 55: the dose at the start was
/// lost, and the last one was given twice.
#[test]
fn doses_at_the_start_and_at_the_end_are_given_once() {
    for ended in all(&Daily, (0, 0.0, [10.0]), 72.0) {
        ended.acts_at(0, &[0.0, 24.0, 48.0, 72.0], 1e-13);
        let day = (-24.0_f64).exp();
        ended.is_at(&[((20.0 * day + 10.0) * day + 10.0) * day + 10.0], 1e-11);
        assert_eq!(ended.s, 72.0);
    }
}

/// A slow decay, and a count at a time.
struct Once;

impl Report for Once {
    fn field<T: Number>(&self, _: u8, _: T, y: [T; 4]) -> [T; 4] {
        [-y[0] * 1e-3, T::from(0.0), T::from(0.0), T::from(0.0)]
    }
    fn guards(&self, _: u8) -> [Guard; 3] {
        [FALLING, OFF, OFF]
    }
    fn values<T: Number>(&self, _: u8, s: T, _: [T; 4]) -> [T; 3] {
        [-s + 100.0, s, s]
    }
    fn act(&self, mode: u8, _: usize, _: f64, y: &mut [f64; 4]) -> u8 {
        y[1] += 1.0;
        mode
    }
}

/// DifferentialEquations.jl 215, OpenModelica 3036: an event at the end of a step, or of the run,
/// was lost.
#[test]
fn an_event_at_the_end_of_a_step_or_of_the_run_acts_once() {
    let fixed = |h| Options { step_size: StepSize::Fixed(h), ..Options::default() };
    for options in [Options::default(), fixed(10.0), fixed(100.0), fixed(1.0 / 3.0)] {
        for end in [100.0, 100.5, 200.0] {
            for (name, run) in runs(&Once, (0, 0.0, [1.0, 0.0]), end, &options) {
                let ended = run.unwrap_or_else(|error| panic!("{name}: {error}"));
                ended.acts_at(0, &[100.0], 1e-12);
                ended.is_at(&[(-1e-3 * end).exp(), 1.0], 1e-9);
            }
        }
    }
}

/// y′ = s − ⌊s⌋, with a mode for each unit.
struct Saw;

impl Report for Saw {
    fn field<T: Number>(&self, mode: u8, s: T, _: [T; 4]) -> [T; 4] {
        [s - f64::from(mode), T::from(0.0), T::from(0.0), T::from(0.0)]
    }
    fn guards(&self, _: u8) -> [Guard; 3] {
        [RISING, OFF, OFF]
    }
    fn values<T: Number>(&self, mode: u8, s: T, _: [T; 4]) -> [T; 3] {
        [s - (f64::from(mode) + 1.0), s, s]
    }
    fn act(&self, mode: u8, _: usize, _: f64, _: &mut [f64; 4]) -> u8 {
        mode + 1
    }
}

/// SUNDIALS 722: with a jump at each unit, the last one at the end of the run, it did not arrive.
#[test]
fn a_saw_tooth_is_integrated_to_its_last_tooth() {
    for ended in all(&Saw, (0, 0.0, [0.0]), 10.0) {
        let teeth: Vec<f64> = (1..=10).map(f64::from).collect();
        ended.acts_at(0, &teeth, 1e-14);
        ended.is_at(&[5.0], 1e-13);
    }
}

/// x′ = 10000 from 20 to 20.1, and 0 else.
struct Pulse;

impl Report for Pulse {
    fn field<T: Number>(&self, mode: u8, _: T, _: [T; 4]) -> [T; 4] {
        [if mode == 1 { 1e4 } else { 0.0 }, 0.0, 0.0, 0.0].map(T::from)
    }
    fn guards(&self, mode: u8) -> [Guard; 3] {
        [[RISING, OFF, OFF], [OFF, RISING, OFF], [OFF; 3]][usize::from(mode)]
    }
    fn values<T: Number>(&self, _: u8, s: T, _: [T; 4]) -> [T; 3] {
        [s - 20.0, s - 20.1, s]
    }
    fn act(&self, mode: u8, _: usize, _: f64, _: &mut [f64; 4]) -> u8 {
        mode + 1
    }
}

/// SUNDIALS 881: a short pulse was stepped over.
#[test]
fn a_short_pulse_is_not_stepped_over() {
    for ended in all(&Pulse, (0, 0.0, [0.0]), 1000.0) {
        ended.is_at(&[1000.0], 1e-9);
    }
}

/// y′ = u − y, with u = −3y sampled every tenth: the mode counts the samples.
struct Controller;

impl Report for Controller {
    fn field<T: Number>(&self, _: u8, _: T, y: [T; 4]) -> [T; 4] {
        [y[1] - y[0], T::from(0.0), T::from(0.0), T::from(0.0)]
    }
    fn guards(&self, _: u8) -> [Guard; 3] {
        [RISING, RISING, OFF]
    }
    fn values<T: Number>(&self, mode: u8, s: T, y: [T; 4]) -> [T; 3] {
        [s - 0.1 * f64::from(mode), -y[0] + 0.5, s]
    }
    fn act(&self, mode: u8, guard: usize, _: f64, y: &mut [f64; 4]) -> u8 {
        if guard == 0 {
            y[1] = -3.0 * y[0];
            return mode + 1;
        }
        y[2] += 1.0;
        mode
    }
}

/// ModelingToolkit.jl 3074: a sampled controller beside an event of the state, from start to end.
#[test]
fn a_sampled_controller_keeps_its_samples() {
    let (h, count) = ((-0.1_f64).exp(), 50);
    let (mut y, mut u) = (1.0_f64, 0.0);
    let mut crossing = None;
    for k in 0..count {
        u = -3.0 * y;
        let next = y * h + u * (1.0 - h);
        if next <= 0.5 && crossing.is_none() {
            crossing = Some(0.1 * f64::from(k) + ((y - u) / (0.5 - u)).ln());
        }
        y = next;
    }
    for ended in all(&Controller, (0, 0.0, [1.0, 0.0, 0.0]), 4.99) {
        assert_eq!(ended.events.times(0).len(), usize::try_from(count).unwrap(), "{}", ended.name);
        ended.acts_at(1, &crossing.into_iter().collect::<Vec<_>>(), 1e-11);
        let early = (0.01_f64).exp();
        ended.is_at(&[u + (y - u) * early, u, 1.0], 1e-11);
    }
}

/// A dose table beside a period, and a state that is counted where it falls to 1.
struct Table(Times, f64);

impl Report for Table {
    fn field<T: Number>(&self, _: u8, _: T, _: [T; 4]) -> [T; 4] {
        [T::from(-1.0), T::from(0.0), T::from(0.0), T::from(0.0)]
    }
    fn guards(&self, _: u8) -> [Guard; 3] {
        [Guard::clock(), Guard::clock(), FALLING]
    }
    fn values<T: Number>(&self, _: u8, s: T, y: [T; 4]) -> [T; 3] {
        [s, s, y[0] - 1.0]
    }
    fn act(&self, mode: u8, guard: usize, _: f64, y: &mut [f64; 4]) -> u8 {
        if guard == 0 {
            y[0] += 2.0;
        }
        y[1 + guard] += 1.0;
        mode
    }
    fn schedule(&self, guard: usize) -> Schedule<'_> {
        if guard == 0 { Schedule::at(&self.0) } else { Schedule::every(self.1, 0.0) }
    }
}

/// A dose that comes exactly as a state event is due, and a period that meets both.
#[test]
fn clocks_act_at_their_times_beside_events_of_the_state() {
    let (start, due) = (2.0, 1.0);
    let table = Table(Times::new(vec![0.5, due, 2.0]).unwrap(), 0.25);
    for ended in all(&table, (0, 0.0, [start, 0.0, 0.0, 0.0]), 1.5) {
        ended.acts_at(0, &[0.5, 1.0], 0.0);
        ended.acts_at(1, &[0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5], 0.0);
        ended.acts_at(2, &[], 0.0);
    }
    let table = Table(Times::new(vec![due]).unwrap(), 0.25);
    for ended in all(&table, (0, 0.0, [start, 0.0, 0.0, 0.0]), 1.1) {
        // The state is 1 exactly when the dose comes: its crossing is a fact.
        ended.acts_at(2, &[due], 1e-11);
        assert_eq!(ended.events.guards(), [1, 1, 1, 1, 0, 1, 2], "{}", ended.name);
    }
}
