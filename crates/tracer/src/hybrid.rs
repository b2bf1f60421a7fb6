//! Hybrid systems with two parameters as families of runs.

use stickslip_solver::dynamic::{
    DynamicEvent, DynamicObserver, DynamicRun, DynamicStart, DynamicSystem, run_dynamic,
};
use stickslip_solver::margin::{
    Margin, Margins, NearMiss, Place, margin, margin_dynamic, margins, margins_dynamic,
};
use stickslip_solver::{
    HybridSystem, Method, Observer, Options, Outcome, RunError, Start, SwitchEvent, run,
};

use crate::family::{Family, FreeRun};
use crate::window::Point;

/// A hybrid system that depends on two parameters.
///
/// Every function that returns a system and the start of its run for a point is a problem.
pub trait Problem<const N: usize, const G: usize> {
    /// The hybrid system.
    type System: HybridSystem<N, G>;

    /// The system at `point`, and the start of its run.
    fn at(&self, point: &Point) -> (Self::System, Start<ModeOf<Self, N, G>, N>);

    /// As [`DynamicProblem::conditions`].
    fn conditions(&self, _point: &Point) -> Vec<f64> {
        Vec::new()
    }
}

impl<F, S, const N: usize, const G: usize> Problem<N, G> for F
where
    F: Fn(&Point) -> (S, Start<S::Mode, N>),
    S: HybridSystem<N, G>,
{
    type System = S;

    fn at(&self, point: &Point) -> (S, Start<S::Mode, N>) {
        self(point)
    }
}

/// The mode of a problem's system.
pub type ModeOf<P, const N: usize, const G: usize> =
    <<P as Problem<N, G>>::System as HybridSystem<N, G>>::Mode;

/// A hybrid system whose dimension is known at run time, and that depends on two parameters.
pub trait DynamicProblem {
    /// The hybrid system.
    type System: DynamicSystem;

    /// The run at `point`; `None` if there is no run, which counts as a failed one unless a
    /// condition says so.
    fn at(&self, point: &Point) -> Option<DynamicSetting<Self::System>>;

    /// The numbers that must not be negative for a run to start, each a smooth function of the
    /// point, and as many at every point. One that is not a number does not hold.
    ///
    /// They are decided in their order, so that a later one may be without value where an earlier
    /// one does not hold. Where the first one fails that does, the label is [`Itinerary::NoStart`];
    /// their zeros are boundaries ([`Place::Condition`]). The system need not have a run beyond
    /// these, and the start may have a square root there.
    fn conditions(&self, _point: &Point) -> Vec<f64> {
        Vec::new()
    }
}

/// A system, where its run starts, and where it ends.
#[derive(Clone, Debug)]
pub struct DynamicSetting<S: DynamicSystem> {
    /// The system.
    pub system: S,
    /// The first mode.
    pub mode: S::Mode,
    /// The place at the start.
    pub s: f64,
    /// The state at the start.
    pub state: Vec<f64>,
    /// The end, if no terminal guard ends the run before.
    pub end: f64,
}

impl<S: DynamicSystem> DynamicSetting<S> {
    fn start(&self) -> DynamicStart<'_, S::Mode> {
        DynamicStart { mode: self.mode, s: self.s, state: &self.state }
    }
}

/// What a run of a [`HybridFamily`] does.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Itinerary {
    /// The run comes to its end, or to a terminal guard. The guards that fire before, in order.
    Fires(Vec<usize>),
    /// The run goes on after [`Options::max_switches`] switches. The guards that fire up to there.
    Begins(Vec<usize>),
    /// The switches accumulate before the end, or follow one another without end at one instant.
    Accumulates,
    /// The run reaches [`Options::max_steps`].
    Unfinished,
    /// The run fails.
    Fails,
    /// No run starts: the place of the first condition of the start that does not hold.
    NoStart(usize),
}

