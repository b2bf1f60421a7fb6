//! Runs of any dimension and of fixed dimension find the same.

use stickslip_solver::dynamic::{DynamicStart, DynamicSwitch};
use stickslip_solver::{
    Closures, Direction, Dop853, Dopri5, EmbeddedPair, Guard, HybridSystem, Method, Options,
    Outcome, Run, RunError, Start, State, Statistics, StepSize, SwitchEvent,
};

use super::{Of, Plain, go};
use crate::erased::{integrate, run, run_dynamic};

/// The satellite of Arenstorf's orbit.
fn satellite(y: &[f64], slope: &mut [f64]) {
    let (mu, mu1) = (0.012277471, 1.0 - 0.012277471);
    let (x, v) = (y[0], y[1]);
    let d1 = ((x + mu).powi(2) + v * v).powf(1.5);
    let d2 = ((x - mu1).powi(2) + v * v).powf(1.5);
    slope[0] = y[2];
    slope[1] = y[3];
    slope[2] = x + 2.0 * y[3] - mu1 * (x + mu) / d1 - mu * (x - mu1) / d2;
    slope[3] = v - 2.0 * y[2] - mu1 * v / d1 - mu * v / d2;
}

fn smooth<M: Method>(method: M, options: &Options) {
    let start = [0.994, 0.0, 0.0, -2.001_585_106_379_082_5];
    let end = 17.065_216_560_157_964;
    let field = |_s: f64, y: &State<4>| {
        let mut slope = State::<4>::zeros();
        satellite(y.as_slice(), slope.as_mut_slice());
        slope
    };
    let fixed = integrate(method, field, 0.0, State::from(start), end, options, &mut ());
    let fixed = fixed.expect("an orbit");
    let (field, values) =
        (|_, y: &[f64], f: &mut [f64]| satellite(y, f), |_, _: &[f64], _: &mut [f64]| {});
    let system = Plain { field, guards: Vec::new(), values }.boxed();
    let free = go(method, &system, &start, end, options, &mut ()).expect("an orbit");
    assert_eq!(fixed.state.as_slice(), free.state);
    assert_eq!(
        Statistics { guards: 0, ..fixed.statistics },
        Statistics { guards: 0, ..free.statistics }
    );
    assert_eq!(fixed.outcome, free.outcome);
}

#[test]
fn smooth_runs_agree_bit_for_bit() {
    for tolerance in [1e-4, 1e-8, 1e-12] {
        smooth(Dop853, &Options::with_tolerance(tolerance));
        smooth(Dopri5, &Options::with_tolerance(tolerance));
    }
    let fixed = Options { step_size: StepSize::Fixed(0.002), ..Options::default() };
    smooth(Dop853, &fixed);
    smooth(Dopri5, &Options { max_step: 0.01, first_step: Some(0.1), ..Options::default() });
}

