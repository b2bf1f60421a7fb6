//! Readable guards without bounds or without a value somewhere: jumps by division, poles, roots of
//! negative numbers.

use stickslip_solver::{
    Direction, Dop853, Dopri5, EmbeddedPair, Guard, HybridSystem, Method, Number, Options, Outcome,
    ReadableSystem, RunError, State, StepSize,
};

use super::runs::{Log, at, close, fixed, line, start_of_line};
use crate::erased::{run, run_with};

/// What the guard is of the distance d from its place.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    /// The sign of d, d/|d|.
    Ratio,
    /// d/√|d|, which is steep at 0.
    Root,
    /// A pole of order 0.3.
    WeakPole,
    /// −1/d.
    Pole,
    /// 1 + √(−d), which has no value behind the place.
    Ends,
}

/// A guard at a place, along y' = 1.
#[derive(Clone, Copy, Debug)]
struct Shaped(Shape, f64, Guard);

impl ReadableSystem<1, 1> for Shaped {
    type Mode = ();

    fn field<T: Number>(&self, (): (), _s: T, _y: &[T; 1]) -> [T; 1] {
        [T::from(1.0)]
    }

    fn guards(&self, (): ()) -> [Guard; 1] {
        [self.2]
    }

    fn guard_values<T: Number>(&self, (): (), _s: T, y: &[T; 1]) -> [T; 1] {
        let d = y[0] - self.1;
        [match self.0 {
            Shape::Ratio => d / d.abs(),
            Shape::Root => d / d.abs().sqrt(),
            Shape::WeakPole => d / d.abs().powf(1.3),
            Shape::Pole => -(T::from(1.0) / d),
            Shape::Ends => (-d).sqrt() + 1.0,
        }]
    }

    fn transition(&self, (): (), _: usize, _s: f64, y: &State<1>) -> ((), State<1>) {
        ((), *y)
    }
}

const PLACES: [f64; 4] = [0.3, 0.5, 0.613, 0.999];

fn each(mut check: impl FnMut(EmbeddedPair, f64, Options)) {
    for pair in EmbeddedPair::ALL {
        for place in PLACES {
            for options in [Options::default(), fixed(1.0), fixed(0.1)] {
                check(pair, place, options);
            }
        }
    }
}

#[test]
fn a_jump_by_division_fires() {
    each(|pair, place, options| {
        for (shape, direction) in
            [(Shape::Ratio, Direction::Rising), (Shape::Root, Direction::Either)]
        {
            let mut log = Log::default();
            let system = Shaped(shape, place, Guard::new(direction));
            let end = run_with(pair, &system, start_of_line(), 1.0, &options, &mut log);
            let end =
                end.unwrap_or_else(|error| panic!("{pair:?} {system:?} {options:?}: {error}"));
            assert_eq!(end.outcome, Outcome::ReachedEnd);
            close(&log.places(), &[place], 1e-14);
            assert!(log.poles.is_empty());
            assert_eq!(log.switches[0].jump, shape == Shape::Ratio, "{system:?}");
        }
    });
}

#[test]
fn a_pole_does_not_fire_unless_it_bounds_a_domain() {
    each(|pair, place, options| {
        for (shape, sign) in [(Shape::Pole, 1.0), (Shape::WeakPole, -1.0)] {
            for direction in [Direction::Falling, Direction::Rising, Direction::Either] {
                let mut log = Log::default();
                let system = Shaped(shape, place, Guard::new(direction));
                let end = run_with(pair, &system, start_of_line(), 1.0, &options, &mut log);
                assert_eq!(end.unwrap().outcome, Outcome::ReachedEnd);
                assert!(log.switches.is_empty(), "{system:?}: {:?}", log.switches);
                // Both directions see one pole.
                let told = direction == Direction::Either
                    || (direction == Direction::Falling) == (sign > 0.0);
                let expected = if told { &[place][..] } else { &[] };
                close(&log.poles, expected, 1e-12);
            }
        }
        let domain = Guard::new(Direction::Below).terminal();
        let system = Shaped(Shape::Pole, place, domain);
        let black_box = line([domain], move |s| [1.0 / (place - s)]);
        let read = run_with(pair, &system, start_of_line(), 1.0, &options, &mut ()).unwrap();
        let sampled = run_with(pair, &black_box, start_of_line(), 1.0, &options, &mut ()).unwrap();
        for end in [read, sampled] {
            assert_eq!(end.outcome, Outcome::EndedByGuard { guard: 0 }, "{place} {options:?}");
            assert!((end.s - place).abs() < 1e-12, "{pair} {place} {options:?}: {end:?}");
        }
    });
}

/// A guard that has no value where it is evaluated is an error, unless the run ends before.
#[test]
fn a_guard_without_a_value_is_an_error() {
    fn fails<M: Method>(method: M, system: &impl HybridSystem<1, 1, Mode = ()>, options: &Options) {
        let end = run(method, system, start_of_line(), 1.0, options, &mut ());
        let error = end.expect_err("a guard without a value");
        assert!(
            matches!(error, RunError::GuardNotANumber { .. } | RunError::GuardUnresolved { .. }),
            "{error}"
        );
    }
    for place in PLACES {
        for step_size in [StepSize::Adaptive, StepSize::Fixed(1.0), StepSize::Fixed(0.1)] {
            let options = Options { step_size, ..Options::default() };
            let system = Shaped(Shape::Ends, place, Guard::new(Direction::Falling));
            fails(Dop853, &system, &options);
            fails(Dopri5, &system, &options);
            let end = run(Dop853, &system, at(0.0, [0.0]), 0.5 * place, &options, &mut ());
            assert_eq!(end.unwrap().outcome, Outcome::ReachedEnd);
        }
    }
}

#[test]
fn a_guard_without_a_value_is_called_so() {
    let system = line([Guard::new(Direction::Falling)], |s| [(0.5 - s).sqrt() + 1.0]);
    let run = run(Dopri5, &system, at(0.0, [0.0]), 1.0, &Options::default(), &mut ());
    let error = run.unwrap_err();
    assert!(matches!(error, RunError::GuardNotANumber { guard: 0, .. }), "{error}");
}

/// The work for each pole and zero of a step does not grow with their number.
#[test]
fn poles_cost_the_same_however_many_a_step_has() {
    /// tan ωy along y' = 1.
    struct Tan(f64);

    impl ReadableSystem<1, 1> for Tan {
        type Mode = ();

        fn field<T: Number>(&self, (): (), _s: T, _y: &[T; 1]) -> [T; 1] {
            [T::from(1.0)]
        }

        fn guards(&self, (): ()) -> [Guard; 1] {
            [Guard::new(Direction::Either)]
        }

        fn guard_values<T: Number>(&self, (): (), _s: T, y: &[T; 1]) -> [T; 1] {
            [((y[0] - 0.1) * self.0).tan()]
        }
    }

    let bounds = |periods: u32| {
        let system = Tan(std::f64::consts::PI * f64::from(periods));
        let mut log = Log::default();
        let run = run(Dop853, &system, start_of_line(), 1.0, &fixed(1.0), &mut log).unwrap();
        assert_eq!((log.switches.len(), log.poles.len()), (periods as usize, periods as usize));
        run.statistics.enclosures as f64 / f64::from(periods)
    };
    let (few, many) = (bounds(10), bounds(160));
    assert!(many < 1.2 * few, "{many} {few}");
}
