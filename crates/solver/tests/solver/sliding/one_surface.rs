//! One surface.

use std::f64::consts::{FRAC_PI_2, PI};

use super::{Relays, ran, refused, switches, zero};
use SurfaceSide::{Above, Below, Sliding};
use stickslip_solver::dynamic::DynamicStart;
use stickslip_solver::sliding::{
    Filippov, Refusal, SampledFilippov, SurfaceSide, Switched, TwoFields,
};
use stickslip_solver::{Direction, Dop853, Guard, Number, Options, ReadableSystem, Start, State};

use crate::erased::{run, run_backwards, run_dynamic};

/// x′ = drift − gain·sgn(x).
fn relay(drift: f64, gain: f64) -> Relays<1, 1> {
    Relays { constant: [drift], relays: [[-gain]], normals: [[1.0]], ..Relays::NONE }
}

/// It arrives at 0 from both sides and stays there, exactly.
#[test]
fn a_relay_comes_to_rest() {
    for (x, drift) in [(0.75, 0.0), (-0.75, 0.0), (0.6, 0.3), (-0.6, 0.3), (2.5, -0.99)] {
        let (switches, end) = switches::<1, 1, 2>(&relay(drift, 1.0), [x], 1e5);
        let arrival = x.abs() / (1.0 - drift * x.signum());
        assert_eq!(switches.len(), 1);
        assert!((switches[0].0 - arrival).abs() < 1e-14 * arrival, "{switches:?}");
        assert_eq!((&switches[0].1[..], end[0].abs() < 1e-15), (&[Sliding][..], true), "{end}");
    }
}

/// x′ = 3/2 cos t − sgn x slides while |3/2 cos t| < 1. Its release has a double zero.
#[test]
fn a_relay_is_released_and_caught_again() {
    let system = Relays { drive: [1.5], ..relay(0.0, 1.0) };
    let (switches, end) = switches::<1, 1, 2>(&system, [0.0], 20.0);
    // From t = 0 it rises: x = 3/2 sin t − t, up to the root of that.
    let caught = zero(|t| 1.5 * f64::sin(t) - t, 1.0, 2.0);
    assert_eq!(switches[0].1, [Sliding]);
    assert!((switches[0].0 - caught).abs() < 1e-11, "{switches:?}");
    // Released where cos t = −2/3, downwards.
    let released = (-2.0_f64 / 3.0).acos();
    let x = |t: f64| 1.5 * (t.sin() - released.sin()) + (t - released);
    let caught = zero(x, released + 0.5, released + 4.0);
    let mut expected = Vec::new();
    for k in 0..7 {
        let turned = f64::from(k) * PI;
        let side = if k % 2 == 0 { Below } else { Above };
        expected.push((released + turned, side));
        expected.push((caught + turned, Sliding));
    }
    for (found, expected) in switches[1..].iter().zip(&expected) {
        assert!((found.0 - expected.0).abs() < 1e-10, "{found:?} {expected:?}");
        assert_eq!(found.1, [expected.1]);
    }
    let inside = expected.iter().filter(|expected| expected.0 < 20.0).count();
    assert_eq!(switches.len(), 1 + inside);
    assert!(end[0].abs() < 10.0);
}

/// Where both rates have one sign, it crosses, and the state stays what it is.
#[test]
fn it_crosses() {
    let system = Relays { constant: [2.0], relays: [[-1.0]], normals: [[1.0]], ..Relays::NONE };
    let (switches, end) = switches::<1, 1, 2>(&system, [-1.5], 2.0);
    assert!(switches.len() == 1 && switches[0].1 == [Above], "{switches:?}");
    assert!((switches[0].0 - 0.5).abs() < 1e-15 && (end[0] - 1.5).abs() < 1e-14, "{end}");
}

