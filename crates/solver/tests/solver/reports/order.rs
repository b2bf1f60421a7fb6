//! Several events at one instant, or nearly.

use std::f64::consts::{LN_2, PI, TAU};

use stickslip_solver::{Guard, Number, Outcome};

use super::forms::{Report, all};
use super::{BELOW, EITHER, FALLING, OFF, RISING, last};

/// Two guards of the time, and what they do: each adds to a component of its own.
struct Doses(f64, f64);

impl Report for Doses {
    fn field<T: Number>(&self, _: u8, _: T, y: [T; 4]) -> [T; 4] {
        let [depot, central, ..] = y;
        [-depot, depot - central * 0.5, T::from(0.0), T::from(0.0)]
    }
    fn guards(&self, _: u8) -> [Guard; 3] {
        [RISING, RISING, OFF]
    }
    fn values<T: Number>(&self, _: u8, s: T, _: [T; 4]) -> [T; 3] {
        [s - self.0, s - self.1, s]
    }
    fn act(&self, mode: u8, guard: usize, _: f64, y: &mut [f64; 4]) -> u8 {
        y[guard] += [100.0, 50.0][guard];
        mode
    }
}

/// rxode2 1218, RxODE 346: two doses at one time failed, and 1e-8 apart they did not.
#[test]
fn two_doses_at_one_time_are_both_given() {
    for delay in [0.0, 1e-13, 1e-12, 1e-10, 1e-8] {
        for (first, second) in [(1.0, 1.0 + delay), (1.0 + delay, 1.0)] {
            for ended in all(&Doses(first, second), (0, 0.0, [0.0, 0.0]), 4.0) {
                let name = &ended.name;
                let order = if first <= second { [0, 1] } else { [1, 0] };
                assert_eq!(ended.events.guards(), order, "{name} {first} {second}");
                let [depot, central] = [(1.0 - 4.0_f64).exp(), (0.5 - 2.0_f64).exp()];
                ended.is_at(&[100.0 * depot, 50.0 * central + 200.0 * (central - depot)], 1e-6);
            }
        }
    }
}

/// y′ = y, and three guards y − 20, each of which counts.
struct Threefold;

impl Report for Threefold {
    fn field<T: Number>(&self, _: u8, _: T, y: [T; 4]) -> [T; 4] {
        [y[0], T::from(0.0), T::from(0.0), T::from(0.0)]
    }
    fn guards(&self, _: u8) -> [Guard; 3] {
        [EITHER, RISING, EITHER]
    }
    fn values<T: Number>(&self, _: u8, _: T, y: [T; 4]) -> [T; 3] {
        [y[0] - 20.0, y[0] * 1e6 - 2e7, (y[0] / 20.0).ln()]
    }
    fn act(&self, mode: u8, guard: usize, _: f64, y: &mut [f64; 4]) -> u8 {
        y[1 + guard] += 1.0;
        mode
    }
}

/// DifferentialEquations.jl 516: of equal conditions only the first two acted, one of them twice.
#[test]
fn each_of_three_equal_guards_acts_once() {
    for ended in all(&Threefold, (0, 0.0, [10.0]), 1.0) {
        assert_eq!(ended.events.guards(), [0, 1, 2], "{}", ended.name);
        ended.acts_at(0, &[LN_2], 1e-11);
        ended.is_at(&[10.0 * 1.0_f64.exp(), 1.0, 1.0, 1.0], 1e-9);
    }
}

/// u′ = u − sin s, where two equal guards add 2 each.
struct Duplicates;

impl Report for Duplicates {
    fn field<T: Number>(&self, _: u8, s: T, y: [T; 4]) -> [T; 4] {
        [y[0] - s.sin(), T::from(0.0), T::from(0.0), T::from(0.0)]
    }
    fn guards(&self, _: u8) -> [Guard; 3] {
        [RISING, RISING, OFF]
    }
    fn values<T: Number>(&self, _: u8, s: T, _: [T; 4]) -> [T; 3] {
        [s - 2.95, s - 2.95, s]
    }
    fn act(&self, mode: u8, _: usize, _: f64, y: &mut [f64; 4]) -> u8 {
        y[0] += 2.0;
        mode
    }
}

/// DiffEqBase.jl 889: equal events that change the state went on for ever.
#[test]
fn equal_guards_that_change_the_state_come_to_an_end() {
    for ended in all(&Duplicates, (0, 0.0, [1.0]), 5.0) {
        assert_eq!(ended.events.guards(), [0, 1], "{}", ended.name);
        let end = 0.5 * (5.0_f64.exp() + 5.0_f64.sin() + 5.0_f64.cos()) + 4.0 * 2.05_f64.exp();
        ended.is_at(&[end], 1e-9);
    }
}

