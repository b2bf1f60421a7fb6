//! Margins with a closed form.

use stickslip_solver::dynamic::{DynamicStart, DynamicSystem, ReadableDynamic};
use stickslip_solver::margin::{
    Exit, Margins, Place, follow, follow_dynamic, margin_dynamic, margins_dynamic,
};
use stickslip_solver::{
    Direction, Dop853, Guard, HybridSystem, Number, Options, Outcome, ReadableSystem, Start, State,
};

use crate::black_box::BlackBox;
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

/// Two masses between springs, the first of which is forced by sin 0.7t. Both start at rest, so
/// that the second one moves like t⁵. The guard is the distance of the second one from a limit,
/// computed with rounding of the size of `offset`.
#[derive(Clone, Copy)]
struct Chain {
    limit: f64,
    offset: f64,
}

impl Chain {
    fn slope<T: Number>(t: T, y: [T; 4]) -> [T; 4] {
        let force = (t * 0.7).sin();
        [y[1], y[2] - y[0] - y[0] + force, y[3], y[0] - y[2] - y[2]]
    }

    fn distance<T: Number>(&self, y: T) -> T {
        -(y + self.offset) + (self.limit + self.offset)
    }

    /// What margins of a run over 20 have to be: the maxima of the second displacement, which is
    /// the sum of two oscillations, and the start and the end.
    fn check(found: &Margins, name: &str) {
        let expected = [4.055, 11.189, 18.452];
        let places = found.near_misses.iter().map(|miss| (miss.margin.place, miss.s));
        let minima: Vec<f64> = places
            .clone()
            .filter(|(place, _)| matches!(place, Place::Minimum { .. }))
            .map(|(_, s)| s)
            .collect();
        let near =
            minima.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-3);
        assert!(minima.len() == 3 && near, "{name}: {minima:?}");
        assert_eq!(places.count(), 5, "{name}");
    }
}

impl ReadableSystem<4, 1> for Chain {
    type Mode = ();
    fn field<T: Number>(&self, (): (), t: T, y: &[T; 4]) -> [T; 4] {
        Self::slope(t, *y)
    }
    fn guards(&self, (): ()) -> [Guard; 1] {
        [Guard::new(Direction::Falling)]
    }
    fn guard_values<T: Number>(&self, (): (), _: T, y: &[T; 4]) -> [T; 1] {
        [self.distance(y[2])]
    }
}

/// The same with a dimension that is known at run time.
struct FreeChain(Chain);

impl ReadableDynamic for FreeChain {
    type Mode = ();
    fn field<T: Number>(&self, (): (), t: T, y: &[T], slope: &mut [T]) {
        slope.copy_from_slice(&Chain::slope(t, [y[0], y[1], y[2], y[3]]));
    }
    fn guards(&self, (): ()) -> &[Guard] {
        const { &[Guard::new(Direction::Falling)] }
    }
    fn guard_values<T: Number>(&self, (): (), _: T, y: &[T], values: &mut [T]) {
        values[0] = self.0.distance(y[2]);
    }
    fn reads(&self, (): ()) -> &[usize] {
        &[2]
    }
}

/// Black boxes with a dimension that is known at run time.
enum Dark {
    /// The same.
    Chain(Chain),
    /// A mode with two guards leads to one with a single guard. What the second guard would do
    /// there has no margin, and a margin of it cannot be followed.
    FewerGuards,
}

impl DynamicSystem for Dark {
    type Mode = bool;
    fn field(&self, _: bool, t: f64, y: &[f64], slope: &mut [f64]) {
        match self {
            Self::Chain(_) => slope.copy_from_slice(&Chain::slope(t, [y[0], y[1], y[2], y[3]])),
            Self::FewerGuards => slope[0] = 1.0,
        }
    }
    fn guards(&self, late: bool) -> &[Guard] {
        const BOUNDS: [Guard; 2] = [Guard::new(Direction::Below); 2];
        match self {
            Self::Chain(_) => const { &[Guard::new(Direction::Falling)] },
            Self::FewerGuards if late => &BOUNDS[..1],
            Self::FewerGuards => &BOUNDS,
        }
    }
    fn guard_values(&self, late: bool, _: f64, y: &[f64], values: &mut [f64]) {
        match self {
            Self::Chain(chain) => values[0] = chain.distance(y[2]),
            Self::FewerGuards if late => values[0] = 3.0 + (2.0 * y[0]).cos(),
            Self::FewerGuards => values.copy_from_slice(&[5.0, 1.0 - y[0]]),
        }
    }
    fn transition(&self, late: bool, _: usize, _: f64, _: &mut [f64]) -> bool {
        late || matches!(self, Self::FewerGuards)
    }
}