impl Itinerary {
    /// The guards that fire, in order; `None` if the run comes neither to its end nor to the
    /// greatest number of switches.
    #[must_use]
    pub fn fired(&self) -> Option<&[usize]> {
        match self {
            Self::Fires(guards) | Self::Begins(guards) => Some(guards),
            _ => None,
        }
    }
}

/// The runs of a problem.
///
/// The label of a run is its [`Itinerary`]. Margins are the solver's,
/// [`stickslip_solver::margin::Margin`]; they are complete if the start of the run and every
/// transition without a [condition](HybridSystem::transition_condition) are smooth. Where there is
/// no start, the problem has [conditions](Problem::conditions).
///
/// A run that accumulates switches or fails has no margins. Where such runs begin, the trace
/// reports changes of the label as unresolved, with the labels on both sides; [`Self::outcome`]
/// gives the reason. Near an accumulation there are boundaries without end: set
/// [`Options::max_switches`], and itineraries differ only if they differ within that many switches.
#[derive(Clone, Copy, Debug)]
pub struct HybridFamily<P, M, const N: usize, const G: usize> {
    /// The system and the start of its run, at every point.
    pub problem: P,
    /// The Runge–Kutta method of every run.
    pub method: M,
    /// The options of every run. They also determine the accuracy of margins.
    pub options: Options,
    /// The end of every run, if no terminal guard ends it before.
    pub end: f64,
}

/// The options of the runs are invalid, or their end is not behind their start.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("at ({}, {}): {error}", .point.x, .point.y)]
pub struct FamilyError {
    /// The point of the parameter plane.
    pub point: Point,
    /// What is wrong.
    #[source]
    pub error: RunError,
}

impl<P, M, const N: usize, const G: usize> HybridFamily<P, M, N, G>
where
    P: Problem<N, G>,
    M: Method,
{
    /// How and where the run at `point` ends.
    ///
    /// # Errors
    /// The error of a run that fails.
    pub fn outcome(&self, point: &Point) -> Result<(Outcome, f64), RunError> {
        let (system, start) = self.problem.at(point);
        let run = run(self.method, &system, start, self.end, &self.options, &mut ())?;
        Ok((run.outcome, run.s))
    }
}

/// The runs of a problem whose dimension is known at run time, otherwise like a [`HybridFamily`].
#[derive(Clone, Copy, Debug)]
pub struct DynamicFamily<P, M> {
    /// The system, and the start and the end of its run, at every point.
    pub problem: P,
    /// The Runge–Kutta method of every run.
    pub method: M,
    /// The options of every run. They also determine the accuracy of margins.
    pub options: Options,
}

/// A run of a family.
#[derive(Clone, Debug, PartialEq)]
pub struct DynamicFired<Mode> {
    /// How it ended.
    pub run: DynamicRun<Mode>,
    /// The guards that fired before it ended, in order.
    pub fired: Vec<usize>,
}

/// The mode of a dynamic problem's system.
pub type DynamicModeOf<P> = <<P as DynamicProblem>::System as DynamicSystem>::Mode;

impl<P: DynamicProblem, M: Method> DynamicFamily<P, M> {
    /// The run at `point`; `None` if there is none.
    ///
    /// # Errors
    /// The error of a run that fails.
    pub fn run(&self, point: &Point) -> Result<Option<DynamicFired<DynamicModeOf<P>>>, RunError> {
        let Some(setting) = self.problem.at(point) else { return Ok(None) };
        let (system, start, end) = (&setting.system, setting.start(), setting.end);
        let mut fired = Fired(Vec::new());
        let run = run_dynamic(self.method, system, start, end, &self.options, &mut fired)?;
        let fired = fired.before(run.outcome);
        Ok(Some(DynamicFired { run, fired }))
    }
}

