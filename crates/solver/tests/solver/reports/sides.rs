//! On which side a guard leaves zero, and what it does in between.

use std::f64::consts::{FRAC_PI_2, PI, SQRT_2};

use stickslip_solver::{Guard, Number, Options, Outcome, RunError};

use super::forms::{Report, all, runs};
use super::{BELOW, EITHER, FALLING, OFF, RISING, is_endless};

/// A body thrown up from a floor, y″ = −g.
#[expect(clippy::struct_field_names, reason = "the level of the floor")]
struct Floor {
    guard: Guard,
    floor: f64,
    gravity: f64,
}

impl Report for Floor {
    fn field<T: Number>(&self, _: u8, _: T, y: [T; 4]) -> [T; 4] {
        [y[1], T::from(-self.gravity), T::from(0.0), T::from(0.0)]
    }
    fn guards(&self, _: u8) -> [Guard; 3] {
        [self.guard, OFF, OFF]
    }
    fn values<T: Number>(&self, _: u8, s: T, y: [T; 4]) -> [T; 3] {
        [y[0] - self.floor, s, s]
    }
}

/// A guard that is exactly 0 and rises slowly does not fire at once, whatever its terms.
#[test]
fn a_guard_that_rises_slowly_from_zero_does_not_fire() {
    for floor in [0.0, 0.1, 1.0, 3.0, 10.0] {
        for speed in [1e-4, 1e-3, 1.0] {
            let body = |gravity| Floor { guard: BELOW.terminal(), floor, gravity };
            for ended in all(&body(0.0), (0, 0.0, [floor, speed]), 1.0) {
                assert_eq!(ended.outcome, Outcome::ReachedEnd, "{} {floor} {speed}", ended.name);
            }
            for ended in all(&body(10.0 * speed), (0, 0.0, [floor, speed]), 1.0) {
                let hit = Outcome::EndedByGuard { guard: 0 };
                assert_eq!(ended.outcome, hit, "{} {floor} {speed}", ended.name);
                let error = 1e-14 * (1.0 + floor / speed);
                assert!((ended.s - 0.2).abs() < error, "{floor} {speed} {ended:?}");
            }
        }
    }
}

/// A guard that starts from zero and comes back within the first step fires twice.
#[test]
fn a_start_from_zero_is_not_lost_if_the_guard_returns_at_once() {
    for (speed, gravity) in [(1e-3, 1.0), (1.0, 1000.0), (1.0, 2.0), (-1e-3, -1.0)] {
        let body = Floor { guard: EITHER, floor: 0.0, gravity };
        for ended in all(&body, (0, 0.0, [0.0, speed]), 5.0) {
            ended.acts_at(0, &[0.0, 2.0 * speed / gravity], 1e-13);
        }
    }
}

/// y = sin s, beside 1.
struct Touch(Guard);

impl Report for Touch {
    fn field<T: Number>(&self, _: u8, _: T, y: [T; 4]) -> [T; 4] {
        [y[1], -y[0], T::from(0.0), T::from(0.0)]
    }
    fn guards(&self, _: u8) -> [Guard; 3] {
        [self.0, OFF, OFF]
    }
    fn values<T: Number>(&self, _: u8, s: T, _: [T; 4]) -> [T; 3] {
        [-s.sin() + 1.0, s, s]
    }
}

/// A guard that touches zero without a slope does not fire.
#[test]
fn a_touch_is_no_event() {
    for guard in [BELOW, FALLING, RISING, EITHER] {
        for ended in all(&Touch(guard), (0, 0.0, [0.0, 1.0]), 10.0) {
            assert_eq!(ended.events.guards(), [0; 0], "{} {guard:?}", ended.name);
        }
    }
}

/// A motion on one section, q₀ = 0, from which it starts.
struct Section;

impl Report for Section {
    fn field<T: Number>(&self, _: u8, _: T, y: [T; 4]) -> [T; 4] {
        let [p0, p2, q0, q2] = y;
        let (a, b, d) = (1.0, 0.55, 0.4);
        let square = (q0 * q0 + q2 * q2) * d;
        let difference = q2 * q2 - q0 * q0;
        [
            -q0 * a - difference * (3.0 * b / SQRT_2) - q0 * square,
            -q2 * (q0 * (3.0 * SQRT_2 * b) + square + a),
            p0 * a,
            p2 * a,
        ]
    }
    fn guards(&self, _: u8) -> [Guard; 3] {
        [RISING, OFF, OFF]
    }
    fn values<T: Number>(&self, _: u8, s: T, y: [T; 4]) -> [T; 3] {
        [y[2], s, s]
    }
}

