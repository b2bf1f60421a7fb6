//! Runs of a case.

use std::fmt;
use std::time::Instant;

use stickslip::solver::dynamic::{
    DynamicEvent, DynamicObserver, DynamicStart, DynamicSystem, run_dynamic,
};
use stickslip::solver::{
    Guard, HybridSystem, Method, Number, Observer, Options, Outcome, ReadableSystem, RunError,
    Start, State, SwitchEvent, run,
};

use super::{Case, ExpectedOutcome, Place, Verdict};

/// What the solver knows of the formulas of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reading {
    /// It reads them.
    Readable,
    /// It evaluates them only.
    BlackBox,
    /// It evaluates them only, and is told the shortest time on which a guard changes.
    ScaledBlackBox,
    /// As [`Self::BlackBox`], with a dimension that is known at run time only.
    Dynamic,
    /// As [`Self::ScaledBlackBox`], with a dimension that is known at run time only.
    ScaledDynamic,
}

/// A run of a case, and what it found.
#[derive(Clone, Debug)]
pub struct Report {
    /// The events that the run found, against the true ones.
    pub verdict: Verdict,
    /// Why the run failed, or how it ended otherwise than expected.
    pub failure: Option<String>,
    /// Evaluations of the right-hand side.
    pub field: usize,
    /// The time of the run in seconds.
    pub seconds: f64,
}

impl Report {
    /// Whether all events are right, and the run ended as expected.
    pub fn is_right(&self) -> bool {
        self.failure.is_none() && self.verdict.is_right()
    }
}

/// The numbers of events that are right, missed, invented and misplaced, the largest error of a
/// place that is right, evaluations of the right-hand side, and the time.
impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Verdict { right, missed, invented, misplaced, error } = self.verdict;
        let milliseconds = 1e3 * self.seconds;
        write!(f, "{right}/{missed}/{invented}/{misplaced}, {error:.0e}, {}, ", self.field)?;
        write!(f, "{milliseconds:.2} ms")?;
        self.failure.as_ref().map_or(Ok(()), |failure| write!(f, " ({failure})"))
    }
}

/// Calls a function for the size of a case. Every size is compiled for itself, so there are few.
macro_rules! sized {
    ($run:ident($method:expr, $case:expr $(, $more:expr)?)) => {
        match $case.size() {
            (1, 1) => $run::<M, 1, 1>($method, $case $(, $more)?),
            (1, ..=32) => $run::<M, 1, 32>($method, $case $(, $more)?),
            (2, ..=2) => $run::<M, 2, 2>($method, $case $(, $more)?),
            (4, ..=2) => $run::<M, 4, 2>($method, $case $(, $more)?),
            size => panic!("{} has a size that is not compiled: {size:?}", $case.name),
        }
    };
}

/// Runs a case.
///
/// # Panics
/// The case has more components or guards than any other so far. Another line in `sized` helps.
pub fn run_case<M: Method>(method: M, case: &Case, reading: Reading) -> Report {
    match reading {
        Reading::Readable => sized!(run_read(method, case)),
        Reading::BlackBox => sized!(run_black_box(method, case, None)),
        Reading::ScaledBlackBox => sized!(run_black_box(method, case, case.guard_scale)),
        Reading::Dynamic => run_free(method, case, None),
        Reading::ScaledDynamic => run_free(method, case, case.guard_scale),
    }
}

fn run_read<M: Method, const N: usize, const G: usize>(method: M, case: &Case) -> Report {
    run_system(method, &Readable::<N, G> { case }, case, None)
}

fn run_black_box<M: Method, const N: usize, const G: usize>(
    method: M,
    case: &Case,
    guard_scale: Option<f64>,
) -> Report {
    run_system(method, &BlackBox(Readable::<N, G> { case }), case, guard_scale)
}