/// Two equal oscillations, observed where they rise through a level.
struct Oscillations(f64);

impl Report for Oscillations {
    fn field<T: Number>(&self, _: u8, s: T, _: [T; 4]) -> [T; 4] {
        [s.cos(), (s + self.0).cos(), T::from(0.0), T::from(0.0)]
    }
    fn guards(&self, _: u8) -> [Guard; 3] {
        [RISING, RISING, OFF]
    }
    fn values<T: Number>(&self, _: u8, _: T, y: [T; 4]) -> [T; 3] {
        [y[0] - 0.5, y[1] - 0.5, y[0]]
    }
}

/// DiffEqBase.jl 837: two oscillations with equal initial values never came to an end.
#[test]
fn equal_oscillations_are_both_observed() {
    for phase in [0.0, 1e-12, 0.3] {
        let times: Vec<f64> = (0..5).map(|k| PI / 6.0 + TAU * f64::from(k)).collect();
        let earlier: Vec<f64> = times.iter().map(|time| time - phase).collect();
        for ended in all(&Oscillations(phase), (0, 0.0, [0.0, phase.sin()]), 30.0) {
            ended.acts_at(0, &times, 1e-10);
            ended.acts_at(1, &earlier, 1e-10);
        }
    }
}

/// A component that is the time, and the time itself, reach 1000 together.
struct Triggers;

impl Report for Triggers {
    fn field<T: Number>(&self, _: u8, _: T, _: [T; 4]) -> [T; 4] {
        [1.0, 1.0, 1.0, 0.0].map(T::from)
    }
    fn guards(&self, _: u8) -> [Guard; 3] {
        [last(RISING), RISING, OFF]
    }
    fn values<T: Number>(&self, _: u8, s: T, y: [T; 4]) -> [T; 3] {
        [y[2] - 1000.0, s - 1000.0, s]
    }
    fn act(&self, mode: u8, guard: usize, _: f64, y: &mut [f64; 4]) -> u8 {
        y[guard] += 10.0;
        // The order shows in the last component.
        y[3] = 2.0 * y[3] + (guard + 1) as f64;
        mode
    }
}

/// AMICI 2804: a root after reinitialization, of events with different triggers and priorities.
#[test]
fn triggers_by_state_and_by_time_act_in_the_order_of_priority() {
    for ended in all(&Triggers, (0, 0.0, [1.0, 2.0, 0.0]), 1002.0) {
        assert_eq!(ended.events.guards(), [1, 0], "{}", ended.name);
        ended.is_at(&[1013.0, 1014.0, 1002.0, 5.0], 1e-9);
    }
}

/// Two counters of the mode's time: x takes up y after y has been counted up.
struct Counters;

impl Report for Counters {
    fn field<T: Number>(&self, _: u8, _: T, _: [T; 4]) -> [T; 4] {
        [0.0; 4].map(T::from)
    }
    fn guards(&self, _: u8) -> [Guard; 3] {
        [last(RISING), RISING, OFF]
    }
    fn values<T: Number>(&self, mode: u8, s: T, _: [T; 4]) -> [T; 3] {
        let time = s - f64::from(mode);
        [time, time, s]
    }
    fn act(&self, mode: u8, guard: usize, _: f64, y: &mut [f64; 4]) -> u8 {
        if guard == 0 {
            y[0] += y[1];
            return mode + 1;
        }
        y[1] += 1.0;
        mode
    }
}

/// ModelingToolkit.jl 2745: of two updates at one time, that on which the other depends comes
/// first.
#[test]
fn updates_that_depend_on_each_other_have_an_order() {
    for ended in all(&Counters, (1, 0.5, [0.0, 0.0]), 5.5) {
        ended.is_at(&[15.0, 5.0], 0.0);
        assert_eq!(ended.events.guards(), [1, 0].repeat(5), "{}", ended.name);
    }
}

/// Periodic guards, one with half the frequency of the other.
struct Periods;

impl Report for Periods {
    fn field<T: Number>(&self, _: u8, _: T, _: [T; 4]) -> [T; 4] {
        [0.0; 4].map(T::from)
    }
    fn guards(&self, _: u8) -> [Guard; 3] {
        [EITHER, EITHER, OFF]
    }
    fn values<T: Number>(&self, _: u8, s: T, _: [T; 4]) -> [T; 3] {
        [(s * PI).sin(), (s * (0.5 * PI)).sin(), s]
    }
    fn act(&self, mode: u8, guard: usize, _: f64, y: &mut [f64; 4]) -> u8 {
        y[guard] += 1.0;
        mode
    }
}

