//! Margins with a closed form.

use stickslip_solver::{
    Direction, Dop853, Guard, HybridSystem, Options, Place, Start, State, margin, margins,
};

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
