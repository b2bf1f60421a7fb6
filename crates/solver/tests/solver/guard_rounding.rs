//! Guards whose signs are lost in their own rounding. Runs and margins must cope with them.

use std::f64::consts::PI;

use stickslip_solver::margin::{Margins, Place};
use stickslip_solver::{
    Direction, Dop853, Dopri5, Guard, HybridSystem, Method, Options, Outcome, Recorder, RunError,
    Start, State,
};

use crate::black_box::BlackBox;
use crate::erased::{margins, run};

/// A load on a belt of velocity v that is shaken: w′ = v + fΩ sin Ωt − u. Its time scale is
/// `scale`.
struct Belt {
    velocity: f64,
    frequency: f64,
    amplitude: f64,
    observed: f64,
    scale: f64,
    own_rates: bool,
}

impl HybridSystem<2, 2> for Belt {
    type Mode = bool;

    fn field(&self, slips: bool, t: f64, y: &State<2>) -> State<2> {
        let Self { velocity, frequency, amplitude, scale, .. } = *self;
        let rise = velocity - y[0] + amplitude * frequency * (frequency * (t / scale)).sin();
        State::from([if slips { y[1] } else { 0.0 }, rise]) / scale
    }

    fn guards(&self, slips: bool) -> [Guard; 2] {
        let guard = Guard::new(Direction::Below);
        [guard.from_zero(if slips { 2 } else { 0 }), guard.terminal()]
    }

    fn guard_values(&self, slips: bool, t: f64, y: &State<2>) -> [f64; 2] {
        [if slips { y[0] } else { -y[1] }, self.observed - t / self.scale]
    }

    fn guard_rates(&self, slips: bool, t: f64, y: &State<2>) -> [f64; 2] {
        if !self.own_rates {
            return [f64::NAN; 2];
        }
        let rates = self.field(slips, t, y);
        [if slips { rates[0] } else { -rates[1] }, -1.0]
    }

    fn transition(&self, slips: bool, _: usize, _: f64, y: &State<2>) -> (bool, State<2>) {
        (!slips, State::from([0.0, if slips { y[1] } else { 0.0 }]))
    }
}

impl Belt {
    fn start(&self) -> Start<bool, 2> {
        let state = State::from([0.0, -self.amplitude - 1.0]);
        Start { mode: false, s: 0.0, state }
    }

    fn margins(&self) -> Margins {
        let options = Options::with_tolerance(1e-14);
        margins(Dop853, self, self.start(), f64::INFINITY, &options).expect("margins")
    }
}

/// If fΩ is a little above v, the excess w = vt − f cos Ωt − 1 of the load has extrema at sin Ωt =
/// −v/fΩ. Its rate there is the difference of two terms of size 0.5.
#[test]
fn a_rate_that_is_a_difference_of_large_terms_still_shows_its_minimum() {
    for own_rates in [true, false] {
        for away in [0.0, 1e-15, -1e-15, 1e-12, -1e-12, 3e-12, 1e-10, -1e-10, 1e-9, -1e-9, 1e-8] {
            let belt = Belt {
                velocity: 0.5,
                frequency: 2.356194490307652,
                amplitude: 0.2122066123829874 + away,
                observed: 12.0,
                scale: 1.0,
                own_rates,
            };
            let Belt { velocity, frequency, amplitude, .. } = belt;
            let sine = velocity / (amplitude * frequency);
            let minimum = (PI + sine.asin()) / frequency;
            let value = 1.0 + amplitude * (frequency * minimum).cos() - velocity * minimum;
            let found = belt.margins();
            let is_minimum = |place| matches!(place, Place::Minimum { .. });
            let mut misses = found.near_misses.iter();
            let first = misses.find(|miss| is_minimum(miss.margin.place)).expect("a minimum");
            assert!(first.margin.exits.is_empty());
            // Measured: 1.5e-13 and 1.7e-15. The first is the rounding of 0.5 divided by the
            // curvature, which is 5e-4.
            assert!((first.s - minimum).abs() < 3e-13, "{own_rates} {away}");
            assert!((first.value - value).abs() < 4e-15, "{own_rates} {away}");
            assert_eq!(found.outcome, Outcome::EndedByGuard { guard: 1 });
        }
    }
}

