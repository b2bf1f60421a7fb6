//! Guards that are zero on a stretch, that touch zero with a kink, or that leave it without a slope,
//! along y' = 1.

use stickslip_solver::{
    Closures, Direction, Dop853, Dopri5, Guard, HybridSystem, Number, Options, Outcome, Pair,
    ReadableSystem, RunError, State, StepSize, run_with,
};

use super::runs::{Log, at, close, fixed};

/// What the guard is of y.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    /// x = 1 − y without its values from −1/5 to 1/5, which are zero.
    DeadZone,
    /// What |1 − y| exceeds 1/5 by, and zero otherwise.
    Excess,
    /// y to a power, times 0.6 − y.
    Power(f64),
    /// |y| (0.6 − y).
    Kink,
}

impl Shape {
    fn of<T: Number>(self, y: T) -> T {
        let x = -y + 1.0;
        match self {
            Self::DeadZone => x - x.max(T::from(-0.2)).min(T::from(0.2)),
            Self::Excess => (x.abs() - 0.2).max(T::from(0.0)),
            Self::Power(power) => y.powf(power) * (-y + 0.6),
            Self::Kink => y.abs() * (-y + 0.6),
        }
    }
}

#[derive(Clone, Copy, Debug)]
struct Readable(Shape, Guard);

impl ReadableSystem<1, 1> for Readable {
    type Mode = ();

    fn field<T: Number>(&self, (): (), _s: T, _y: &[T; 1]) -> [T; 1] {
        [T::from(1.0)]
    }

    fn guards(&self, (): ()) -> [Guard; 1] {
        [self.1]
    }

    fn guard_values<T: Number>(&self, (): (), _s: T, y: &[T; 1]) -> [T; 1] {
        [self.0.of(y[0])]
    }
}

fn black_box(
    direction: Direction,
    value: impl Fn(f64) -> f64,
) -> impl HybridSystem<1, 1, Mode = ()> {
    Closures::new(|_s, _y: &State<1>| State::from([1.0]))
        .guards([Guard::new(direction)], move |_s, y| [value(y[0])])
}

/// The places where the guard fires up to s = `end`.
fn places(
    pair: Pair,
    system: &impl HybridSystem<1, 1, Mode = ()>,
    (start, end): (f64, f64),
    options: &Options,
) -> Result<Vec<f64>, RunError> {
    let mut log = Log::default();
    let run = run_with(pair, system, at(0.0, [start]), end, options, &mut log)?;
    assert!(matches!(run.outcome, Outcome::ReachedEnd | Outcome::EndedByGuard { .. }));
    Ok(log.places())
}

/// Steps that end on the plateau, and everywhere else.
fn each_step(mut check: impl FnMut(Pair, Options)) {
    for k in 1..=60 {
        let h = 0.0166 * f64::from(k);
        for pair in Pair::ALL {
            check(pair, Options { max_step: h, ..Options::default() });
            check(pair, fixed(h));
        }
    }
}

#[test]
fn a_guard_leaves_a_plateau_on_the_side_where_it_does() {
    each_step(|pair, options| {
        let falls = Readable(Shape::DeadZone, Guard::new(Direction::Falling));
        let found = places(pair, &falls, (0.0, 3.0), &options).unwrap();
        assert!(
            found.len() == 1 && (0.8..=1.2 + 1e-9).contains(&found[0]),
            "{found:?} {options:?}"
        );
        for direction in [Direction::Falling, Direction::Rising] {
            let never = Readable(Shape::Excess, Guard::new(direction));
            let found = places(pair, &never, (0.0, 3.0), &options).unwrap();
            assert!(found.is_empty(), "{direction:?} {found:?} {options:?}");
            let never = black_box(direction, |y| Shape::Excess.of(y));
            let found = places(pair, &never, (0.0, 3.0), &options).unwrap();
            assert!(found.is_empty(), "black box, {direction:?} {found:?} {options:?}");
        }
    });
}