/// Runs a system either way and compares all that is found.
fn compare<M, S, const N: usize, const G: usize>(
    method: M,
    system: &S,
    modes: &[S::Mode],
    start: Start<S::Mode, N>,
    end: f64,
    options: &Options,
) -> Vec<SwitchEvent<S::Mode, N>>
where
    M: Method,
    S: HybridSystem<N, G>,
{
    let (mut fixed, mut free) = (Vec::new(), Vec::<DynamicSwitch<S::Mode>>::new());
    let a: Result<Run<S::Mode, N>, _> = run(method, system, start, end, options, &mut fixed);
    let state = start.state;
    let from = DynamicStart { mode: start.mode, s: start.s, state: state.as_slice() };
    let b = run_dynamic(method, &Of::new(system, modes), from, end, options, &mut free);
    let (a, b) = match (a, b) {
        (Ok(a), Ok(b)) => (a, b),
        (a, b) => {
            let cycle = |error| match error {
                Some(RunError::Cycle { s, count, .. }) => (s, count),
                other => panic!("{other:?}"),
            };
            let (a, b) = (cycle(a.err()), cycle(b.err()));
            assert!((a.0 - b.0).abs() < 1e-11 && a.1 == b.1, "{a:?} {b:?}");
            return fixed;
        }
    };
    for (a, b) in fixed.iter().zip(&free) {
        let near = |x: f64, y: f64, by: f64| (x - y).abs() <= by * x.abs().max(1.0);
        assert!(near(a.s, b.s, 1e-11), "{a:?} {b:?}");
        assert_eq!((a.jump, a.from, a.to), (b.jump, b.from, b.to), "{a:?} {b:?}");
        let mut named: Vec<usize> = (0..G).filter(|k| a.simultaneous >> k & 1 == 1).collect();
        if a.from == a.to && a.before == a.after {
            // Those that are noted together have one event, whichever it is called after.
            let mut all = b.simultaneous.clone();
            all.push(b.guard);
            named.push(a.guard);
            all.sort_unstable();
            named.sort_unstable();
            assert_eq!(named, all, "{a:?} {b:?}");
        } else {
            // The fixed run may leave out one that it has noted at this place before.
            assert_eq!(a.guard, b.guard, "{a:?} {b:?}");
            assert!(named.iter().all(|guard| b.simultaneous.contains(guard)), "{a:?} {b:?}");
        }
        for i in 0..N {
            assert!(near(a.before[i], b.before[i], 1e-9), "{a:?} {b:?}");
            assert!(near(a.after[i], b.after[i], 1e-9), "{a:?} {b:?}");
        }
    }
    assert_eq!(fixed.len(), free.len(), "{:?}\n{:?}", fixed.last(), free.last());
    match (a.outcome, b.outcome) {
        (Outcome::Zeno { accumulation: a }, Outcome::Zeno { accumulation: b }) => {
            assert!((a - b).abs() < 1e-9);
        }
        (a, b) => assert_eq!(a, b),
    }
    assert!((a.s - b.s).abs() <= 1e-11 * a.s.abs().max(1.0) && a.mode == b.mode);
    assert_eq!(a.statistics.switches, b.statistics.switches);
    fixed
}

/// Compares with both methods, in adaptive and in fixed steps. Returns the number of events.
fn compare_all<S, const N: usize, const G: usize>(
    system: &S,
    modes: &[S::Mode],
    start: Start<S::Mode, N>,
    end: f64,
    options: &Options,
) -> usize
where
    S: HybridSystem<N, G>,
{
    let mut count = 0;
    for step_size in [StepSize::Adaptive, StepSize::Fixed(0.0317), StepSize::Fixed(0.125)] {
        let options = Options { step_size, ..*options };
        let found = compare(Dop853, system, modes, start, end, &options);
        assert!(step_size != StepSize::Adaptive || count == 0);
        count += found.len() + compare(Dopri5, system, modes, start, end, &options).len();
    }
    count
}

fn at<const N: usize>(state: [f64; N]) -> Start<(), N> {
    Start { mode: (), s: 0.0, state: State::from(state) }
}

#[test]
fn a_bouncing_ball_comes_to_rest() {
    let ball = Closures::new(|_time, y: &State<2>| State::from([y[1], -9.81]))
        .guards([Guard::new(Direction::Below)], |_time, y| [y[0]])
        .transition(|_guard, _time, y| State::from([0.0, -0.7 * y[1]]));
    assert!(compare_all(&ball, &[()], at([1.0, 0.0]), 30.0, &Options::default()) > 300);
}

/// A mass on a spring, on a belt of velocity 0.5, whose friction is smaller while it slips.
struct Belt;

impl HybridSystem<2, 1> for Belt {
    type Mode = bool;

    fn field(&self, sticks: bool, _time: f64, y: &State<2>) -> State<2> {
        State::from([y[1], if sticks { 0.0 } else { 0.6 - y[0] }])
    }
    fn guards(&self, _sticks: bool) -> [Guard; 1] {
        [Guard::new(Direction::Below)]
    }
    fn guard_values(&self, sticks: bool, _time: f64, y: &State<2>) -> [f64; 1] {
        [if sticks { 1.0 - y[0] } else { 0.5 - y[1] }]
    }
    fn transition(&self, sticks: bool, _: usize, _time: f64, y: &State<2>) -> (bool, State<2>) {
        (!sticks, State::from([y[0], 0.5]))
    }
}

#[test]
fn a_mass_sticks_and_slips() {
    let start = Start { mode: true, s: 0.0, state: State::from([0.0, 0.5]) };
    assert!(compare_all(&Belt, &[true, false], start, 200.0, &Options::default()) > 300);
}

