//! The rules for guards: which of several guards fires, known zeros, guards that start negative,
//! and guards that have no meaning.

use stickslip_solver::{
    Direction, Dop853, Dopri5, Guard, HybridSystem, Method, Observer, Options, Outcome, RunError,
    Start, State, SwitchEvent,
};

use super::planted::{Planted, Times, step_sizes, times};
use crate::black_box::BlackBox;
use crate::erased::run;

/// y' = 1 with two guards.
struct Two {
    values: fn(f64) -> [f64; 2],
    guards: [Guard; 2],
}

impl HybridSystem<1, 2> for Two {
    type Mode = ();

    fn field(&self, (): (), _s: f64, _y: &State<1>) -> State<1> {
        State::from([1.0])
    }

    fn guards(&self, (): ()) -> [Guard; 2] {
        self.guards
    }

    fn guard_values(&self, (): (), _s: f64, y: &State<1>) -> [f64; 2] {
        (self.values)(y[0])
    }

    fn transition(&self, (): (), _guard: usize, _s: f64, y: &State<1>) -> ((), State<1>) {
        ((), *y)
    }
}

/// The switches of a run: the place, the guard, and the other guards that were at zero.
#[derive(Debug, Default, PartialEq)]
struct Fired(Vec<(f64, usize, u64)>);

impl<Mode, const N: usize> Observer<Mode, N> for Fired {
    fn on_switch(&mut self, event: &SwitchEvent<Mode, N>) {
        self.0.push((event.s, event.guard, event.simultaneous));
    }
}

fn first_of_two<M: Method>(
    method: M,
    values: fn(f64) -> [f64; 2],
    guards: [Guard; 2],
    options: &Options,
) -> (f64, usize, u64) {
    let system = Two { values, guards };
    let mut fired = Fired::default();
    let start = Start { mode: (), s: 0.0, state: State::from([0.0]) };
    let end = run(method, &BlackBox(&system), start, 1.0, options, &mut fired).expect("planted");
    let first = fired.0[0];
    assert_eq!(end.outcome, Outcome::EndedByGuard { guard: first.1 });
    first
}

#[test]
fn of_two_guards_the_earlier_fires_and_of_equal_ones_the_first() {
    let guard = Guard::new(Direction::Falling).terminal();
    for options in step_sizes() {
        let check = |values, guards, expected: (f64, usize, u64)| {
            for found in [
                first_of_two(Dopri5, values, guards, &options),
                first_of_two(Dop853, values, guards, &options),
            ] {
                assert!((found.0 - expected.0).abs() < 1e-15, "{found:?} {options:?}");
                assert_eq!((found.1, found.2), (expected.1, expected.2), "{options:?}");
            }
        };
        let both = |values: fn(f64) -> [f64; 2], expected| check(values, [guard; 2], expected);
        // At equal places the guard that is listed first decides, whichever is steeper. The other
        // one is reported as simultaneous.
        both(|s| [0.43 - s, 2.0 * (0.43 - s)], (0.43, 0, 0b10));
        both(|s| [(0.43 - s) * (1.0 + s), 0.43 - s], (0.43, 0, 0b10));
        // A guard that yields is reported as simultaneous, and fires only if it is earlier.
        let yielding = [guard.priority(-1), guard];
        check(|s| [0.43 - s, 2.0 * (0.43 - s)], yielding, (0.43, 1, 0b01));
        check(|s| [(0.43 - s) * (1.0 + s), 0.43 - s], yielding, (0.43, 1, 0b01));
        check(|s| [0.37 - s, 0.43 - s], yielding, (0.37, 0, 0));
        check(|s| [0.43 - s, 0.43 - s], [guard.priority(-1); 2], (0.43, 0, 0b10));
        // At different places the earlier guard fires, wherever it is listed.
        both(|s| [0.43 - s, 0.37 - s], (0.37, 1, 0));
        both(|s| [0.37 - s, 0.43 - s], (0.37, 0, 0));
        both(|s| [0.43 + 1e-9 - s, 0.43 - s], (0.43, 1, 0));
        both(|s| [0.43 - s, 0.43 + 1e-9 - s], (0.43, 0, 0));
        // The second guard has a pair of roots before the root of the first guard.
        both(|s| [0.43 - s, (s - 0.2) * (s - 0.2001)], (0.2, 1, 0));
    }
}