/// ModelingToolkit.jl 3819: of events of different periods, only the first acted where both are
/// due.
#[test]
fn periodic_guards_act_together_where_they_meet() {
    for ended in all(&Periods, (0, 0.25, [0.0, 0.0]), 10.5) {
        let each = |step: usize| (step..=10).step_by(step).map(|k| k as f64).collect::<Vec<_>>();
        ended.acts_at(0, &each(1), 1e-12);
        ended.acts_at(1, &each(2), 1e-12);
        ended.is_at(&[10.0, 5.0], 0.0);
    }
}

/// An input that is set and a value that is sampled at one time.
struct Sampled(bool);

impl Report for Sampled {
    fn field<T: Number>(&self, _: u8, _: T, _: [T; 4]) -> [T; 4] {
        [0.0; 4].map(T::from)
    }
    fn guards(&self, _: u8) -> [Guard; 3] {
        [if self.0 { last(RISING) } else { RISING }, RISING, OFF]
    }
    fn values<T: Number>(&self, _: u8, s: T, _: [T; 4]) -> [T; 3] {
        [s - 1.0, s - 1.0, s]
    }
    fn act(&self, mode: u8, guard: usize, _: f64, y: &mut [f64; 4]) -> u8 {
        if guard == 0 {
            y[0] = 5.0;
        } else {
            y[1] = 2.0 * y[0];
        }
        mode
    }
}

/// FMPy 692: an input event and a time event at one moment came too early or too late.
#[test]
fn an_input_and_a_sample_at_one_time_follow_their_priorities() {
    for (yields, sample) in [(false, 10.0), (true, 2.0)] {
        for ended in all(&Sampled(yields), (0, 0.0, [1.0, 0.0]), 2.0) {
            ended.is_at(&[5.0, sample], 0.0);
        }
    }
}

/// A ball that falls on a floor, which is lowered as the ball arrives.
struct Stairs(Guard);

impl Report for Stairs {
    fn field<T: Number>(&self, _: u8, _: T, y: [T; 4]) -> [T; 4] {
        [y[1], T::from(-2.0), T::from(0.0), T::from(0.0)]
    }
    fn guards(&self, mode: u8) -> [Guard; 3] {
        [if mode == 0 { RISING } else { OFF }, self.0, OFF]
    }
    fn values<T: Number>(&self, _: u8, s: T, y: [T; 4]) -> [T; 3] {
        [s - 1.0, y[0] - y[2], s]
    }
    fn act(&self, mode: u8, guard: usize, _: f64, y: &mut [f64; 4]) -> u8 {
        if guard == 0 {
            y[2] -= 1.0;
            return 1;
        }
        y[1] *= -0.5;
        mode
    }
}

/// Reference-FMUs 72: a state event was lost if a time event moved the floor at the same time.
///
/// A crossing is a fact, so that the ball bounces. A condition is asked again: the floor is not
/// reached, and the ball falls on.
#[test]
fn a_crossing_stays_a_fact_when_the_floor_moves_and_a_condition_does_not() {
    for ended in all(&Stairs(FALLING), (0, 0.0, [1.0, 0.0, 0.0]), 1.5) {
        assert_eq!(ended.events.guards(), [0, 1], "{}", ended.name);
        ended.is_at(&[0.25, 0.0, -1.0], 1e-11);
    }
    for ended in all(&Stairs(BELOW), (0, 0.0, [1.0, 0.0, 0.0]), 1.6) {
        ended.acts_at(0, &[1.0], 1e-12);
        ended.acts_at(1, &[2.0_f64.sqrt()], 1e-12);
    }
}

/// Three guards on one condition: a ball that bounces, drifts, and is thrown up again.
struct Thrown;

impl Report for Thrown {
    fn field<T: Number>(&self, _: u8, _: T, y: [T; 4]) -> [T; 4] {
        [y[1], T::from(-9.8), y[3], T::from(0.0)]
    }
    fn guards(&self, _: u8) -> [Guard; 3] {
        [FALLING; 3]
    }
    fn values<T: Number>(&self, _: u8, _: T, y: [T; 4]) -> [T; 3] {
        [y[0]; 3]
    }
    fn act(&self, mode: u8, guard: usize, _: f64, y: &mut [f64; 4]) -> u8 {
        match guard {
            0 => y[1] *= -0.9,
            1 => y[3] *= -0.9,
            _ => y[1] = 10.0,
        }
        mode
    }
}