fn run_system<M, S, const N: usize, const G: usize>(
    method: M,
    system: &S,
    case: &Case,
    guard_scale: Option<f64>,
) -> Report
where
    M: Method,
    S: HybridSystem<N, G, Mode = usize>,
{
    let (mode, s, state) = &case.start;
    let start = Start { mode: *mode, s: *s, state: State::from_column_slice(state) };
    let mut events = Events { case, found: Vec::new() };
    let begin = Instant::now();
    let result = run(method, system, start, case.end, &options(case, guard_scale), &mut events);
    let result = result.map(|run| (run.outcome, run.statistics.field));
    report(case, events.found, result, begin)
}

/// Runs a case as a system whose dimension is known at run time only.
fn run_free<M: Method>(method: M, case: &Case, guard_scale: Option<f64>) -> Report {
    let (mode, s, state) = &case.start;
    let start = DynamicStart { mode: *mode, s: *s, state };
    let guards = |mode: &super::Mode| mode.guards.iter().map(|guard| guard.guard).collect();
    let system = Free { case, guards: case.modes.iter().map(guards).collect() };
    let mut events = Events { case, found: Vec::new() };
    let begin = Instant::now();
    let options = options(case, guard_scale);
    let result = run_dynamic(method, &system, start, case.end, &options, &mut events);
    let result = result.map(|run| (run.outcome, run.statistics.field));
    report(case, events.found, result, begin)
}

/// The options of a case.
pub fn options(case: &Case, guard_scale: Option<f64>) -> Options {
    Options { rtol: case.rtol, atol: case.atol, guard_scale, ..Options::default() }
}

/// What a run found that began at this moment.
pub fn report(
    case: &Case,
    found: Vec<Place>,
    result: Result<(Outcome, usize), RunError>,
    begin: Instant,
) -> Report {
    let seconds = begin.elapsed().as_secs_f64();
    let field = result.as_ref().map_or(0, |&(_, field)| field);
    let failure = failure(case, result.map(|(outcome, _)| outcome));
    Report { verdict: Verdict::of(case, found), failure, field, seconds }
}

/// How a run ended, if it did not end as expected.
fn failure(case: &Case, outcome: Result<Outcome, RunError>) -> Option<String> {
    let near = |a: f64, b: f64| (a - b).abs() <= case.tolerance;
    let outcome = match outcome {
        Ok(outcome) => outcome,
        Err(RunError::Cycle { s, .. }) if matches!(case.outcome, ExpectedOutcome::Stuck(place) if near(place, s)) =>
        {
            return None;
        }
        Err(error) => return Some(error.to_string()),
    };
    let expected = match (case.outcome, outcome) {
        (ExpectedOutcome::End, Outcome::ReachedEnd)
        | (ExpectedOutcome::Guard, Outcome::EndedByGuard { .. }) => true,
        (
            ExpectedOutcome::Zeno(place) | ExpectedOutcome::Stuck(place),
            Outcome::Zeno { accumulation },
        ) => near(place, accumulation),
        _ => false,
    };
    (!expected).then(|| format!("{outcome:?} instead of {:?}", case.outcome))
}

/// Keeps the places of all events.
struct Events<'a> {
    case: &'a Case,
    found: Vec<Place>,
}

impl<const N: usize> Observer<usize, N> for Events<'_> {
    fn on_switch(&mut self, event: &SwitchEvent<usize, N>) {
        self.found.push((event.s, event.guard));
        let guards = &self.case.modes[event.from].guards;
        if guards[event.guard].is_noted() && !guards[event.guard].guard.ends_run() {
            let together = (0..guards.len()).filter(|&k| k != event.guard);
            let fired = together.filter(|k| event.simultaneous >> k & 1 == 1);
            self.found.extend(fired.map(|k| (event.s, k)));
        }
    }
}

