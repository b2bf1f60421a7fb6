//! The onset of sliding of a driven oscillator on a belt.
//!
//! x″ + c x′ + x = A cos ωt − F sgn(x′ − v). The steady orbit of the smooth oscillator has the
//! velocity A ω/√((1 − ω²)² + (cω)²) at most, and reaches the belt's where A = v √(…)/ω. Its
//! multipliers, the eigenvalues of the smooth oscillator's fundamental matrix H(T) over a period,
//! then jump to 0 and H₁₁(T): a change of the velocity is lost on the belt.

use std::f64::consts::TAU;

use stickslip_solver::margin::Place;
use stickslip_solver::method::Columns;
use stickslip_solver::sensitivity::sensitivities;
use stickslip_solver::sliding::{Filippov, SurfaceSide};
use stickslip_solver::{Dop853, Number, Options, Start, State};

use crate::erased::{margin, margins, run};
use stickslip_solver::sliding::Switched;

/// The oscillator, with the force A.
#[derive(Clone, Copy)]
struct Driven(f64);

const DAMPING: f64 = 0.3;
const FREQUENCY: f64 = 1.4;
const FRICTION: f64 = 0.5;
const BELT: f64 = 0.8;
const PERIOD: f64 = TAU / FREQUENCY;

impl Switched<2, 1, 2> for Driven {
    type Mode = ();
    fn field<T: Number>(&self, (): (), signs: &[T; 1], s: T, y: &[T; 2]) -> [T; 2] {
        let force = (s * FREQUENCY).cos() * self.0 - signs[0] * FRICTION;
        [y[1], force - y[0] - y[1] * DAMPING]
    }
    fn surfaces<T: Number>(&self, (): (), _s: T, y: &[T; 2]) -> [T; 1] {
        [y[1] - BELT]
    }
}

fn onset() -> f64 {
    BELT * f64::hypot(1.0 - FREQUENCY * FREQUENCY, DAMPING * FREQUENCY) / FREQUENCY
}

/// The state after 60 periods from rest.
fn settled(force: f64, options: &Options) -> Start<stickslip_solver::sliding::SlidingMode<()>, 2> {
    let system = Filippov(Driven(force));
    let state = State::from([FRICTION, 0.0]);
    let start = Start { mode: system.mode((), 0.0, &state).unwrap(), s: 0.0, state };
    let end = run(Dop853, &system, start, 60.0 * PERIOD, options, &mut ()).unwrap();
    Start { mode: end.mode, s: end.s, state: end.state }
}

/// The margin of the steady orbit vanishes at the onset.
#[test]
fn the_margin_of_the_steady_orbit_vanishes_at_the_onset() {
    let options = Options::with_tolerance(1e-12);
    let below = 0.98 * onset();
    let start = settled(below, &options);
    let period = start.s + PERIOD;
    let free = margins(Dop853, &Filippov(Driven(below)), start, period, &options).unwrap();
    let touching = |place: &Place| matches!(place, Place::Minimum { .. });
    let name = free.near_misses.iter().find(|miss| touching(&miss.margin.place)).unwrap();
    assert!(name.margin.guard == 0 && (name.value - 0.02 * BELT).abs() < 1e-9, "{name:?}");
    // The margin is that of the smooth oscillator, on whose steady orbit each run starts.
    let value = |force: f64| {
        let (a, b) = (1.0 - FREQUENCY * FREQUENCY, DAMPING * FREQUENCY);
        let size = force / f64::hypot(a, b);
        let phase = FREQUENCY * start.s - b.atan2(a);
        let state = [FRICTION + size * phase.cos(), -size * FREQUENCY * phase.sin()];
        let start = Start { state: State::from(state), ..start };
        let system = Filippov(Driven(force));
        let at = margin(Dop853, &system, start, period, &options, &name.margin).unwrap();
        at.expect("a margin").value
    };
    let (mut a, mut b) = (0.98 * onset(), 1.01 * onset());
    for _ in 0..4 {
        let (at_a, at_b) = (value(a), value(b));
        (a, b) = (b, b - at_b * (b - a) / (at_b - at_a));
        if (b - a).abs() < 1e-15 {
            break;
        }
    }
    assert!((b - onset()).abs() < 1e-9, "{b} {}", b - onset());
    // Free runs on both sides know it too.
    for (force, slides) in [(onset() * (1.0 - 1e-8), false), (onset() * (1.0 + 1e-8), true)] {
        let start = settled(force, &options);
        let system = Filippov(Driven(force));
        let mut events = Vec::new();
        let end = run(Dop853, &system, start, start.s + PERIOD, &options, &mut events).unwrap();
        let slid = events.iter().any(|event| event.to.sides() == [SurfaceSide::Sliding]);
        assert_eq!(slid, slides, "{force} {events:?}");
        assert_eq!(end.mode.sides(), [SurfaceSide::Below]);
    }
}

