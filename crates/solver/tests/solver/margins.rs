//! Margins with a closed form.

use stickslip_solver::{Direction, Dop853, Guard, HybridSystem, Options, Place, Start, State};

use crate::erased::{margin, margins};

/// A body that is dropped, with g = 1.
struct Drop;

impl HybridSystem<2, 1> for Drop {
    type Mode = ();

    fn field(&self, (): (), _s: f64, y: &State<2>) -> State<2> {
        State::from([y[1], -1.0])
    }

    fn guards(&self, (): ()) -> [Guard; 1] {
        [Guard::new(Direction::Below)]
    }

    fn guard_values(&self, (): (), _s: f64, y: &State<2>) -> [f64; 1] {
        [y[0]]
    }

    fn transition(&self, (): (), _guard: usize, _s: f64, y: &State<2>) -> ((), State<2>) {
        ((), State::from([0.0, -0.5 * y[1]]))
    }
}

/// The height at the end of a run of length 1 is h − 1/2, also below the floor.
#[test]
fn the_end_of_the_span_leaves_a_margin() {
    let start = |height| Start { mode: (), s: 0.0, state: State::from([height, 0.0]) };
    let options = Options::with_tolerance(1e-14);
    let free = margins(Dop853, &Drop, start(0.6), 1.0, &options).unwrap();
    let [start_of_fall, miss] = &free.near_misses[..] else { panic!("{:?}", free.near_misses) };
    assert_eq!(start_of_fall.margin.place, Place::Start { derivative: 0 });
    assert_eq!((start_of_fall.s, start_of_fall.value), (0.0, 0.6));
    assert_eq!(miss.margin.place, Place::End);
    assert!((miss.value - 0.1).abs() < 1e-15, "{}", miss.value);
    for height in [0.4, 0.5, 0.6] {
        let miss = margin(Dop853, &Drop, start(height), 1.0, &options, &miss.margin).unwrap();
        let value = miss.expect("a margin").value;
        // Measured: 1.0e-15.
        assert!((value - (height - 0.5)).abs() < 2e-15, "{height}: {value}");
    }
    // After a bounce, the next flight ends in the air.
    let free = margins(Dop853, &Drop, start(0.4), 1.0, &options).unwrap();
    assert_eq!(free.fired, [0]);
    assert!(
        free.near_misses.iter().any(|miss| miss.margin.place == Place::End && miss.value > 0.0)
    );
}

/// A margin that belongs to another system.
#[test]
fn a_guard_that_the_system_does_not_have_has_no_margin() {
    let start = || Start { mode: (), s: 0.0, state: State::from([0.6, 0.0]) };
    let options = Options::default();
    let free = margins(Dop853, &Drop, start(), 1.0, &options).unwrap();
    let mut other = free.near_misses[0].margin.clone();
    other.guard = 1;
    assert_eq!(margin(Dop853, &Drop, start(), 1.0, &options, &other), Ok(None));
}

/// Its guard is y (p + (y − 1)²), which starts from zero, and y is the time.
struct FromZero(f64);

impl HybridSystem<1, 1> for FromZero {
    type Mode = ();

    fn field(&self, (): (), _s: f64, _y: &State<1>) -> State<1> {
        State::from([1.0])
    }

    fn guards(&self, (): ()) -> [Guard; 1] {
        [Guard::new(Direction::Below).from_zero(1)]
    }

    fn guard_values(&self, (): (), _s: f64, y: &State<1>) -> [f64; 1] {
        [y[0] * (self.0 + (y[0] - 1.0).powi(2))]
    }

    fn transition(&self, (): (), _guard: usize, _s: f64, y: &State<1>) -> ((), State<1>) {
        ((), *y)
    }
}

/// Where the zero at the start is divided out, the least value is p at time 1, for every p. The
/// guard itself has no minimum above p = 1/3, and a margin with no smooth continuation near it.
#[test]
fn the_zero_at_the_start_of_a_phase_is_divided_out() {
    let start = || Start { mode: (), s: 0.0, state: State::from([0.0]) };
    let options = Options::with_tolerance(1e-14);
    let free = margins(Dop853, &FromZero(0.5), start(), 2.0, &options).unwrap();
    let is_minimum = |place| matches!(place, Place::Minimum { .. });
    let found = free.near_misses.iter().find(|miss| is_minimum(miss.margin.place)).unwrap();
    for p in [-0.4, -1e-9, 0.0, 1e-9, 0.3, 0.4, 0.9] {
        let found = margin(Dop853, &FromZero(p), start(), 2.0, &options, &found.margin).unwrap();
        let miss = found.expect("a margin");
        let errors = [miss.value - p, miss.s - 1.0];
        assert!(errors[0].abs() < 1e-13 && errors[1].abs() < 1e-9, "{p}: {errors:?}");
    }
}
