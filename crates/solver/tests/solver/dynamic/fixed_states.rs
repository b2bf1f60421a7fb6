//! What small systems find on states of fixed dimension they find on buffers.

use stickslip_solver::dynamic::{
    DynamicDense, DynamicEvent, DynamicObserver, DynamicStart, DynamicSwitch, DynamicSystem,
    ReadableDynamic, run_dynamic, run_dynamic_backwards,
};
use stickslip_solver::margin::{Margin, Margins, follow_dynamic, margin_dynamic, margins_dynamic};
use stickslip_solver::{
    Closures, Direction, Dop853, Dopri5, Guard, Method, Number, Options, RunError, Start, State,
    Weighted, run,
};

/// Small systems, of one type.
#[derive(Clone)]
enum Small<const ON_FIXED_STATES: bool> {
    /// Levels that rise and fall. The even ones are pushed up when they are low; after a push only
    /// the first one is watched, until it has risen.
    Levels(Vec<Guard>),
    /// Two oscillators of very different speed, with tolerances of their own, or with none.
    Oscillators(Vec<(f64, f64)>),
}

impl<const ON_FIXED_STATES: bool> Small<ON_FIXED_STATES> {
    fn levels(n: usize) -> Self {
        Self::Levels(vec![Guard::new(Direction::Below); n])
    }
}

impl<const ON_FIXED_STATES: bool> ReadableDynamic for Small<ON_FIXED_STATES> {
    type Mode = bool;
    const ON_FIXED_STATES: bool = ON_FIXED_STATES;

    fn most_guards(&self) -> usize {
        ReadableDynamic::guards(self, false).len()
    }
    fn tolerances(&self) -> &[(f64, f64)] {
        match self {
            Self::Levels(_) => &[],
            Self::Oscillators(tolerances) => tolerances,
        }
    }
    fn field<T: Number>(&self, _: bool, s: T, y: &[T], slope: &mut [T]) {
        if let Self::Oscillators(_) = self {
            slope.copy_from_slice(&[y[1], -y[0], y[3] * 30.0, -y[2] * 30.0]);
            return;
        }
        let mean = y.iter().fold(T::from(0.0), |sum, &y| sum + y) / y.len() as f64;
        for (i, slope) in slope.iter_mut().enumerate() {
            *slope = (s * (1.0 + 0.1 * i as f64)).cos() * 0.6 - 0.4 - (y[i] - mean) * 0.3;
        }
    }
    fn guards(&self, pushed: bool) -> &[Guard] {
        match self {
            Self::Levels(guards) if pushed => &guards[..1],
            Self::Levels(guards) => guards,
            Self::Oscillators(_) => &[],
        }
    }
    fn guard_values<T: Number>(&self, pushed: bool, _: T, y: &[T], values: &mut [T]) {
        match self {
            Self::Levels(_) if pushed => values[0] = -y[0] + 0.2,
            Self::Levels(_) => values.copy_from_slice(y),
            Self::Oscillators(_) => {}
        }
    }
    fn transition(&self, pushed: bool, guard: usize, _: f64, y: &mut [f64]) -> bool {
        if pushed {
            return false;
        }
        y[guard] += 0.7;
        guard.is_multiple_of(2) && y[0] < 0.2
    }
    fn transition_condition(&self, pushed: bool, _: usize, _: f64, y: &[f64]) -> f64 {
        if pushed { f64::NAN } else { 0.2 - y[0] }
    }
}

#[derive(Default)]
struct Seen {
    events: Vec<DynamicSwitch<bool>>,
    /// The states on both sides of each segment.
    sides: Vec<[Vec<f64>; 2]>,
    end: Vec<f64>,
}

impl DynamicObserver<bool> for Seen {
    const WANTS_SEGMENTS: bool = true;