/// DiffEqBase.jl 249: three callbacks on one condition never came to an end.
#[test]
fn three_guards_on_one_condition_all_act_at_each_bounce() {
    let (first, period) = ((100.0 / 9.8_f64).sqrt(), 20.0 / 9.8);
    let bounces: Vec<f64> = (0..6).map(|k| first + period * f64::from(k)).collect();
    for ended in all(&Thrown, (0, 0.0, [50.0, 0.0, 0.0, 2.0]), 15.0) {
        assert_eq!(ended.events.guards(), [0, 1, 2].repeat(6), "{}", ended.name);
        ended.acts_at(2, &bounces, 1e-11);
        let left = 15.0 - bounces[5];
        let drift: f64 = (0..5).map(|k| 2.0 * period * (-0.9_f64).powi(k + 1)).sum();
        let speed = 2.0 * 0.9_f64.powi(6);
        let x = 2.0 * first + drift + speed * left;
        ended.is_at(&[10.0 * left - 4.9 * left * left, 10.0 - 9.8 * left, x, speed], 1e-9);
    }
}

/// Two rooms with thermostats: on below 19, off above 21.
struct Rooms;

impl Report for Rooms {
    fn field<T: Number>(&self, mode: u8, _: T, y: [T; 4]) -> [T; 4] {
        let towards = |room: u8| if mode >> room & 1 == 1 { 30.0 } else { 5.0 };
        [-y[0] + towards(0), -y[1] + towards(1), T::from(0.0), T::from(0.0)]
    }
    fn guards(&self, _: u8) -> [Guard; 3] {
        [BELOW, BELOW, OFF]
    }
    fn values<T: Number>(&self, mode: u8, s: T, y: [T; 4]) -> [T; 3] {
        let value = |room: u8, y: T| if mode >> room & 1 == 1 { -y + 21.0 } else { y - 19.0 };
        [value(0, y[0]), value(1, y[1]), s]
    }
    fn act(&self, mode: u8, guard: usize, _: f64, _: &mut [f64; 4]) -> u8 {
        mode ^ (1 << guard)
    }
}

/// Thermostats that are some 1e-12 apart each switch at their own times.
#[test]
fn rooms_that_are_nearly_equal_all_keep_their_temperature() {
    let first = (10.0_f64 / 9.0).ln();
    let (cools, heats) = ((16.0_f64 / 14.0).ln(), (11.0_f64 / 9.0).ln());
    let mut times = vec![first];
    while times[times.len() - 1] < 4.0 {
        let next = times[times.len() - 1] + if times.len() % 2 == 1 { cools } else { heats };
        times.push(next);
    }
    times.pop();
    for apart in [0.0, 1e-13, 1e-12, 1e-11, 1e-9] {
        for ended in all(&Rooms, (3, 0.0, [20.0, 20.0 - apart]), 4.0) {
            ended.acts_at(0, &times, 1e-10);
            ended.acts_at(1, &times, 1e-10 + apart);
        }
    }
}

/// y′ = 1, and two guards that end the run.
struct TwoEnds(f64, f64);

impl Report for TwoEnds {
    fn field<T: Number>(&self, _: u8, _: T, _: [T; 4]) -> [T; 4] {
        [1.0, 0.0, 0.0, 0.0].map(T::from)
    }
    fn guards(&self, _: u8) -> [Guard; 3] {
        [EITHER.terminal(), EITHER.terminal(), OFF]
    }
    fn values<T: Number>(&self, _: u8, s: T, _: [T; 4]) -> [T; 3] {
        [s - self.0, s - self.1, s]
    }
}

/// Diffrax 639: of two events on one step, the one listed last won, whatever its time.
#[test]
fn the_earlier_of_two_ends_on_one_step_wins() {
    for (first, second) in [(1.0, 0.5), (0.5, 1.0), (0.5 + 1e-12, 0.5), (0.5, 0.5 + 1e-12)] {
        for ended in all(&TwoEnds(first, second), (0, 0.0, [0.0]), 10.0) {
            let guard = usize::from(second < first);
            assert_eq!(ended.outcome, Outcome::EndedByGuard { guard }, "{}", ended.name);
            assert!((ended.s - 0.5).abs() < 1e-14, "{ended:?}");
        }
    }
}