/// Margins are the same with and without rates of the system, also on other time scales.
#[test]
fn margins_by_differences_are_those_by_rates() {
    let mut random = fastrand::Rng::with_seed(3);
    let (mut compared, mut largest) = (0, 0.0_f64);
    for scale in [1.0, 1e-6, 1e3] {
        for _ in 0..300 {
            let belt = |own_rates, scale, frequency, amplitude| Belt {
                velocity: 0.3,
                frequency,
                amplitude,
                observed: 18.0,
                scale,
                own_rates,
            };
            let (frequency, amplitude) = (0.3 + 0.3 * random.f64(), 0.1 + 0.89 * random.f64());
            let by_rates = belt(true, 1.0, frequency, amplitude).margins();
            let by_differences = belt(false, scale, frequency, amplitude).margins();
            assert_eq!(by_rates.fired, by_differences.fired);
            assert_eq!(by_rates.near_misses.len(), by_differences.near_misses.len());
            for (one, other) in by_rates.near_misses.iter().zip(&by_differences.near_misses) {
                assert_eq!(one.margin, other.margin);
                // Derivatives are rates, each on its own scale of time.
                if let Place::Start { derivative: 1.. } = one.margin.place {
                    assert_eq!(one.value > 0.0, other.value > 0.0, "{scale} {one:?} {other:?}");
                    continue;
                }
                // Extrema of slip are divided by the square of the time since its start.
                let is_divided =
                    matches!(one.margin.place, Place::Minimum { .. } | Place::Maximum { .. })
                        && one.margin.exits.len() % 2 == 1;
                let unit = if is_divided { scale * scale } else { 1.0 };
                largest = largest.max((one.value - other.value * unit).abs());
                compared += 1;
            }
        }
    }
    // Measured: 1.1e-14 over 1288 margins.
    assert!(compared > 1000 && largest < 3e-14, "{compared} {largest:e}");
}

/// y′ = 1 with the guard 0.5 + e + 0.5 cos y. It dips below zero at π if e < 0, and its rounding is
/// that of 0.5.
struct Dip {
    raised: f64,
    direction: Direction,
}

impl HybridSystem<1, 1> for Dip {
    type Mode = ();

    fn field(&self, (): (), _s: f64, _y: &State<1>) -> State<1> {
        State::from([1.0])
    }

    fn guards(&self, (): ()) -> [Guard; 1] {
        [Guard::new(self.direction)]
    }

    fn guard_values(&self, (): (), _s: f64, y: &State<1>) -> [f64; 1] {
        [0.5 + self.raised + 0.5 * y[0].cos()]
    }

    fn transition(&self, (): (), _guard: usize, _s: f64, y: &State<1>) -> ((), State<1>) {
        ((), *y)
    }
}

fn crossings<M: Method>(method: M, dip: &Dip, y: f64, options: &Options) -> Vec<f64> {
    let mut recorder = Recorder::default();
    let start = Start { mode: (), s: 0.0, state: State::from([y]) };
    let end =
        run(method, &BlackBox(dip), start, 0.02, options, &mut recorder).expect("a smooth guard");
    assert_eq!(end.outcome, Outcome::ReachedEnd);
    recorder.switches.iter().map(|switch| switch.before[0] - PI).collect()
}

#[test]
fn a_dip_of_rounding_depth_is_not_identically_zero() {
    for max_step in [f64::INFINITY, 1e-3, 1e-4, 1e-5] {
        let options = Options { max_step, ..Options::default() };
        for y in [3.13, 3.131, 3.1359] {
            for raised in [0.0, 1e-17, 1e-16, -1e-16, 1e-14, -1e-14, 1e-13, -1e-13, -1e-12] {
                for direction in [Direction::Falling, Direction::Rising, Direction::Either] {
                    let dip = Dip { raised, direction };
                    let expected = match direction {
                        _ if raised > -1e-14 => 0,
                        Direction::Either => 2,
                        _ => 1,
                    };
                    for found in
                        [crossings(Dopri5, &dip, y, &options), crossings(Dop853, &dip, y, &options)]
                    {
                        let name = format!("{direction:?} {raised:e} {y} {max_step:e}: {found:?}");
                        // A dip whose depth is that of the rounding may be found or not.
                        if raised.abs() > 2e-16 || raised >= 0.0 {
                            assert_eq!(found.len(), expected, "{name}");
                        }
                        // Half the width of the dip, widened by the rounding of 0.5.
                        let width = (4.0 * (raised.abs() + 2e-16)).sqrt();
                        assert!(
                            found.iter().all(|from_middle| from_middle.abs() < width),
                            "{name}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn a_guard_that_is_zero_throughout_is_an_error_with_any_step() {
    struct Zero;
    impl HybridSystem<1, 1> for Zero {
        type Mode = ();
        fn field(&self, (): (), _s: f64, y: &State<1>) -> State<1> {
            -y
        }
        fn guards(&self, (): ()) -> [Guard; 1] {
            [Guard::new(Direction::Falling)]
        }
        fn guard_values(&self, (): (), _s: f64, y: &State<1>) -> [f64; 1] {
            [y[0] - y[0]]
        }
        fn transition(&self, (): (), _: usize, _: f64, y: &State<1>) -> ((), State<1>) {
            ((), *y)
        }
    }
    for max_step in [f64::INFINITY, 1e-3, 1e-9] {
        let options = Options { max_step, ..Options::default() };
        let start = Start { mode: (), s: 0.0, state: State::from([1.0]) };
        let end = run(Dop853, &Zero, start, 1.0, &options, &mut ());
        assert_eq!(end.err(), Some(RunError::GuardIdenticallyZero { guard: 0, s: 0.0 }));
    }
}