/// The runs of a family, whatever knows their dimension.
trait Runs {
    fn conditions(&self, point: &Point) -> Vec<f64>;
    /// The outcome of the run at a point, and the guards that fire; `None` if there is no run.
    fn fired(&self, point: &Point) -> Result<Option<(Outcome, Vec<usize>)>, RunError>;
    fn near_miss(&self, point: &Point, which: &Margin) -> Result<Option<NearMiss>, RunError>;
    fn margins(&self, point: &Point) -> Result<Option<Margins>, RunError>;
}

impl<P: Problem<N, G>, M: Method, const N: usize, const G: usize> Runs
    for HybridFamily<P, M, N, G>
{
    fn conditions(&self, point: &Point) -> Vec<f64> {
        self.problem.conditions(point)
    }

    fn fired(&self, point: &Point) -> Result<Option<(Outcome, Vec<usize>)>, RunError> {
        let (system, start) = self.problem.at(point);
        let mut fired = Fired(Vec::new());
        let run = run(self.method, &system, start, self.end, &self.options, &mut fired)?;
        Ok(Some((run.outcome, fired.before(run.outcome))))
    }

    fn near_miss(&self, point: &Point, which: &Margin) -> Result<Option<NearMiss>, RunError> {
        let (system, start) = self.problem.at(point);
        margin(self.method, &system, start, self.end, &self.options, which)
    }

    fn margins(&self, point: &Point) -> Result<Option<Margins>, RunError> {
        let (system, start) = self.problem.at(point);
        margins(self.method, &system, start, self.end, &self.options).map(Some)
    }
}

impl<P: DynamicProblem, M: Method> Runs for DynamicFamily<P, M> {
    fn conditions(&self, point: &Point) -> Vec<f64> {
        self.problem.conditions(point)
    }

    fn fired(&self, point: &Point) -> Result<Option<(Outcome, Vec<usize>)>, RunError> {
        Ok(self.run(point)?.map(|it| (it.run.outcome, it.fired)))
    }

    fn near_miss(&self, point: &Point, which: &Margin) -> Result<Option<NearMiss>, RunError> {
        let Some(setting) = self.problem.at(point) else { return Ok(None) };
        let (system, start, end) = (&setting.system, setting.start(), setting.end);
        margin_dynamic(self.method, system, start, end, &self.options, which)
    }

    fn margins(&self, point: &Point) -> Result<Option<Margins>, RunError> {
        let Some(setting) = self.problem.at(point) else { return Ok(None) };
        let (system, start, end) = (&setting.system, setting.start(), setting.end);
        margins_dynamic(self.method, system, start, end, &self.options).map(Some)
    }
}

/// The functions of a [`Family`] of runs.
macro_rules! family_of_runs {
    () => {
        type Label = Itinerary;
        type Margin = Margin;
        type Error = FamilyError;

        fn label(&self, point: &Point) -> Result<Itinerary, FamilyError> {
            label(self, point)
        }

        fn margin(&self, point: &Point, which: &Margin) -> Result<Option<f64>, FamilyError> {
            if which.place == Place::Condition {
                let value = self.conditions(point).get(which.guard).copied();
                return Ok(value.filter(|value| value.is_finite()));
            }
            let found = value_of(point, self.near_miss(point, which))?.flatten();
            Ok(found.map(|miss| miss.value))
        }

        fn moved(&self, point: &Point, which: &Margin) -> Result<Margin, FamilyError> {
            let found = value_of(point, self.near_miss(point, which))?.flatten();
            Ok(found.map_or_else(|| which.clone(), |miss| miss.margin))
        }

        /// Where a phase starts or ends, the order of events may change without a change of the
        /// itinerary: a guard that is negative from the start on fires as it would soon after.
        fn is_sure(&self, margin: &Margin) -> bool {
            !matches!(margin.place, Place::Start { .. } | Place::Exit(_) | Place::Branch(_))
        }

        fn free_run(&self, point: &Point) -> Result<FreeRun<Itinerary, Margin>, FamilyError> {
            free_run(self, point)
        }
    };
}