    fn on_switch(&mut self, event: &DynamicEvent<'_, bool>) {
        self.events.push(event.to_switch());
    }
    fn on_segment(&mut self, _: bool, dense: &DynamicDense<'_>) {
        let coefficients = dense.coefficients();
        let (s, h, n) = (dense.start(), dense.size(), dense.dimension());
        let again = DynamicDense::from_coefficients(s, h, n, coefficients).expect("coefficients");
        self.sides.push([again.at(0.0), again.at(1.0)]);
    }
    fn on_end(&mut self, _: bool, _: f64, state: &[f64]) {
        self.end = state.to_vec();
    }
}

fn near(a: &[f64], b: &[f64], by: f64) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= by)
}

fn compare<M: Method>(method: M, n: usize) {
    let name = format!("{n} components");
    let (fixed, free) = (Small::<true>::levels(n), Small::<false>::levels(n));
    let state: Vec<f64> = (0..n).map(|i| 0.3 + 0.05 * i as f64).collect();
    let start = || DynamicStart { mode: false, s: 0.25, state: &state };
    let (end, options) = (12.0, Options::with_tolerance(1e-11));
    let (mut one, mut other) = (Seen::default(), Seen::default());
    let a = run_dynamic(method, &fixed, start(), end, &options, &mut one).expect(&name);
    let b = run_dynamic(method, &free, start(), end, &options, &mut other).expect(&name);
    assert!(near(&a.state, &b.state, 1e-9) && a.decided && b.decided, "{name}: {a:?} {b:?}");
    assert_eq!((a.outcome, a.s, a.mode), (b.outcome, b.s, b.mode), "{name}");
    assert_eq!(one.end, a.state, "{name}");
    let [first, last] = [one.sides.first(), one.sides.last()].map(|side| side.expect("segments"));
    assert!(near(&first[0], &state, 1e-15) && near(&last[1], &a.state, 1e-9), "{name}");
    let pieces = one.sides.windows(2).filter(|two| !near(&two[0][1], &two[1][0], 1e-9)).count();
    assert!(pieces <= one.events.len(), "{name}: {pieces}");
    assert_eq!(one.sides.len(), other.sides.len(), "{name}");
    assert!(!one.events.is_empty(), "{name}");
    assert_eq!(one.events.len(), other.events.len(), "{name}");
    for (a, b) in one.events.iter().zip(&other.events) {
        assert!((a.s - b.s).abs() < 1e-9 && near(&a.before, &b.before, 1e-9), "{name}");
        assert!(near(&a.after, &b.after, 1e-9), "{name}");
        assert_eq!((a.guard, a.from, a.to), (b.guard, b.from, b.to), "{name}");
        assert_eq!(a.simultaneous, b.simultaneous, "{name}");
    }
    let found = |margins: Result<Margins, RunError>| -> Vec<(Margin, f64)> {
        let misses = margins.expect(&name).near_misses.into_iter();
        misses.map(|miss| (miss.margin, miss.value)).collect()
    };
    let a = found(margins_dynamic(method, &fixed, start(), end, &options));
    let b = found(margins_dynamic(method, &free, start(), end, &options));
    assert!(!a.is_empty() && a.len() == b.len(), "{name}: {} {}", a.len(), b.len());
    for ((which, a), (_, b)) in a.iter().zip(&b) {
        assert!((a - b).abs() < 1e-8, "{name}: {which:?} {a} {b}");
        let again = margin_dynamic(method, &fixed, start(), end, &options, which).expect(&name);
        assert!((again.expect("a margin").value - a).abs() < 1e-8, "{name}: {which:?}");
    }
    let exits = &a.iter().max_by_key(|(which, _)| which.exits.len()).expect("margins").0.exits;
    let a = follow_dynamic(method, &fixed, start(), end, &options, exits).expect(&name);
    let b = follow_dynamic(method, &free, start(), end, &options, exits).expect(&name);
    let (a, b) = (a.expect("a run"), b.expect("a run"));
    assert!(near(&a.run.state, &b.run.state, 1e-9) && a.exits.len() == b.exits.len(), "{name}");
}

