//! Guards in which rounding makes stairs: of exp(x) − 1 or (x + 1000) − 1000 the last digit of the
//! larger number is left, however small x is. Where such a guard is zero is known to a stair only,
//! though on the stair it shows no noise.

use stickslip_solver::{
    Direction, Dop853, Dopri5, Guard, HybridSystem, Method, Number, Options, ReadableSystem, Start,
    State,
};

use crate::black_box::BlackBox;
use crate::erased::run;

const RISING: Guard = Guard::new(Direction::Rising);

/// The number in which a run from (0, 1) to `end` counts what has acted, NaN if it is refused.
fn count(method: impl Method, system: &impl HybridSystem<2, 2, Mode = u8>, end: f64) -> f64 {
    let start = Start { mode: 0, s: 0.0, state: State::from([0.0, 1.0]) };
    run(method, system, start, end, &Options::default(), &mut ())
        .map_or(f64::NAN, |end| end.state[1])
}

/// The same by both methods, and as a black box.
fn counts(system: &impl HybridSystem<2, 2, Mode = u8>, end: f64) -> [f64; 4] {
    let black_box = BlackBox(system);
    [
        count(Dop853, system, end),
        count(Dopri5, system, end),
        count(Dop853, &black_box, end),
        count(Dopri5, &black_box, end),
    ]
}

/// Two guards with one zero of x, x′ = 1. The one with stairs acts first, and doubles the count;
/// the other one adds 1.
struct Together {
    place: f64,
}

impl ReadableSystem<2, 2> for Together {
    type Mode = u8;

    fn field<T: Number>(&self, _: u8, _: T, _: &[T; 2]) -> [T; 2] {
        [T::from(1.0), T::from(0.0)]
    }

    fn guards(&self, _: u8) -> [Guard; 2] {
        [RISING, RISING.priority(1)]
    }

    fn guard_values<T: Number>(&self, _: u8, _: T, &[x, _]: &[T; 2]) -> [T; 2] {
        [x - self.place, (x - self.place).exp() - 1.0]
    }

    fn transition(&self, _: u8, guard: usize, _: f64, y: &State<2>) -> (u8, State<2>) {
        (0, State::from([y[0], [y[1] + 1.0, 2.0 * y[1]][guard]]))
    }
}

#[test]
fn a_stair_is_an_error_of_the_place_even_where_it_shows_no_noise() {
    let mut refused = 0;
    for k in 8..=40 {
        let place = 1.1e-13 * f64::from(k);
        let counts = counts(&Together { place }, 2.0 * place);
        assert!(counts.iter().all(|&count| count == 3.0 || count.is_nan()), "{place}: {counts:?}");
        refused += counts.iter().filter(|count| count.is_nan()).count();
        assert!(!counts[0].is_nan() && !counts[1].is_nan(), "{place}: {counts:?}");
    }
    assert!(refused < 10, "{refused}");
}

/// Behind the zero of a guard with stairs, another mode is valid from a limit on, which lies at
/// that zero or beyond it by a gap. Where the limit is violated, the count goes up.
struct Valid {
    place: f64,
    offset: f64,
    gap: f64,
}

impl ReadableSystem<2, 2> for Valid {
    type Mode = u8;

    fn field<T: Number>(&self, _: u8, _: T, _: &[T; 2]) -> [T; 2] {
        [T::from(1.0), T::from(0.0)]
    }

    fn guards(&self, mode: u8) -> [Guard; 2] {
        [[RISING, Guard::OFF], [Guard::OFF, Guard::new(Direction::Below)], [Guard::OFF; 2]]
            [usize::from(mode)]
    }

    fn guard_values<T: Number>(&self, _: u8, _: T, &[x, _]: &[T; 2]) -> [T; 2] {
        [(x + self.offset) - (self.place + self.offset), x - (self.place + self.gap)]
    }

    fn transition(&self, mode: u8, guard: usize, _: f64, y: &State<2>) -> (u8, State<2>) {
        (mode + 1, State::from([y[0], y[1] + [0.0, 1.0][guard]]))
    }
}

#[test]
fn an_error_of_the_place_violates_no_limit() {
    for k in 0..40 {
        for offset in [0.0, 16.0, 128.0, 1024.0, 8192.0] {
            // The sum is exact, so that the zero is known.
            let place = 1.0 + f64::from(k) / 64.0;
            let at = |gap| counts(&Valid { place, offset, gap }, 3.0);
            assert_eq!(at(0.0), [1.0; 4], "{place} {offset}");
            assert_eq!(at(1e-9), [2.0; 4], "{place} {offset}");
        }
    }
}

/// A guard acts at a place, and its transition leaves it before its zero by some roundings.
struct Left {
    roundings: f64,
}

impl ReadableSystem<2, 2> for Left {
    type Mode = u8;

    fn field<T: Number>(&self, _: u8, _: T, _: &[T; 2]) -> [T; 2] {
        [T::from(1.0), T::from(0.0)]
    }

    fn guards(&self, _: u8) -> [Guard; 2] {
        [RISING, Guard::OFF]
    }

    fn guard_values<T: Number>(&self, _: u8, _: T, &[x, _]: &[T; 2]) -> [T; 2] {
        [x - 1.5, x]
    }

    fn transition(&self, mode: u8, _: usize, _: f64, y: &State<2>) -> (u8, State<2>) {
        let left = if y[1] == 1.0 { 1.5 - self.roundings * f64::EPSILON } else { y[0] };
        (mode, State::from([left, y[1] + 1.0]))
    }
}

#[test]
fn between_a_zero_that_rounding_has_moved_and_one_that_is_crossed_again_nothing_is_decided() {
    let (mut doubts, mut last) = (0, 1.0);
    for roundings in (0..400).map(f64::from).chain([1e4, 1e6]) {
        let start = Start { mode: 0, s: 0.0, state: State::from([0.0, 1.0]) };
        let end = run(Dop853, &Left { roundings }, start, 3.0, &Options::default(), &mut ());
        let end = end.unwrap();
        let acts = end.state[1] - 1.0;
        if end.decided {
            assert!(acts == last || doubts > 0, "{roundings}: {end:?}");
            last = acts;
        } else {
            doubts += 1;
        }
    }
    assert!(last == 2.0 && doubts < 300, "{last} {doubts}");
}