/// x′ = sgn x leaves 0 on either side.
#[test]
fn a_start_that_is_not_unique_needs_a_side() {
    let system = Filippov::<_, 1, 2>(relay(0.0, -1.0));
    let y = State::from([0.0]);
    assert_eq!(system.mode((), 0.0, &y), Err(Refusal::NotUnique));
    assert_eq!(system.mode_from((), [Sliding], 0.0, &y), Err(Refusal::NotUnique));
    for (side, sign) in [(Above, 1.0), (Below, -1.0)] {
        let mode = system.mode_from((), [side], 0.0, &y).unwrap();
        assert!(!mode.is_unique() && mode.sides() == [side]);
        assert_eq!(format!("{mode:?}"), format!("() [{side:?}] not unique"));
        let (ended, events) = ran::<_, 1, 1, 2>(&system, mode, (0.0, [0.0]), 2.0);
        assert!(events.is_empty());
        assert!((ended.unwrap().state[0] - 2.0 * sign).abs() < 1e-15);
    }
    // Where the start is not on the surface, sides are those of the state.
    let mode = system.mode_from((), [Above], 0.0, &State::from([-0.1])).unwrap();
    assert!(mode.sides() == [Below] && mode.is_unique());
}

/// A start where a multiplier is just 1 goes on as the multiplier does.
#[test]
fn a_start_at_the_limit_of_sliding_goes_on_as_its_multiplier_does() {
    // x′ = c cos t − sgn x at the time with c cos t = 1.
    let system = Filippov::<_, 1, 2>(Relays { drive: [2.0], ..relay(0.0, 1.0) });
    let y = State::from([0.0]);
    for (s, side) in [(PI / 3.0, Sliding), (-PI / 3.0, Above), (2.0 * PI / 3.0, Below)] {
        let mode = system.mode((), s, &y).unwrap();
        assert_eq!(mode.sides(), [side], "{s}");
        let (ended, events) = ran::<_, 1, 1, 2>(&system, mode, (s, [0.0]), s + 0.5);
        assert!(ended.unwrap().finished().is_ok() && events.is_empty(), "{events:?}");
    }
}

/// x′ = −2 sgn(x − sin t) follows sin t; x′ = −1/2 sgn(x − sin t) does so while |cos t| < 1/2.
#[test]
fn a_surface_may_move() {
    let moving = |gain: f64| Relays { waves: [-1.0], ..relay(0.0, gain) };
    let (found, end) = switches::<1, 1, 2>(&moving(2.0), [1.0], 10.0);
    let arrival = zero(|t| 1.0 - 2.0 * t - t.sin(), 0.0, 1.0);
    assert!(found.len() == 1 && (found[0].0 - arrival).abs() < 1e-13, "{found:?}");
    assert!((end[0] - 10.0_f64.sin()).abs() < 1e-12, "{end}");

    let (found, _) = switches::<1, 1, 2>(&moving(0.5), [1.0], 8.0);
    let arrival = zero(|t| 1.0 - 0.5 * t - t.sin(), 0.0, 1.5);
    assert_eq!(found[0].1, [Below]);
    let turn = |t: f64| 1.0 - 0.5 * arrival + 0.5 * (t - arrival) - t.sin();
    let caught = zero(turn, arrival + 0.1, FRAC_PI_2 + 0.5);
    assert!((found[0].0 - arrival).abs() < 1e-12 && (found[1].0 - caught).abs() < 1e-11);
    assert_eq!(found[1].1, [Sliding]);
    assert!((found[2].0 - 2.0 * PI / 3.0).abs() < 1e-10 && found[2].1 == [Above], "{found:?}");
}

/// A mass on a spring and a belt: slips, sticks, and slips again.
#[test]
fn dry_friction_on_a_belt() {
    let (friction, belt) = (0.8, 0.5);
    let system = Relays {
        matrix: [[0.0, 1.0], [-1.0, 0.0]],
        relays: [[0.0], [-friction]],
        normals: [[0.0, 1.0]],
        offsets: [-belt],
        ..Relays::NONE
    };
    let (found, end) = switches::<2, 1, 2>(&system, [0.0, 0.0], 5.0);
    let stick = (belt / friction).asin();
    let carried = (friction * stick.cos()) / belt;
    assert!((found[0].0 - stick).abs() < 1e-12 && found[0].1 == [Sliding], "{found:?}");
    assert!((found[1].0 - stick - carried).abs() < 1e-12 && found[1].1 == [Below]);
    let left = 5.0 - stick - carried;
    assert!((end[0] - friction - belt * left.sin()).abs() < 1e-10, "{end}");
    // Faster than the belt, it is slowed down first.
    let (found, _) = switches::<2, 1, 2>(&system, [0.0, 1.0], 1.0);
    // x = −F + F cos t + sin t.
    let stick = zero(|t| t.cos() - friction * t.sin() - belt, 0.0, 1.0);
    assert!((found[0].0 - stick).abs() < 1e-12 && found[0].1 == [Sliding]);
}