#[test]
fn several_guards_that_are_noted_and_several_that_change_something() {
    let either = Guard::new(Direction::Either);
    let guards = [
        either,
        Guard::new(Direction::Rising),
        Guard::new(Direction::Falling),
        Guard::new(Direction::Falling).priority(-1),
        Guard::OFF,
    ];
    // The second and the third guard vanish together; the fourth vanishes with the third.
    let system = Closures::new(|_s, y: &State<2>| State::from([y[1], -y[0]]))
        .guards(guards, |s: f64, y| [y[0] - 0.3, y[1], -y[1], -y[1] * (2.0 + s.sin()), f64::NAN]);
    let count = compare_all(&system, &[()], at([0.0, 1.0]), 40.0, &Options::default());
    assert!(count > 100, "{count}");
    let guards = guards.map(|guard| guard.terminal_after(7));
    let ends = Closures::new(|_s, y: &State<2>| State::from([y[1], -y[0]]))
        .guards(guards, |s: f64, y| [y[0] - 0.3, y[1], -y[1], -y[1] * (2.0 + s.sin()), 1.0]);
    assert!(compare_all(&ends, &[()], at([0.0, 1.0]), 400.0, &Options::default()) > 20);
    // The fourth guard changes the state, and yields to the third, which does not.
    let changes = Closures::new(|_s, y: &State<2>| State::from([y[1], -y[0]]))
        .guards(guards, |s: f64, y| [y[0] - 0.3, y[1], -y[1], -y[1] * (2.0 + s.sin()), 1.0])
        .transition(|guard, _s, y| if guard == 3 { y * 1.01 } else { *y });
    assert!(compare_all(&changes, &[()], at([0.0, 1.0]), 400.0, &Options::default()) > 20);
}

#[test]
fn ties_are_decided_by_the_guard_that_does_not_yield_or_by_the_first() {
    for (first, second) in [(false, false), (true, false), (false, true), (true, true)] {
        let with = |yields: bool| {
            let guard = Guard::new(Direction::Below);
            if yields { guard.priority(-1) } else { guard }
        };
        let system = Closures::new(|_s, _y: &State<1>| State::from([1.0]))
            .guards([with(first), with(second)], |_s, y| [0.7 - y[0], 1.4 - 2.0 * y[0]])
            .transition(|guard, _s, _y| State::from([-1.0 - guard as f64]));
        assert!(compare_all(&system, &[()], at([0.0]), 10.0, &Options::default()) > 10);
    }
}

#[test]
fn guards_that_start_from_zero() {
    for (direction, sign) in [
        (Direction::Below, 1.0),
        (Direction::Below, -1.0),
        (Direction::Falling, 1.0),
        (Direction::Falling, -1.0),
        (Direction::Rising, 1.0),
        (Direction::Rising, -1.0),
        (Direction::Either, 1.0),
        (Direction::Either, -1.0),
    ] {
        for order in [0, 1, 2] {
            let guards = [Guard::new(direction).from_zero(order)];
            let system = Closures::new(|_s, y: &State<2>| State::from([y[1], -y[0]]))
                .guards(guards, |_s, y| [sign * if order == 2 { 1.0 - y[1] } else { y[0] }])
                .transition(|_, _, y| if sign > 0.0 { *y } else { State::from([0.3, 0.9]) });
            let options = Options { max_at_one_instant: 5, max_switches: 50, ..Options::default() };
            compare_all(&system, &[()], at([0.0, 1.0]), 12.0, &options);
        }
    }
}

#[test]
fn relays_and_ends_of_the_span() {
    let relay = Closures::new(|s: f64, y: &State<1>| State::from([s.cos() - y[0]]))
        .guards([Guard::new(Direction::Either); 2], |_s, y| [y[0] - 0.2, y[0] + 0.2])
        .transition(|guard, _s, y| if guard == 0 { y * 0.999 } else { *y });
    assert!(compare_all(&relay, &[()], at([0.0]), 100.0, &Options::default()) > 100);
    for terminal in [false, true] {
        let guard = Guard::new(Direction::Falling);
        let guard = if terminal { guard.terminal() } else { guard };
        let falls = Closures::new(|_s, _: &State<1>| State::from([-1.0]))
            .guards([guard, Guard::new(Direction::Rising)], |_s, y| [y[0], -3.0 * y[0]]);
        assert!(compare_all(&falls, &[()], at([1.0]), 1.0, &Options::default()) >= 4);
    }
    assert_eq!(EmbeddedPair::ALL.len(), 2);
}