#[test]
fn a_known_zero_at_the_start_does_not_fire_and_hides_nothing() {
    let start = Start { mode: (), s: 0.0, state: State::from([0.0]) };
    for options in step_sizes() {
        let fired = |value: fn(f64) -> f64, order: u32, direction: Direction| {
            let guard = Guard::new(direction).from_zero(order).terminal();
            let system = Planted::new(&value, guard);
            let (mut a, mut b) = (Times::default(), Times::default());
            let one =
                run(Dopri5, &BlackBox(&system), start, 1.0, &options, &mut a).expect("planted");
            let other =
                run(Dop853, &BlackBox(&system), start, 1.0, &options, &mut b).expect("planted");
            assert_eq!(one.outcome, other.outcome);
            assert_eq!(a.switches.len(), b.switches.len());
            a.switches.into_iter().chain(b.switches).fold(None, |_, s| Some(s))
        };
        for direction in [Direction::Below, Direction::Falling] {
            // These guards leave a simple and a double zero upwards, and fall at 0.61.
            let simple = fired(|s| s * (0.61 - s), 1, direction);
            let double = fired(|s| s * s * (0.61 - s), 2, direction);
            for found in [simple, double] {
                assert!((found.expect("falls") - 0.61).abs() < 1e-15, "{found:?} {options:?}");
            }
        }
        // These guards leave the zero downwards. A bound of the domain then fires at once, and a
        // falling guard waits.
        assert_eq!(fired(|s| -s * (0.61 - s), 1, Direction::Below), Some(0.0));
        assert_eq!(fired(|s| -s * s * (0.61 - s), 2, Direction::Below), Some(0.0));
        assert_eq!(fired(|s| -s * (0.61 - s), 1, Direction::Falling), None);
        assert_eq!(fired(|s| -s * s * (0.61 - s), 2, Direction::Falling), None);
        let rises = fired(|s| -s * s * (0.61 - s), 2, Direction::Rising).expect("rises");
        assert!((rises - 0.61).abs() < 1e-15);
        // The pair of roots right after the zero is not mistaken for the zero.
        let near = fired(|s| s * (1e-3 - s) * (2e-3 - s), 1, Direction::Falling).expect("falls");
        assert!((near - 1e-3).abs() < 1e-15, "{near} {options:?}");
    }
}

#[test]
fn a_guard_that_starts_negative_fires_by_its_direction() {
    for options in step_sizes() {
        let fired = |direction: Direction| {
            let value = |s: f64| (s - 0.31) * (0.72 - s);
            let system = Planted::new(&value, Guard::new(direction).terminal());
            let start = Start { mode: (), s: 0.0, state: State::from([0.0]) };
            run(Dop853, &BlackBox(&system), start, 1.0, &options, &mut ()).expect("planted").s
        };
        let expected = [
            (Direction::Below, 0.0),
            (Direction::Falling, 0.72),
            (Direction::Rising, 0.31),
            (Direction::Either, 0.31),
            (Direction::Off, 1.0),
        ];
        for (direction, s) in expected {
            assert!((fired(direction) - s).abs() < 1e-15, "{direction:?} {options:?}");
        }
    }
}

#[test]
fn guards_without_a_meaning_are_errors() {
    for options in step_sizes() {
        let zero = times(Dop853, |_| 0.0, Direction::Falling, &options);
        assert_eq!(zero, Err(RunError::GuardIdenticallyZero { guard: 0, s: 0.0 }), "{options:?}");
        let nan = times(Dop853, |_| f64::NAN, Direction::Falling, &options);
        assert_eq!(nan, Err(RunError::GuardNotANumber { guard: 0, s: 0.0 }), "{options:?}");
        // A guard whose domain ends without a switch. The error tells where.
        match times(Dop853, |s| 1.0 + (0.5 - s).sqrt(), Direction::Falling, &options) {
            Err(
                RunError::GuardUnresolved { guard: 0, s, .. }
                | RunError::GuardNotANumber { guard: 0, s },
            ) => assert!((s - 0.5).abs() < 1e-9, "{s} {options:?}"),
            other => panic!("{other:?}"),
        }
        // The same domain, but the guard ends the run 1e-6 and 1e-12 before the domain ends.
        for margin in [1e-3, 1e-6] {
            let value = |s: f64| (0.5 - s).sqrt() - margin;
            let system = Planted::new(&value, Guard::new(Direction::Below).terminal());
            let start = Start { mode: (), s: 0.0, state: State::from([0.0]) };
            let ends = [
                run(Dopri5, &BlackBox(&system), start, 1.0, &options, &mut ()),
                run(Dop853, &BlackBox(&system), start, 1.0, &options, &mut ()),
            ];
            for end in ends {
                let end = end.expect("a guard before the end of its domain");
                let root = 0.5 - margin * margin;
                assert!((end.s - root).abs() < 2e-15, "{margin} {options:?}: {}", end.s);
            }
        }
    }
}
