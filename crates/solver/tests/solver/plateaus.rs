//! Guards that are zero on a stretch, that touch zero with a kink, or that leave it without a
//! slope, along y' = 1.

use stickslip_solver::{
    Closures, Direction, EmbeddedPair, Guard, HybridSystem, Number, Options, Outcome,
    ReadableSystem, RunError, State,
};

use super::runs::{Log, at, close, fixed};
use crate::erased::run_with;

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
    /// Zero up to a place, and then falling.
    Behind(f64),
    /// Zero up to 1, and then −1, −2 …
    Steps,
    /// Zero but around a place, where it falls to −1/200 and rises again.
    Notch(f64),
}

impl Shape {
    fn of<T: Number>(self, y: T) -> T {
        let x = -y + 1.0;
        match self {
            Self::DeadZone => x - x.max(T::from(-0.2)).min(T::from(0.2)),
            Self::Excess => (x.abs() - 0.2).max(T::from(0.0)),
            Self::Power(power) => y.powf(power) * (-y + 0.6),
            Self::Kink => y.abs() * (-y + 0.6),
            Self::Behind(place) => -(y - place).max(T::from(0.0)),
            Self::Steps => -y.floor(),
            Self::Notch(place) => -(-(y - place).abs() + 0.005).max(T::from(0.0)),
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
    pair: EmbeddedPair,
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
fn each_step(mut check: impl FnMut(EmbeddedPair, Options)) {
    for k in 1..=60 {
        let h = 0.0166 * f64::from(k);
        for pair in EmbeddedPair::ALL {
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
fn a_guard_that_starts_on_a_plateau_fires_where_it_leaves_it() {
    let mut random = fastrand::Rng::with_seed(5);
    each_step(|pair, options| {
        let place = 0.1 + 0.8 * random.f64();
        let shapes = [
            (Shape::Behind(place), place),
            (Shape::Steps, 1.0),
            (Shape::Notch(place), place - 0.005),
        ];
        for (shape, leaves) in shapes {
            for direction in [Direction::Below, Direction::Falling, Direction::Either] {
                for order in 0..=1 {
                    let guard = Guard::new(direction).from_zero(order).terminal();
                    let found = places(pair, &Readable(shape, guard), (0.05, 2.0), &options);
                    let found = found.unwrap_or_else(|error| panic!("{shape:?} {error}"));
                    close(&found, &[leaves - 0.05], 1e-14);
                }
            }
            // It comes back to zero at most.
            let rising = Readable(shape, Guard::new(Direction::Rising).terminal());
            let found = places(pair, &rising, (0.05, 2.0), &options).unwrap();
            assert!(found.is_empty(), "{shape:?} {found:?} {options:?}");
        }
    });
}

/// 1 − ⌊y⌋ from y = 1, beside which it jumps.
#[test]
fn a_guard_that_starts_at_the_edge_of_a_plateau_leaves_it_at_its_end() {
    each_step(|pair, options| {
        for direction in [Direction::Below, Direction::Falling] {
            let system = Readable(Shape::Steps, Guard::new(direction).terminal());
            let found = places(pair, &system, (0.0, 3.0), &options);
            close(&found.unwrap_or_else(|error| panic!("{error}")), &[1.0], 1e-14);
        }
    });
}

#[test]
fn a_black_box_that_starts_on_a_plateau_is_an_error_or_right() {
    for step in [0.03, 0.1, 0.25, 1.0, f64::INFINITY] {
        for pair in EmbeddedPair::ALL {
            let options = Options { max_step: step, ..Options::default() };
            for direction in [Direction::Falling, Direction::Rising, Direction::Either] {
                let system = black_box(direction, |y| (y - 0.25).max(0.0));
                match places(pair, &system, (0.05, 1.0), &options) {
                    Ok(found) => {
                        let rises = direction != Direction::Falling;
                        let right = found.iter().all(|s| rises && (s - 0.2).abs() < 1e-9);
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
            for pair in EmbeddedPair::ALL {
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
            for pair in EmbeddedPair::ALL {
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
        for pair in EmbeddedPair::ALL {
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