#[test]
fn a_small_system_does_the_same_on_fixed_states() {
    for n in 1..=9 {
        compare(Dop853, n);
        compare(Dopri5, n);
    }
}

/// The mean error is that of the components that there are: steps are as long.
#[test]
fn a_system_that_is_filled_up_takes_the_same_steps() {
    for n in [3, 5, 7] {
        let state = vec![5.0; n];
        let start = || DynamicStart { mode: false, s: 0.0, state: &state };
        let options = Options::default();
        let fixed = run_dynamic(Dop853, &Small::<true>::levels(n), start(), 3.0, &options, &mut ());
        let free = run_dynamic(Dop853, &Small::<false>::levels(n), start(), 3.0, &options, &mut ());
        let steps = |run: Result<stickslip_solver::dynamic::DynamicRun<bool>, _>| {
            let statistics = run.expect("a run").statistics;
            (statistics.accepted, statistics.rejected)
        };
        assert_eq!(steps(fixed), steps(free), "{n}");
    }
}

/// Of more components or guards than eight, and of none.
#[test]
fn other_systems_run_on_buffers() {
    fn is_dynamic<S: DynamicSystem>(_: &S) -> bool {
        S::ON_FIXED_STATES
    }
    let none = Small::<true>::levels(0);
    assert!(is_dynamic(&none));
    let start = DynamicStart { mode: false, s: 0.0, state: &[] };
    let run = run_dynamic(Dop853, &none, start, 3.0, &Options::default(), &mut ());
    assert_eq!(run.expect("a run").s, 3.0);
}

#[test]
fn each_component_has_its_tolerance() {
    let state = [0.0, 1.0, 0.0, 1.0];
    let start = || DynamicStart { mode: false, s: 0.0, state: &state };
    let options = Options { rtol: 1e-11, atol: 1e-11, ..Options::default() };
    let fixed = |own: &[(f64, f64)]| {
        let system = Small::<true>::Oscillators(own.to_vec());
        let run = run_dynamic(Dop853, &system, start(), 3.0, &options, &mut ()).expect("a run");
        (run.state, run.statistics.accepted)
    };
    let free = |own: &[(f64, f64)]| {
        let system = Small::<false>::Oscillators(own.to_vec());
        let run = run_dynamic(Dop853, &system, start(), 3.0, &options, &mut ()).expect("a run");
        let back = run_dynamic_backwards(Dop853, &system, start(), -3.0, &options, &mut ());
        assert_eq!(back.expect("a run").statistics, run.statistics);
        (run.state, run.statistics.accepted)
    };
    let (strict, loose) = ((1e-11, 1e-11), (1e-4, 1e-4));
    let all = [strict, strict, loose, loose];
    // Those that a short list leaves out have the tolerances of the options.
    assert_eq!(fixed(&[]), fixed(&[strict; 3]));
    assert_eq!(free(&[]), free(&[strict]));
    let many = free(&[]).1;
    for (state, few) in [fixed(&all), free(&all)] {
        assert!(2 * few < many, "{few} {many}");
        assert!((state[0] - 3.0_f64.sin()).abs() < 1e-9, "{state:?}");
        let error = (state[2] - 90.0_f64.sin()).abs();
        assert!(error > 1e-6 && error < 0.1, "{error}");
    }
    // As a system of fixed dimension has them.
    let field = |_s: f64, y: &State<4>| State::from([y[1], -y[0], 30.0 * y[3], -30.0 * y[2]]);
    let system = Closures::new(field);
    let weighted = Weighted::new(&system, all).expect("tolerances");
    let start = Start { mode: (), s: 0.0, state: State::from(state) };
    let end = run(Dop853, &weighted, start, 3.0, &options, &mut ()).expect("a run");
    assert_eq!((end.state.as_slice().to_vec(), end.statistics.accepted), free(&all));
}