/// Where a guard is flat to rounding, it has no extrema: readable, as a black box, and with a
/// dimension that is known at run time, which changes no bit of a black box.
#[test]
fn a_guard_that_leaves_rest_slowly_has_no_margins_of_rounding() {
    let at_rest = || Start { mode: (), s: 0.0, state: State::from([0.0; 4]) };
    let readable_rest = || DynamicStart { mode: (), s: 0.0, state: &[0.0; 4] };
    let free_rest = || DynamicStart { mode: false, s: 0.0, state: &[0.0; 4] };
    for tolerance in [1e-6, 1e-9, 1e-13] {
        let options = Options::with_tolerance(tolerance);
        for (limit, offset) in [(2.0, 0.0), (3.0, 0.5), (10.0, 0.0), (2.0, 1000.0)] {
            let chain = Chain { limit, offset };
            let name = format!("{tolerance:e} {limit} {offset}");
            let readable = margins(Dop853, &chain, at_rest(), 20.0, &options).unwrap();
            Chain::check(&readable, &name);
            let dark = margins(Dop853, &BlackBox(&chain), at_rest(), 20.0, &options).unwrap();
            Chain::check(&dark, &name);
            let found = margins_dynamic(Dop853, &FreeChain(chain), readable_rest(), 20.0, &options);
            Chain::check(&found.unwrap(), &name);
            let found = margins_dynamic(Dop853, &Dark::Chain(chain), free_rest(), 20.0, &options);
            assert_eq!(found.as_ref(), Ok(&dark), "{name}");
            for miss in &dark.near_misses {
                let (start, which) = (free_rest(), &miss.margin);
                let found =
                    margin_dynamic(Dop853, &Dark::Chain(chain), start, 20.0, &options, which);
                let found = found.unwrap().expect("a margin");
                assert_eq!(found.margin, miss.margin);
                assert!((found.value - miss.value).abs() < 1e-9, "{name}: {found:?} {miss:?}");
            }
        }
    }
}

/// The run that passes the limit once, of fixed dimension and of one that is known at run time.
#[test]
fn a_run_of_any_dimension_follows_an_itinerary() {
    let options = Options::with_tolerance(1e-12);
    let chain = Chain { limit: 0.5, offset: 0.0 };
    let start = Start { mode: (), s: 0.0, state: State::from([0.0; 4]) };
    let fixed = follow(Dop853, &BlackBox(&chain), start, 20.0, &options, &[Exit::falling(0, 0.0)]);
    let fixed = fixed.unwrap().expect("a run");
    let start = DynamicStart { mode: false, s: 0.0, state: &[0.0; 4] };
    let exits = [Exit::falling(0, 0.0)];
    let free = follow_dynamic(Dop853, &Dark::Chain(chain), start, 20.0, &options, &exits);
    let free = free.unwrap().expect("a run");
    assert_eq!(free.run.outcome, Outcome::ReachedEnd);
    assert_eq!(free.run.state, fixed.run.state.as_slice());
    // A guard that the mode does not have.
    let exits = [Exit::falling(3, 0.0)];
    let free = follow_dynamic(Dop853, &Dark::Chain(chain), start, 20.0, &options, &exits);
    assert_eq!(free, Ok(None));
}

#[test]
fn modes_may_have_different_numbers_of_guards() {
    let start = DynamicStart { mode: false, s: 0.0, state: &[0.0] };
    let options = Options::with_tolerance(1e-13);
    let found = margins_dynamic(Dop853, &Dark::FewerGuards, start, 3.0, &options).unwrap();
    assert_eq!(found.fired, [1]);
    let mut last = found.near_misses.last().expect("margins").clone();
    let minimum = found.near_misses.iter().find(|miss| {
        miss.margin.exits.len() == 1 && matches!(miss.margin.place, Place::Minimum { .. })
    });
    let minimum = minimum.expect("a minimum");
    assert!((minimum.s - std::f64::consts::FRAC_PI_2).abs() < 1e-9);
    assert!((minimum.value - 2.0).abs() < 1e-12);
    last.margin.guard = 1;
    let lost = margin_dynamic(Dop853, &Dark::FewerGuards, start, 3.0, &options, &last.margin);
    assert_eq!(lost, Ok(None));
}
