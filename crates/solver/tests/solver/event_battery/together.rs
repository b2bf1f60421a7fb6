//! Guards that vanish together in a mode that goes on unchanged. Each crossing counts once: either
//! it has an event of its own, or another event reports it as simultaneous.

use stickslip_solver::{
    Direction, Dop853, Dopri5, Guard, HybridSystem, Method, Observer, Options, Outcome, Start,
    State, StepSize, SwitchEvent,
};

use super::planted::{Score, step_sizes};
use crate::black_box::BlackBox;
use crate::erased::run;

/// y' = 1 with products of (y − root) as guards. A switch changes nothing.
struct Products {
    guards: [(&'static [f64], Direction, u32); 3],
}

impl HybridSystem<1, 3> for Products {
    type Mode = ();

    fn field(&self, (): (), _s: f64, _y: &State<1>) -> State<1> {
        State::from([1.0])
    }

    fn guards(&self, (): ()) -> [Guard; 3] {
        self.guards.map(|(_, direction, order)| Guard::new(direction).from_zero(order))
    }

    fn guard_values(&self, (): (), _s: f64, y: &State<1>) -> [f64; 3] {
        self.guards.map(|(roots, ..)| roots.iter().map(|root| y[0] - root).product())
    }
}

/// The places where each guard fired.
#[derive(Default)]
struct Fired([Vec<f64>; 3]);

impl Observer<(), 1> for Fired {
    fn on_switch(&mut self, event: &SwitchEvent<(), 1>) {
        for guard in 0..3 {
            if event.guard == guard || event.simultaneous >> guard & 1 == 1 {
                self.0[guard].push(event.s);
            }
        }
    }
}

/// A case, with the places where its guards should fire.
pub struct Case {
    pub name: &'static str,
    system: Products,
    planted: [&'static [f64]; 3],
    tolerance: f64,
}

const C: f64 = 0.4375;
const NONE: (&[f64], Direction, u32) = (&[1.0], Direction::Off, 0);

pub fn cases() -> Vec<Case> {
    use Direction::{Either, Falling, Rising};
    let case = |name, guards, planted| Case {
        name,
        system: Products { guards },
        planted,
        tolerance: 4e-15,
    };
    let two = |name, first, second, planted: [&'static [f64]; 2]| {
        case(name, [first, second, NONE], [planted[0], planted[1], &[]])
    };
    let simple: &[f64] = &[C];
    let with_another: &[f64] = &[C, 0.9];
    // A triple root is flat. If guards are closer together than 1e-12 of a step, the guard that is
    // listed first may determine the place of both.
    let near = |case| Case { tolerance: 2e-13, ..case };
    vec![
        two("both cross", (simple, Rising, 0), (with_another, Falling, 0), [simple, simple]),
        two(
            "both cross, in either direction",
            (simple, Either, 0),
            (with_another, Either, 0),
            [simple, with_another],
        ),
        two(
            "both cross, one in the other direction",
            (simple, Either, 0),
            (with_another, Rising, 0),
            [simple, &[0.9]],
        ),
        two("the second touches", (simple, Either, 0), (&[C, C], Either, 0), [simple, &[]]),
        two("the first touches", (&[C, C], Either, 0), (simple, Either, 0), [&[], simple]),
        two("both touch", (&[C, C], Either, 0), (&[C, C, 0.7], Either, 0), [&[], &[0.7]]),
        near(two(
            "a triple root",
            (&[C, C, C], Either, 0),
            (with_another, Either, 0),
            [simple, with_another],
        )),
        case(
            "three cross",
            [(simple, Either, 0), (with_another, Either, 0), (&[0.2, C], Rising, 0)],
            [simple, with_another, simple],
        ),
        case(
            "two cross, one touches",
            [(&[C, C, 0.8], Either, 0), (simple, Either, 0), (with_another, Falling, 0)],
            [&[0.8], simple, simple],
        ),
        two(
            "1 unit in the last place apart",
            (&[C + f64::EPSILON / 4.0], Either, 0),
            (with_another, Either, 0),
            [simple, with_another],
        ),
        two("1e-15 apart", (&[C + 1e-15], Either, 0), (simple, Either, 0), [&[C + 1e-15], simple]),
        two("1e-15 before", (&[C - 1e-15], Either, 0), (simple, Either, 0), [&[C - 1e-15], simple]),
        near(two(
            "1e-13 apart",
            (&[C + 1e-13], Either, 0),
            (simple, Either, 0),
            [&[C + 1e-13], simple],
        )),
        near(two(
            "1e-13 before",
            (&[C - 1e-13], Either, 0),
            (simple, Either, 0),
            [&[C - 1e-13], simple],
        )),
        two(
            "on the end of steps",
            (&[0.5], Either, 0),
            (&[0.5, 0.75], Either, 0),
            [&[0.5], &[0.5, 0.75]],
        ),
        two(
            "from a known zero",
            (&[0.0, C], Either, 1),
            (&[0.0, 0.0, C], Rising, 2),
            [simple, simple],
        ),
    ]
}

/// Runs a case with one method and step size.
fn fired<M: Method>(method: M, case: &Case, options: &Options) -> [Vec<f64>; 3] {
    let mut fired = Fired::default();
    let start = Start { mode: (), s: 0.0, state: State::from([0.0]) };
    let end =
        run(method, &BlackBox(&case.system), start, 1.0, options, &mut fired).expect(case.name);
    assert_eq!(end.outcome, Outcome::ReachedEnd, "{} {options:?}", case.name);
    fired.0
}

pub fn score(case: &Case) -> Score {
    let mut score = Score::default();
    for options in step_sizes() {
        for fired in [fired(Dopri5, case, &options), fired(Dop853, case, &options)] {
            for (planted, found) in case.planted.iter().zip(&fired) {
                score.add(planted, found, case.tolerance);
            }
        }
    }
    score
}

#[test]
fn guards_that_vanish_together_fire_once_each() {
    for case in cases() {
        let score = score(&case);
        let planted: usize = case.planted.iter().map(|planted| planted.len()).sum();
        assert_eq!(score.planted, planted * step_sizes().len() * 2, "{}", case.name);
        assert_eq!((score.missed, score.invented), (0, 0), "{}: {score:?}", case.name);
    }
}

/// A guard that is exactly zero where a step ends comes from the side on which it was last, even if
/// it was there for a short time only.
#[test]
fn a_crossing_on_the_end_of_a_step_right_after_another() {
    let guards = [
        (&[0.47, 0.5][..], Direction::Rising, 0),
        (&[0.5, 0.5], Direction::Either, 0),
        (&[0.5 + 1e-13], Direction::Either, 0),
    ];
    let (name, system, tolerance) = ("after another", Products { guards }, 4e-15);
    let case = Case { name, system, planted: [&[]; 3], tolerance };
    for h in [0.5, 0.25, 0.125] {
        let options = Options { step_size: StepSize::Fixed(h), ..Options::default() };
        for fired in [fired(Dopri5, &case, &options), fired(Dop853, &case, &options)] {
            assert_eq!(fired.each_ref().map(Vec::len), [1, 0, 1], "{h}: {fired:?}");
            assert!((fired[0][0] - 0.5).abs() < 2e-13, "{h}: {fired:?}");
        }
    }
}

/// Guards whose common zero is the end of the run may fire there, but only once.
#[test]
fn together_at_the_end_of_the_span() {
    let guards = [
        (&[1.0][..], Direction::Either, 0),
        (&[0.2, 1.0], Direction::Either, 0),
        (&[1.0, 1.0], Direction::Either, 0),
    ];
    let case = Case {
        name: "at the end",
        system: Products { guards },
        planted: [&[]; 3],
        tolerance: 4e-15,
    };
    for options in step_sizes() {
        for fired in [fired(Dopri5, &case, &options), fired(Dop853, &case, &options)] {
            assert!(
                fired[0].len() <= 1 && fired[1].len() <= 2 && !fired[1].is_empty(),
                "{fired:?}"
            );
            assert!(fired[2].is_empty(), "{fired:?}");
        }
    }
}

/// A terminal guard crosses together with a guard that is listed before it. It ends the run there,
/// by an event of its own.
#[test]
fn a_terminal_guard_that_crosses_with_another_ends_the_run() {
    struct Ends(Direction);
    impl HybridSystem<1, 2> for Ends {
        type Mode = ();
        fn field(&self, (): (), _s: f64, _y: &State<1>) -> State<1> {
            State::from([1.0])
        }
        fn guards(&self, (): ()) -> [Guard; 2] {
            [Guard::new(Direction::Either), Guard::new(self.0).terminal()]
        }
        fn guard_values(&self, (): (), _s: f64, y: &State<1>) -> [f64; 2] {
            [y[0] - C, 3.0 * (C - y[0]) * (1.0 + y[0])]
        }
    }
    for options in step_sizes() {
        for direction in [Direction::Below, Direction::Falling, Direction::Either] {
            let start = Start { mode: (), s: 0.0, state: State::from([0.0]) };
            let mut events: Vec<SwitchEvent<(), 1>> = Vec::new();
            let end = run(Dop853, &Ends(direction), start, 1.0, &options, &mut events);
            assert_eq!(end.expect("planted").outcome, Outcome::EndedByGuard { guard: 1 });
            let guards: Vec<_> = events.iter().map(|e| (e.guard, e.simultaneous)).collect();
            assert!((events[0].s - C).abs() < 4e-15, "{events:?}");
            assert_eq!(guards[0], (0, 0), "{events:?}");
            assert_eq!(guards.len(), 2, "{events:?}");
        }
    }
}