impl DynamicObserver<usize> for Events<'_> {
    fn on_switch(&mut self, event: &DynamicEvent<'_, usize>) {
        self.found.push((event.s, event.guard));
        let guards = &self.case.modes[event.from].guards;
        if guards[event.guard].is_noted() && !guards[event.guard].guard.ends_run() {
            self.found.extend(event.simultaneous.iter().map(|&k| (event.s, k)));
        }
    }
}

/// A case whose dimension the solver learns at run time.
struct Free<'a> {
    case: &'a Case,
    guards: Vec<Vec<Guard>>,
}

impl DynamicSystem for Free<'_> {
    type Mode = usize;

    fn field(&self, mode: usize, s: f64, y: &[f64], slope: &mut [f64]) {
        for (slope, formula) in slope.iter_mut().zip(&self.case.modes[mode].field) {
            *slope = formula.value(s, y);
        }
    }

    fn guards(&self, mode: usize) -> &[Guard] {
        &self.guards[mode]
    }

    fn guard_values(&self, mode: usize, s: f64, y: &[f64], values: &mut [f64]) {
        for (value, guard) in values.iter_mut().zip(&self.case.modes[mode].guards) {
            *value = guard.value.value(s, y);
        }
    }

    fn transition(&self, mode: usize, guard: usize, s: f64, y: &mut [f64]) -> usize {
        let guard = &self.case.modes[mode].guards[guard];
        if let Some(formulas) = &guard.reset {
            let after: Vec<f64> = formulas.iter().map(|formula| formula.value(s, y)).collect();
            y.copy_from_slice(&after);
        }
        guard.to.unwrap_or(mode)
    }
}

/// A case whose formulas the solver reads.
#[derive(Clone, Copy)]
struct Readable<'a, const N: usize, const G: usize> {
    case: &'a Case,
}

impl<const N: usize, const G: usize> ReadableSystem<N, G> for Readable<'_, N, G> {
    type Mode = usize;

    fn field<T: Number>(&self, mode: usize, s: T, y: &[T; N]) -> [T; N] {
        let field = &self.case.modes[mode].field;
        std::array::from_fn(|k| field[k].value(s, y))
    }

    fn guards(&self, mode: usize) -> [Guard; G] {
        let guards = &self.case.modes[mode].guards;
        std::array::from_fn(|k| guards.get(k).map_or(Guard::OFF, |guard| guard.guard))
    }

    fn guard_values<T: Number>(&self, mode: usize, s: T, y: &[T; N]) -> [T; G] {
        let guards = &self.case.modes[mode].guards;
        std::array::from_fn(|k| guards.get(k).map_or(T::from(1.0), |guard| guard.value.value(s, y)))
    }

    fn transition(&self, mode: usize, guard: usize, s: f64, y: &State<N>) -> (usize, State<N>) {
        let guard = &self.case.modes[mode].guards[guard];
        let component = |formula: &super::Expression| formula.value(s, y.as_slice());
        let reset = guard.reset.as_ref();
        let after = reset.map(|formulas| State::from_fn(|k, _| component(&formulas[k])));
        (guard.to.unwrap_or(mode), after.unwrap_or(*y))
    }
}

/// A case whose formulas the solver only evaluates.
struct BlackBox<'a, const N: usize, const G: usize>(Readable<'a, N, G>);

impl<const N: usize, const G: usize> HybridSystem<N, G> for BlackBox<'_, N, G> {
    type Mode = usize;

    fn field(&self, mode: usize, s: f64, y: &State<N>) -> State<N> {
        HybridSystem::field(&self.0, mode, s, y)
    }

    fn guards(&self, mode: usize) -> [Guard; G] {
        HybridSystem::guards(&self.0, mode)
    }

    fn guard_values(&self, mode: usize, s: f64, y: &State<N>) -> [f64; G] {
        HybridSystem::guard_values(&self.0, mode, s, y)
    }

    fn transition(&self, mode: usize, guard: usize, s: f64, y: &State<N>) -> (usize, State<N>) {
        HybridSystem::transition(&self.0, mode, guard, s, y)
    }
}