/// DifferentialEquations.jl 353: a section was found again and again at one time. The times of its
/// first crossings are printed there.
#[test]
fn a_section_is_crossed_once_at_a_time() {
    let printed = [
        0.0,
        2.512_276_264_530_676,
        4.717_720_366_379_531,
        7.160_143_716_277_218,
        9.769_301_443_000_842,
        12.476_863_521_059_675,
    ];
    let start = [7.198_988_506_190_433_5, -0.165_912_283_356_219, 0.0, -3.635_349_007_487_47];
    for ended in all(&Section, (0, 0.0, start), 13.0) {
        ended.acts_at(0, &printed, 1e-8);
    }
    for ended in all(&Section, (0, 0.0, start), 100.0) {
        let times = ended.events.times(0);
        assert!(times.windows(2).all(|pair| pair[1] - pair[0] > 0.2), "{}", ended.name);
        assert!(times.len() > 30 && times.len() < 60, "{} {}", ended.name, times.len());
    }
}

/// y = x³ + 6x² − 4x − 24 by its slope.
struct Cubic;

impl Report for Cubic {
    fn field<T: Number>(&self, _: u8, s: T, _: [T; 4]) -> [T; 4] {
        [s * s * 3.0 + s * 12.0 - 4.0, T::from(0.0), T::from(0.0), T::from(0.0)]
    }
    fn guards(&self, _: u8) -> [Guard; 3] {
        [EITHER, OFF, OFF]
    }
    fn values<T: Number>(&self, _: u8, s: T, y: [T; 4]) -> [T; 3] {
        [y[0], s, s]
    }
}

/// SciPy 9228: of three zeros, two lie on one step and were lost.
#[test]
fn all_zeros_on_one_long_step_are_found() {
    for ended in all(&Cubic, (0, -8.0, [-120.0]), 4.0) {
        ended.acts_at(0, &[-6.0, -2.0, 2.0], 1e-12);
    }
}

/// y′ = 1, and a guard with the zeros 0, 2.5 and 5.
struct Straight;

impl Report for Straight {
    fn field<T: Number>(&self, _: u8, _: T, _: [T; 4]) -> [T; 4] {
        [1.0, 0.0, 0.0, 0.0].map(T::from)
    }
    fn guards(&self, _: u8) -> [Guard; 3] {
        [EITHER, OFF, OFF]
    }
    fn values<T: Number>(&self, _: u8, s: T, y: [T; 4]) -> [T; 3] {
        [(-y[0] + 2.5) * (-y[0] + 5.0) * -y[0], s, s]
    }
}

/// Diffrax 507: a straight line takes long steps, so that two changes of sign were missed.
#[test]
fn a_straight_line_misses_no_event() {
    for ended in all(&Straight, (0, 0.0, [-1.0]), 100.0) {
        ended.acts_at(0, &[1.0, 3.5, 6.0], 1e-12);
    }
}

/// x′ = −2 above y and 2 below, y′ = 1.5 and −3: the two meet and stay together.
struct Chatter;

impl Report for Chatter {
    fn field<T: Number>(&self, mode: u8, _: T, _: [T; 4]) -> [T; 4] {
        let [x, y] = if mode == 0 { [-2.0, 1.5] } else { [2.0, -3.0] };
        [x, y, 0.0, 0.0].map(T::from)
    }
    fn guards(&self, _: u8) -> [Guard; 3] {
        [BELOW, OFF, OFF]
    }
    fn values<T: Number>(&self, mode: u8, s: T, y: [T; 4]) -> [T; 3] {
        [if mode == 0 { y[0] - y[1] } else { y[1] - y[0] }, s, s]
    }
    fn act(&self, mode: u8, _: usize, _: f64, _: &mut [f64; 4]) -> u8 {
        1 - mode
    }
}

/// OpenModelica 12190: a model that chatters made no progress and gave no reason.
#[test]
fn chattering_is_reported_where_it_begins() {
    for (name, run) in runs(&Chatter, (0, 0.0, [1.5, 1.0]), 1.0, &Options::default()) {
        is_endless(&name, &run, 1.0 / 7.0);
    }
}

/// A block with friction 1 under the force 2 sin s: it sticks (0), slips forward from rest (1), and
/// slips backward as soon as it has stopped (2).
struct Block;

impl Report for Block {
    fn field<T: Number>(&self, mode: u8, s: T, _: [T; 4]) -> [T; 4] {
        let friction = [0.0, -1.0, 1.0][usize::from(mode)];
        let force = if mode == 0 { T::from(0.0) } else { s.sin() * 2.0 + friction };
        [force, T::from(0.0), T::from(0.0), T::from(0.0)]
    }
    fn guards(&self, mode: u8) -> [Guard; 3] {
        match mode {
            0 => [BELOW, BELOW, OFF],
            1 => [BELOW.from_zero(2), OFF, OFF],
            _ => [BELOW.from_zero(1), OFF, OFF],
        }
    }
    fn values<T: Number>(&self, mode: u8, s: T, y: [T; 4]) -> [T; 3] {
        let force = s.sin() * 2.0;
        match mode {
            0 => [-force + 1.0, force + 1.0, s],
            1 => [y[0], s, s],
            _ => [-y[0], s, s],
        }
    }
    fn act(&self, mode: u8, guard: usize, s: f64, y: &mut [f64; 4]) -> u8 {
        y[0] = 0.0;
        let force = 2.0 * s.sin();
        match mode {
            0 => 1 + u8::from(guard == 1),
            _ if force.abs() < 1.0 => 0,
            _ => 1 + u8::from(force < 0.0),
        }
    }
}