/// H(t), the solutions of x″ + c x′ + x = 0 from (1, 0) and from (0, 1).
fn fundamental(t: f64) -> nalgebra::Matrix2<f64> {
    let (half, omega) = (0.5 * DAMPING, (1.0 - 0.25 * DAMPING * DAMPING).sqrt());
    let (sine, cosine) = ((omega * t).sin() / omega, (omega * t).cos());
    let decay = (-half * t).exp();
    nalgebra::Matrix2::new(cosine + half * sine, sine, -sine, cosine - half * sine) * decay
}

/// The change of the state over a period.
fn monodromy(force: f64, options: &Options) -> (nalgebra::Matrix2<f64>, usize) {
    let start = settled(force, options);
    let [x, v] = [start.state[0], start.state[1]];
    let columns = Columns::from([[x, v], [1.0, 0.0], [0.0, 1.0]]);
    let system = Filippov(Driven(force));
    let (from, end) = ((start.mode, start.s), start.s + PERIOD);
    let found = sensitivities(Dop853, &system, from, columns, end, options).unwrap();
    (found.end.state.fixed_columns::<2>(1).into_owned(), found.switches.len())
}

#[test]
fn multipliers_jump_at_the_onset() {
    let options = Options::with_tolerance(1e-11);
    let smooth = fundamental(PERIOD);
    let (before, switches) = monodromy(onset() * 0.999, &options);
    assert!(switches == 0 && (before - smooth).amax() < 1e-9, "{before} {smooth}");
    for excess in [1e-4, 1e-6] {
        let (after, switches) = monodromy(onset() * (1.0 + excess), &options);
        assert_eq!(switches, 2);
        // Measured: 6e-17.
        assert!(after.determinant().abs() < 1e-15, "{after}");
        // The other multiplier is the trace. It comes as the time on the belt goes, like √excess.
        let distance = (after.trace() - smooth[(0, 0)]).abs();
        // Measured: 0.564 √excess.
        assert!(distance < 0.6 * excess.sqrt(), "{distance}");
    }
}

/// Where the orbit sticks for a good part of its period, too.
#[test]
fn sensitivities_through_sliding_agree_with_differences() {
    let options = Options::with_tolerance(1e-12);
    let force = 1.3 * onset();
    let start = settled(force, &options);
    let (found, _) = monodromy(force, &options);
    let end = |by: [f64; 2]| {
        let start = Start { state: start.state + State::from(by), ..start };
        let system = Filippov(Driven(force));
        run(Dop853, &system, start, start.s + PERIOD, &options, &mut ()).unwrap().state
    };
    for j in 0..2 {
        let mut by = [0.0; 2];
        by[j] = 1e-5;
        let difference = (end(by) - end(by.map(|by| -by))) / 2e-5;
        assert!((difference - found.column(j)).amax() < 1e-8, "{difference} {found}");
    }
}
