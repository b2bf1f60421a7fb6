//! Hybrid systems with two parameters as families of runs.

use stickslip_solver::{
    HybridSystem, Margin, Method, NearMiss, Observer, Options, Outcome, RunError, Start,
    SwitchEvent, margin, margins, run,
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

/// The runs of a problem.
///
/// A label lists the guards that fire, in order. Margins are those of the solver,
/// [`stickslip_solver::Margin`].
#[derive(Clone, Copy, Debug)]
pub struct HybridFamily<P, M, const N: usize, const G: usize> {
    /// The system and the start of its run, at every point.
    pub problem: P,
    /// The Runge–Kutta method of every run.
    pub method: M,
    /// The options of every run. They also determine the accuracy of margins.
    pub options: Options,
    /// The end of every run, if no terminal guard ends it before.
    ///
    /// A run that stops before for another reason, for instance at an accumulation of switches, is
    /// an error. Choose the window and the end so that this does not happen.
    pub end: f64,
}

/// A run of a hybrid family failed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("at ({}, {}): {kind}", .point.x, .point.y)]
pub struct FamilyError {
    /// The point of the parameter plane.
    pub point: Point,
    /// Why the run failed.
    pub kind: FamilyErrorKind,
}

/// Why a run of a hybrid family failed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum FamilyErrorKind {
    /// The integration failed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The run stopped before its end.
    #[error("the run stopped before its end and before a terminal guard: {0:?}")]
    Unfinished(Outcome),
}

impl<P, M, const N: usize, const G: usize> HybridFamily<P, M, N, G>
where
    P: Problem<N, G>,
    M: Method,
{
    fn near_miss(&self, point: &Point, which: &Margin) -> Result<Option<NearMiss>, FamilyError> {
        let (system, start) = self.problem.at(point);
        margin(self.method, &system, start, self.end, &self.options, which)
            .map_err(|error| failure(point, error))
    }
}

impl<P, M, const N: usize, const G: usize> Family for HybridFamily<P, M, N, G>
where
    P: Problem<N, G>,
    M: Method,
{
    type Label = Vec<usize>;
    type Margin = Margin;
    type Error = FamilyError;

    fn label(&self, point: &Point) -> Result<Vec<usize>, FamilyError> {
        let (system, start) = self.problem.at(point);
        let mut fired = Fired(Vec::new());
        let run = run(self.method, &system, start, self.end, &self.options, &mut fired)
            .map_err(|error| failure(point, error))?;
        if let Outcome::EndedByGuard { .. } = run.outcome {
            fired.0.pop();
        }
        finished(point, run.outcome).map(|()| fired.0)
    }

    fn margin(&self, point: &Point, which: &Margin) -> Result<Option<f64>, FamilyError> {
        self.near_miss(point, which).map(|found| found.map(|miss| miss.value))
    }

    fn moved(&self, point: &Point, which: &Margin) -> Result<Margin, FamilyError> {
        self.near_miss(point, which)
            .map(|found| found.map_or_else(|| which.clone(), |miss| miss.margin))
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<Vec<usize>, Margin>, FamilyError> {
        let (system, start) = self.problem.at(point);
        let found = margins(self.method, &system, start, self.end, &self.options)
            .map_err(|error| failure(point, error))?;
        finished(point, found.outcome)?;
        let margins = found.near_misses.into_iter().map(|miss| (miss.margin, miss.value));
        Ok(FreeRun { label: found.fired, margins: margins.collect() })
    }
}

fn failure(point: &Point, error: RunError) -> FamilyError {
    FamilyError { point: *point, kind: error.into() }
}

fn finished(point: &Point, outcome: Outcome) -> Result<(), FamilyError> {
    match outcome {
        Outcome::EndedByGuard { .. } | Outcome::ReachedEnd => Ok(()),
        _ => Err(FamilyError { point: *point, kind: FamilyErrorKind::Unfinished(outcome) }),
    }
}

/// Records the guards that fire.
struct Fired(Vec<usize>);

impl<Mode, const N: usize> Observer<Mode, N> for Fired {
    fn on_switch(&mut self, event: &SwitchEvent<Mode, N>) {
        self.0.push(event.guard);
    }
}