/// Drake 4147: a block sticks exactly, slips when the force is large, and turns back when it stops.
#[test]
fn a_block_with_friction_slips_and_turns_back() {
    let begin = PI / 6.0;
    let speed = |s: f64| -2.0 * (s.cos() - begin.cos()) - (s - begin);
    let (mut low, mut high) = (2.5, 4.5);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if speed(middle) > 0.0 { low = middle } else { high = middle }
    }
    for ended in all(&Block, (0, 0.0, [0.0]), 5.0) {
        ended.acts_at(0, &[begin, low], 1e-10);
        ended.is_at(&[-2.0 * (5.0_f64.cos() - low.cos()) + (5.0 - low)], 1e-10);
        assert_eq!(ended.mode, 2);
    }
}

/// x″ = −x, saturated at ±1/2. The modes are above, within and below.
struct Saturation;

impl Report for Saturation {
    fn field<T: Number>(&self, mode: u8, _: T, y: [T; 4]) -> [T; 4] {
        let force = [T::from(-0.5), -y[0], T::from(0.5)][usize::from(mode)];
        [y[1], force, T::from(0.0), T::from(0.0)]
    }
    fn guards(&self, mode: u8) -> [Guard; 3] {
        [[FALLING, OFF, OFF], [RISING, FALLING, OFF], [OFF, RISING, OFF]][usize::from(mode)]
    }
    fn values<T: Number>(&self, _: u8, s: T, y: [T; 4]) -> [T; 3] {
        [y[0] - 0.5, y[0] + 0.5, s]
    }
    fn act(&self, mode: u8, guard: usize, _: f64, _: &mut [f64; 4]) -> u8 {
        match (mode, guard) {
            (1, 0) => 0,
            (1, _) => 2,
            _ => 1,
        }
    }
}

/// SciPy 18039: a step over the corner of a piecewise smooth system was inaccurate.
#[test]
fn a_saturated_oscillator_keeps_its_period() {
    let (outside, inside) = (6.0_f64.sqrt(), 2.0 * (0.5 / 1.75_f64.sqrt()).asin());
    let half = 2.0 * outside + inside;
    for ended in all(&Saturation, (0, 0.0, [2.0, 0.0]), 5.0 * half) {
        ended.is_at(&[-2.0, 0.0], 1e-9);
        let down: Vec<f64> = (0..5).map(|k| half * f64::from(k)).collect();
        let both = |first: f64| down.iter().map(move |start| start + first).collect::<Vec<_>>();
        let times: Vec<f64> = ended.events.0.iter().map(|event| event.0).collect();
        for (found, expected) in times.iter().step_by(2).zip(both(outside)) {
            assert!((found - expected).abs() < 1e-10, "{} {found} {expected}", ended.name);
        }
        assert_eq!(times.len(), 10, "{}", ended.name);
    }
}

/// A guard that is zero always, or from a time on.
struct Plateau(f64);

impl Report for Plateau {
    fn field<T: Number>(&self, _: u8, _: T, _: [T; 4]) -> [T; 4] {
        [1.0, 0.0, 0.0, 0.0].map(T::from)
    }
    fn guards(&self, _: u8) -> [Guard; 3] {
        [EITHER, OFF, OFF]
    }
    fn values<T: Number>(&self, _: u8, s: T, y: [T; 4]) -> [T; 3] {
        [(-y[0] + self.0).max(T::from(0.0)), s, s]
    }
}

/// SUNDIALS 881, OpenModelica 13680: a guard that is zero on a stretch never fires where bounds
/// show that it rests there, and is refused, with its name, where only its values are known.
#[test]
fn a_guard_that_is_zero_throughout_never_fires_or_is_refused() {
    for (name, run) in runs(&Plateau(-1.0), (0, 0.0, [0.0]), 2.0, &Options::default()) {
        let right = match &run {
            Ok(ended) => name.contains("readable") && ended.events.0.is_empty(),
            Err(error) => matches!(error, RunError::GuardIdenticallyZero { guard: 0, .. }),
        };
        assert!(right, "{name}: {run:?}");
    }
}

/// A guard with a zero of third order is crossed all the same.
struct Flat;

impl Report for Flat {
    fn field<T: Number>(&self, _: u8, _: T, y: [T; 4]) -> [T; 4] {
        [y[1], -y[0], T::from(0.0), T::from(0.0)]
    }
    fn guards(&self, _: u8) -> [Guard; 3] {
        [RISING, OFF, OFF]
    }
    fn values<T: Number>(&self, _: u8, s: T, y: [T; 4]) -> [T; 3] {
        [y[0] * y[0] * y[0], s, s]
    }
}

/// A crossing without a slope: sin³ s rises through zero.
#[test]
fn a_crossing_without_slope_is_found() {
    for ended in all(&Flat, (0, FRAC_PI_2, [1.0, 0.0]), 8.0 * PI + 1.0) {
        let times: Vec<f64> = (1..=4).map(|k| 2.0 * PI * f64::from(k)).collect();
        ended.acts_at(0, &times, 1e-4);
    }
}
