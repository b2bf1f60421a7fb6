//! Orbits of systems of Rust, beside those of their texts.

use std::f64::consts::{PI, TAU};

use stickslip_expression::{Jump, NativeSystem, System, ValuedSystem};
use stickslip_orbits::{BranchOptions, Guess, Orbits};
use stickslip_solver::{Direction, Dop853, Guard, Number, Options, Start, run};

use crate::{ball, impact};

/// The impact oscillator of `oscillator.slip`.
struct Oscillator;

impl NativeSystem<3, 2, 6> for Oscillator {
    type Mode = ();

    fn parameters(&self) -> [(&str, f64); 6] {
        [("k", 1.0), ("c", 0.1), ("d", 1.0), ("a", 1.0), ("w", 1.0), ("e", 0.8)]
    }
    fn components(&self) -> [(&str, f64); 3] {
        [("x", 1.0), ("v", -1.4), ("phase", 0.1)]
    }
    fn modes(&self) -> &[()] {
        &[()]
    }
    fn field<T: Number>(&self, (): (), p: &[T; 6], _: T, &[x, v, phase]: &[T; 3]) -> [T; 3] {
        let [k, c, _, a, w, _] = *p;
        [v, a * phase.cos() - c * v - k * x, w]
    }
    fn guards(&self, (): ()) -> [(&str, Guard); 2] {
        let guard = Guard::new(Direction::Below);
        [("impact", guard), ("phase", guard)]
    }
    fn guard_values<T: Number>(&self, (): (), p: &[T; 6], _: T, &[x, _, phase]: &[T; 3]) -> [T; 2] {
        [p[2] - x, -phase + PI]
    }
    fn transition<T: Number>(
        &self,
        (): (),
        guard: usize,
        p: &[T; 6],
        _: T,
        &[x, v, phase]: &[T; 3],
    ) -> Jump<(), T, 3> {
        Jump::to((), if guard == 0 { [p[2], -p[5] * v, phase] } else { [x, v, phase - TAU] })
    }
}

/// The ball on a table of `ball.slip`: its time is explicit, and a clock ticks.
struct Ball;

impl NativeSystem<2, 2, 3> for Ball {
    type Mode = &'static str;

    fn parameters(&self) -> [(&str, f64); 3] {
        [("a", 0.02), ("w", TAU), ("r", 0.7)]
    }
    fn components(&self) -> [(&str, f64); 2] {
        [("x", 0.02), ("v", 0.5)]
    }
    fn modes(&self) -> &[&'static str] {
        &["flies"]
    }
    fn field<T: Number>(&self, _: &str, _: &[T; 3], _: T, y: &[T; 2]) -> [T; 2] {
        [y[1], T::from(-1.0)]
    }
    fn guards(&self, _: &str) -> [(&str, Guard); 2] {
        [("bounce", Guard::new(Direction::Below)), ("period", Guard::clock())]
    }
    fn guard_values<T: Number>(&self, _: &str, &[a, w, _]: &[T; 3], s: T, y: &[T; 2]) -> [T; 2] {
        [y[0] - a * (w * s).sin(), T::from(f64::NAN)]
    }
    fn transition<T: Number>(
        &self,
        mode: &'static str,
        guard: usize,
        &[a, w, r]: &[T; 3],
        s: T,
        y: &[T; 2],
    ) -> Jump<&'static str, T, 2> {
        let (table, slope) = (a * (w * s).sin(), a * w * (w * s).cos());
        let behind = [table, (r + 1.0) * slope - r * y[1]];
        Jump::to(mode, if guard == 0 { behind } else { *y })
    }
    fn clock<T: Number>(&self, _: &str, guard: usize, &[_, w, _]: &[T; 3]) -> Option<[T; 2]> {
        (guard == 1).then(|| [T::from(TAU) / w, T::from(PI) / w])
    }
}

#[test]
fn a_system_of_rust_has_the_orbits_of_its_text() {
    let text = impact::orbits();
    let native = Orbits::new(&System::of_native(&Oscillator).expect("it")).expect("orbits");
    let (state, itinerary) = ([1.0, -1.4, 0.1], ["phase", "impact"]);
    let guess = Guess { state: Some(&state), itinerary: &itinerary, ..Guess::default() };
    let values = [1.0, 0.1, 1.0, 1.0, 0.8, 0.8];
    let [own, other] = [&native, &text].map(|it| it.find(&values, &guess).expect("an orbit"));
    assert!(own.is_admissible());
    // The solver runs what is compiled, and comes back.
    let system = ValuedSystem { system: &Oscillator, parameters: values };
    let first = &own.segments[0].state;
    let start = Start { mode: (), s: 0.0, state: [first[0], first[1], first[2]].into() };
    let mut switches = Vec::new();
    let options = Options::with_tolerance(1e-13);
    let ran =
        run(Dop853, &system, start, own.period + 0.1, &options, &mut switches).expect("a run");
    assert!(ran.decided);
    assert_eq!(switches.len(), 2);
    assert!((switches[1].s - own.period).abs() < 1e-12);
    for (k, own) in first.iter().enumerate() {
        assert!((switches[1].after[k] - own).abs() < 1e-12, "{k}");
    }
    let branches = [(&native, &own), (&text, &other)].map(|(orbits, orbit)| {
        orbits.branch(orbit, 3, [0.05, 1.2], &BranchOptions::default()).expect("a branch")
    });
    let [own, other] = branches.map(|branch| {
        let specials = branch.specials.iter();
        (branch.points.len(), specials.map(|it| (it.kind, it.value)).collect::<Vec<_>>())
    });
    assert_eq!(own.0, other.0);
    assert!(own.1.len() >= 2 && own.1.len() == other.1.len());
    for ((kind, value), (other, same)) in own.1.into_iter().zip(other.1) {
        assert!(kind == other && (value - same).abs() < 1e-12, "{kind:?} {value} {other:?} {same}");
    }
}

#[test]
fn clocks_of_rust_are_clocks() {
    let text = Orbits::new(&System::parse(ball::TEXT).expect("a system")).expect("orbits");
    let native = Orbits::new(&System::of_native(&Ball).expect("it")).expect("orbits");
    let (state, itinerary) = ([0.0144, 0.5], ["period", "bounce"]);
    let (time, state) = (Some(0.13), Some(&state[..]));
    let guess = Guess { time, state, itinerary: &itinerary, ..Guess::default() };
    let values = [0.02, TAU, 0.7];
    let [own, other] = [&native, &text].map(|it| it.find(&values, &guess).expect("an orbit"));
    assert!(own.is_admissible() && (own.start - other.start).abs() < 1e-12);
    let multipliers = [&own, &other].map(|it| it.multipliers.clone().expect("no graze"));
    for ([re, im], [same, other]) in multipliers[0].iter().zip(&multipliers[1]) {
        assert!((re - same).abs() < 1e-11 && (im - other).abs() < 1e-11, "{multipliers:?}");
    }
}