#[test]
fn a_black_box_that_starts_on_a_plateau_is_an_error_or_right() {
    for step in [0.03, 0.1, 0.25, 1.0, f64::INFINITY] {
        for pair in Pair::ALL {
            let options = Options { max_step: step, ..Options::default() };
            for direction in [Direction::Falling, Direction::Rising, Direction::Either] {
                let system = black_box(direction, |y| (y - 0.25).max(0.0));
                match places(pair, &system, (0.05, 1.0), &options) {
                    Ok(found) => {
                        let right =
                            found.is_empty() || found.iter().all(|s| (s - 0.2).abs() < 1e-9);
                        assert!(right, "{found:?} {direction:?} {step}");
                    }
                    Err(error) => {
                        let expected = matches!(error, RunError::GuardIdenticallyZero { .. });
                        assert!(expected, "{error} {direction:?} {step}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_touch_with_a_kink_does_not_fire() {
    let mut random = fastrand::Rng::with_seed(4);
    for _ in 0..300 {
        let c = random.f64();
        for options in [Options::default(), fixed(0.3), fixed(0.07)] {
            for pair in Pair::ALL {
                for direction in [Direction::Falling, Direction::Rising, Direction::Below] {
                    let system = black_box(direction, |y| (y - c).abs());
                    let found = places(pair, &system, (0.0, 1.0), &options).unwrap();
                    assert!(found.is_empty(), "{c} {direction:?} {options:?} {found:?}");
                    let system = black_box(direction, |y| (3.0 * (y - c)).sin().abs() + 1e-17);
                    let found = places(pair, &system, (0.0, 1.0), &options).unwrap();
                    assert!(found.is_empty(), "{c} {direction:?} {options:?} {found:?}");
                }
            }
        }
    }
}

#[test]
fn a_guard_leaves_zero_without_a_slope() {
    let shapes = [0.1, 0.5, 1.5, 2.5, 3.5].map(Shape::Power);
    for shape in shapes.into_iter().chain([Shape::Kink]) {
        for options in [Options::default(), Options::with_tolerance(1e-5), fixed(0.1), fixed(1.0)] {
            for pair in Pair::ALL {
                for order in 0..=2 {
                    let guard = Guard::new(Direction::Below).from_zero(order).terminal();
                    let system = Readable(shape, guard);
                    let found = places(pair, &system, (0.0, 1.0), &options);
                    let found = found.unwrap_or_else(|error| panic!("{system:?} {error}"));
                    close(&found, &[0.6], 1e-9);
                }
            }
        }
    }
}

#[test]
fn a_black_box_that_leaves_an_undeclared_double_zero_does_not_fire_there() {
    for tolerance in [1e-4, 1e-8, 1e-12] {
        for pair in Pair::ALL {
            for direction in [Direction::Below, Direction::Falling] {
                let options = Options::with_tolerance(tolerance);
                let system = black_box(direction, |y| 1.0 - y.cos());
                match places(pair, &system, (0.0, 3.0), &options) {
                    Ok(found) => assert!(found.is_empty(), "{found:?} {direction:?} {tolerance}"),
                    // Its first values are zero by rounding.
                    Err(error) => {
                        assert!(matches!(error, RunError::GuardIdenticallyZero { .. }), "{error}");
                    }
                }
            }
        }
    }
}

/// Steps whose sum is the span only to within rounding end exactly at its end.
#[test]
fn a_guard_fires_at_the_end_of_a_span_that_steps_divide() {
    for n in 1..=100 {
        let steps = f64::from(n);
        for (h, end) in [(0.1, 0.1 * steps), (1.0 / steps, 1.0)] {
            let along = Options { max_step: h, first_step: Some(h), ..Options::default() };
            for options in [fixed(h), along] {
                for pair in Pair::ALL {
                    let system = Closures::new(|_s, _y: &State<1>| State::from([1.0]))
                        .guards([Guard::new(Direction::Rising).terminal()], move |s, _y| [s - end]);
                    let found = run_with(pair, &system, at(0.0, [0.0]), end, &options, &mut ());
                    let outcome = found.unwrap().outcome;
                    assert_eq!(outcome, Outcome::EndedByGuard { guard: 0 }, "{n} {options:?}");
                }
            }
        }
    }
}

/// A mode counts what a guard does that all modes share.
#[derive(Clone, Copy, Debug)]
struct Counts(bool, Direction);

impl HybridSystem<1, 1> for Counts {
    type Mode = usize;

    fn field(&self, _mode: usize, _s: f64, _y: &State<1>) -> State<1> {
        State::from([1.0])
    }

    fn guards(&self, _mode: usize) -> [Guard; 1] {
        [Guard::new(self.1)]
    }

    fn guard_values(&self, _mode: usize, _s: f64, y: &State<1>) -> [f64; 1] {
        [if self.0 { y[0].sin() } else { y[0] - 1.0 }]
    }

    fn transition(&self, mode: usize, _: usize, _s: f64, y: &State<1>) -> (usize, State<1>) {
        (mode + 1, *y)
    }
}

#[test]
fn a_guard_that_all_modes_share_fires_once() {
    for pair in Pair::ALL {
        for tolerance in [1e-4, 1e-6, 1e-8, 1e-10, 1e-12] {
            for step_size in [StepSize::Adaptive, StepSize::Fixed(0.37)] {
                let options = Options { step_size, ..Options::with_tolerance(tolerance) };
                for (system, end, count) in [
                    (Counts(true, Direction::Falling), 100.0, 16),
                    (Counts(true, Direction::Either), 100.0, 31),
                    (Counts(false, Direction::Rising), 2.0, 1),
                    (Counts(false, Direction::Either), 2.0, 1),
                ] {
                    let start =
                        stickslip_solver::Start { mode: 0, s: 0.0, state: State::from([0.5]) };
                    let run = run_with(pair, &system, start, end, &options, &mut ()).unwrap();
                    assert_eq!((run.outcome, run.mode), (Outcome::ReachedEnd, count), "{system:?}");
                }
            }
        }
    }
}

/// A long rest and then a relay, which switches at equal distances.
struct Relay(f64, f64);

impl HybridSystem<1, 1> for Relay {
    type Mode = i8;

    fn field(&self, mode: i8, _s: f64, _y: &State<1>) -> State<1> {
        State::from([f64::from(mode)])
    }

    fn guards(&self, _mode: i8) -> [Guard; 1] {
        [Guard::new(Direction::Below)]
    }

    fn guard_values(&self, mode: i8, s: f64, y: &State<1>) -> [f64; 1] {
        [match mode {
            0 => self.0 - s,
            1 => self.1 - y[0],
            _ => y[0] + self.1,
        }]
    }

    fn transition(&self, mode: i8, _: usize, _s: f64, y: &State<1>) -> (i8, State<1>) {
        (if mode == 1 { -1 } else { 1 }, *y)
    }
}

#[test]
fn equal_gaps_after_a_rest_do_not_accumulate() {
    for (rest, band, end) in
        [(1000.0, 5e-6, 1000.001), (1.0, 5e-9, 1.000_001), (1e5, 5e-4, 1e5 + 0.1)]
    {
        let start = stickslip_solver::Start { mode: 0, s: 0.0, state: State::from([0.0]) };
        let system = Relay(rest, band);
        let run = stickslip_solver::run(Dop853, &system, start, end, &Options::default(), &mut ());
        let run = run.unwrap();
        assert_eq!(run.outcome, Outcome::ReachedEnd);
        assert!((95..=105).contains(&run.statistics.switches), "{:?}", run.statistics);
    }
}

#[test]
fn a_guard_without_a_value_is_called_so() {
    let system = black_box(Direction::Falling, |y| (0.5 - y).sqrt() + 1.0);
    let run =
        stickslip_solver::run(Dopri5, &system, at(0.0, [0.0]), 1.0, &Options::default(), &mut ());
    let error = run.unwrap_err();
    assert!(matches!(error, RunError::GuardNotANumber { guard: 0, .. }), "{error}");
}