/// A mass that a periodic force pushes to and fro sticks twice a period, 128 switches long.
#[test]
fn a_pushed_mass_with_many_switches() {
    let (force, friction, frequency) = (1.0, 0.6, 2.0);
    let system = Relays {
        matrix: [[0.0, 1.0], [0.0, 0.0]],
        drive: [0.0, force],
        frequency,
        relays: [[0.0], [-friction]],
        normals: [[0.0, 1.0]],
        ..Relays::NONE
    };
    // At rest while |cos ωt| < F; from the start it slips forwards.
    let velocity = |begin: f64, t: f64| {
        force / frequency * ((frequency * t).sin() - (frequency * begin).sin())
            - friction * (t - begin)
    };
    let first = zero(|t| velocity(0.0, t), 0.5, 1.5);
    let half = PI / frequency;
    let begin = -friction.acos() / frequency;
    let stop = zero(|t| velocity(begin, t), begin + 0.5, begin + 1.5);
    let (found, _) = switches::<2, 1, 2>(&system, [0.0, 0.0], 65.0 * half);
    assert!((found[0].0 - first).abs() < 1e-11 && found[0].1 == [Sliding], "{found:?}");
    for k in 1..=64_u32 {
        let turned = f64::from(k) * half;
        let [slip, stick] = [&found[2 * k as usize - 1], &found[2 * k as usize]];
        assert!((slip.0 - begin - turned).abs() < 1e-10, "{slip:?} {}", begin + turned);
        assert!((stick.0 - stop - turned).abs() < 1e-10, "{stick:?} {}", stop + turned);
        assert_eq!(slip.1, [if k % 2 == 1 { Below } else { Above }]);
        assert_eq!(stick.1, [Sliding]);
    }
    assert_eq!(found.len(), 130);
}

/// Where a surface is curved, the errors of the steps lead away from it, and no more than that.
#[test]
fn a_curved_surface_is_not_left() {
    // Two fields that turn about 0 and are attracted to the circle of radius 1.
    let turn = |radial: f64| {
        move |_time: f64, y: &[f64], slope: &mut [f64]| {
            slope[0] = -y[1] + radial * y[0];
            slope[1] = y[0] + radial * y[1];
        }
    };
    let circle = |_time: f64, y: &[f64]| y[0] * y[0] + y[1] * y[1] - 1.0;
    let system = SampledFilippov::new(TwoFields(turn(-1.0), turn(0.5), circle));
    let y = [0.5, 0.0];
    let start = DynamicStart { mode: system.mode((), 0.0, &y).unwrap(), s: 0.0, state: &y };
    let mut events = Vec::new();
    let options = Options::default();
    let end = run_dynamic(Dop853, &system, start, 1000.0, &options, &mut events).unwrap();
    let end = end.finished().unwrap();
    assert_eq!(events.len(), 1);
    assert!((events[0].s - 2.0 * 2.0_f64.ln()).abs() < 1e-10);
    let radius = end.state[0].hypot(end.state[1]);
    // Measured: 8.5e-10, after about a thousand steps with a tolerance of 1e-10.
    assert!((radius - 1.0).abs() < 2e-9, "{radius}");
    assert!((end.state[0] - 1000.0_f64.cos()).abs() < 1e-6);
}

/// Backwards, what came before a surface is not known.
#[test]
fn backwards_it_is_refused() {
    let system = Filippov::<_, 1, 2>(relay(0.0, 1.0));
    let y = State::from([0.5]);
    let start = Start { mode: system.mode((), 0.0, &y).unwrap(), s: 0.0, state: y };
    let mut events = Vec::new();
    let options = Options::default();
    let system = Filippov::<_, 1, 2>(Relays { constant: [-2.0], ..system.0 });
    // Backwards x rises from 1/2 as 3 t; it does not meet the surface.
    let end = run_backwards(Dop853, &system, start, -1.0, &options, &mut events);
    assert!((end.unwrap().state[0] - 3.5).abs() < 1e-12 && events.is_empty());
    let y = State::from([-0.5]);
    let mode = system.mode((), 0.0, &y).unwrap();
    let start = Start { mode, s: 0.0, state: y };
    let end = run_backwards(Dop853, &system, start, -1.0, &options, &mut events);
    assert_eq!(refused((end, events)), Refusal::NoSolution);
}