impl<P: Problem<N, G>, M: Method, const N: usize, const G: usize> Family
    for HybridFamily<P, M, N, G>
{
    family_of_runs!();
}

impl<P: DynamicProblem, M: Method> Family for DynamicFamily<P, M> {
    family_of_runs!();
}

/// The margins of the conditions of a start that are decided, and the first one that does not hold.
fn decided(conditions: &[f64]) -> (Vec<(Margin, f64)>, Option<usize>) {
    let holds = |value: &f64| *value >= 0.0;
    let failed = conditions.iter().position(|value| !holds(value));
    let decided = conditions[..failed.map_or(conditions.len(), |last| last + 1)].iter();
    let margin = |guard| Margin { exits: Vec::new(), guard, place: Place::Condition };
    let margins = decided.enumerate().map(|(guard, &value)| (margin(guard), value));
    (margins.filter(|(_, value)| value.is_finite()).collect(), failed)
}

/// The label of a run.
fn label(runs: &impl Runs, point: &Point) -> Result<Itinerary, FamilyError> {
    if let (_, Some(failed)) = decided(&runs.conditions(point)) {
        return Ok(Itinerary::NoStart(failed));
    }
    let run = runs.fired(point);
    if let Err(RunError::Cycle { .. }) = run {
        return Ok(Itinerary::Accumulates);
    }
    let run = value_of(point, run)?.flatten();
    Ok(run.map_or(Itinerary::Fails, |(outcome, fired)| itinerary(outcome, fired)))
}

/// A free run with its margins.
fn free_run(runs: &impl Runs, point: &Point) -> Result<FreeRun<Itinerary, Margin>, FamilyError> {
    let (mut margins, failed) = decided(&runs.conditions(point));
    if let Some(failed) = failed {
        return Ok(FreeRun { label: Itinerary::NoStart(failed), margins });
    }
    let found = runs.margins(point);
    if let Err(RunError::Cycle { .. }) = found {
        return Ok(FreeRun { label: Itinerary::Accumulates, margins });
    }
    let Some(found) = value_of(point, found)?.flatten() else {
        return Ok(FreeRun { label: Itinerary::Fails, margins });
    };
    margins.extend(found.near_misses.into_iter().map(|miss| (miss.margin, miss.value)));
    Ok(FreeRun { label: itinerary(found.outcome, found.fired), margins })
}

/// The result of a run, `None` if it failed. What is wrong in every run is an error.
fn value_of<T>(point: &Point, result: Result<T, RunError>) -> Result<Option<T>, FamilyError> {
    match result {
        Ok(value) => Ok(Some(value)),
        Err(error @ (RunError::Option(_) | RunError::Span { .. })) => {
            Err(FamilyError { point: *point, error })
        }
        Err(_) => Ok(None),
    }
}

fn itinerary(outcome: Outcome, fired: Vec<usize>) -> Itinerary {
    match outcome {
        Outcome::EndedByGuard { .. } | Outcome::ReachedEnd => Itinerary::Fires(fired),
        Outcome::Zeno { .. } => Itinerary::Accumulates,
        Outcome::SwitchLimit => Itinerary::Begins(fired),
        Outcome::StepLimit | Outcome::Stopped => Itinerary::Unfinished,
    }
}

/// Records the guards that fire.
struct Fired(Vec<usize>);

impl Fired {
    /// The guards that fire before a run ends.
    fn before(mut self, outcome: Outcome) -> Vec<usize> {
        if let Outcome::EndedByGuard { .. } = outcome {
            self.0.pop();
        }
        self.0
    }
}

impl<Mode> DynamicObserver<Mode> for Fired {
    fn on_switch(&mut self, event: &DynamicEvent<'_, Mode>) {
        self.0.push(event.guard);
    }
}

impl<Mode, const N: usize> Observer<Mode, N> for Fired {
    fn on_switch(&mut self, event: &SwitchEvent<Mode, N>) {
        self.0.push(event.guard);
    }
}