/// A belt whose velocity and friction change where the mass passes x = 0.3, with these values.
struct Changing {
    friction: f64,
    velocity: f64,
}

impl Switched<2, 1, 3> for Changing {
    /// Whether they have changed.
    type Mode = bool;

    fn field<T: Number>(&self, changed: bool, signs: &[T; 1], _s: T, y: &[T; 2]) -> [T; 2] {
        [y[1], -y[0] - signs[0] * if changed { self.friction } else { 0.8 }]
    }
    fn surfaces<T: Number>(&self, changed: bool, _s: T, y: &[T; 2]) -> [T; 1] {
        [y[1] - if changed { self.velocity } else { 0.5 }]
    }
    fn guards(&self, changed: bool) -> [Guard; 3] {
        let own = if changed { Guard::OFF } else { Guard::new(Direction::Rising) };
        [Guard::OFF, Guard::OFF, own]
    }
    fn guard_values<T: Number>(&self, _: bool, _s: T, y: &[T; 2]) -> [T; 3] {
        [T::from(0.0), T::from(0.0), y[0] - 0.3]
    }
    fn next(&self, _: bool, _guard: usize, _s: f64, _y: &State<2>) -> bool {
        true
    }
}

/// Where the system itself changes, it is asked anew whether the mass sticks.
#[test]
fn own_guards_may_end_sliding() {
    let ran = |friction: f64, velocity: f64| {
        let system = Filippov(Changing { friction, velocity });
        let state = State::from([-0.3, 0.5]);
        let start = Start { mode: system.mode(false, 0.0, &state).unwrap(), s: 0.0, state };
        let mut events = Vec::new();
        let options = Options::with_tolerance(1e-12);
        let end = run(Dop853, &system, start, 2.0, &options, &mut events).unwrap();
        assert!((events[0].s - 1.2).abs() < 1e-12 && events[0].guard == 2 && events[0].to.own);
        assert!(events.len() == 1 && end.finished().is_ok(), "{events:?} {end:?}");
        let condition = system.transition_condition(start.mode, 2, 1.2, &events[0].before);
        (events[0].to.sides().to_vec(), end.state[0], condition)
    };
    let (sine, cosine) = 0.8_f64.sin_cos();
    // Weaker friction lets it slip, λ = 3/2; stronger friction does not, λ = 3/20.
    let (sides, x, condition) = ran(0.2, 0.5);
    assert!(sides == [Below] && (x - 0.2 - 0.1 * cosine - 0.5 * sine).abs() < 1e-11, "{x}");
    assert!((condition + 0.5).abs() < 1e-12, "{condition}");
    let (sides, x, condition) = ran(2.0, 0.5);
    assert!(sides == [Sliding] && (x - 0.7).abs() < 1e-12, "{x}");
    assert!((condition - 0.85).abs() < 1e-12, "{condition}");
    // A belt that turns back leaves the mass behind.
    let (sides, x, _) = ran(0.8, -0.5);
    assert!(sides == [Above] && (x + 0.8 - 1.1 * cosine - 0.5 * sine).abs() < 1e-11, "{x}");
}

/// What separates crossing from sliding is the rate behind the surface.
#[test]
fn a_condition_separates_crossing_from_sliding() {
    let y = State::from([1e-18]);
    for drift in [-1.5, -1.001, -0.999, 0.5] {
        let system = Filippov::<_, 1, 2>(relay(drift, 1.0));
        let above = system.mode((), 0.0, &State::from([1.0])).unwrap();
        let condition = system.transition_condition(above, 0, 1.0, &y);
        assert!((condition - (drift + 1.0)).abs() < 1e-15, "{condition}");
        let (to, _) = system.transition(above, 0, 1.0, &y);
        assert_eq!(to.sides(), [if drift < -1.0 { Below } else { Sliding }]);
        let system = Filippov::<_, 1, 2>(relay(-drift, 1.0));
        let below = system.mode((), 0.0, &State::from([-1.0])).unwrap();
        let condition = system.transition_condition(below, 0, 1.0, &y);
        assert!((condition - (drift + 1.0)).abs() < 1e-15, "{condition}");
    }
    // A release has one way only.
    let system = Filippov::<_, 1, 2>(relay(0.0, 1.0));
    let sliding = system.mode((), 0.0, &State::from([0.0])).unwrap();
    assert!(system.transition_condition(sliding, 0, 1.0, &y).is_nan());
}
