//! A hybrid system with two parameters as a family of runs.

use stickslip_solver::{
    HybridSystem, Margin, Method, NearMiss, Observer, Options, Outcome, RunError, Start,
    SwitchEvent, margin, margins, run,
};

use crate::family::{Family, FreeRun, Point};

/// A hybrid system at every point of a parameter plane: a function from points to systems and
/// starts of their runs is one.
pub trait Problem<const N: usize, const G: usize> {
    /// The system.
    type System: HybridSystem<N, G>;

    /// The system at `point`, and where its run starts.
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

/// A mode of a problem's system.
pub type ModeOf<P, const N: usize, const G: usize> =
    <<P as Problem<N, G>>::System as HybridSystem<N, G>>::Mode;

/// The runs of a problem: labels are the guards that fired, in order; margins are those of the
/// solver.
#[derive(Clone, Copy, Debug)]
pub struct HybridFamily<P, M, const N: usize, const G: usize> {
    /// The problem.
    pub problem: P,
    /// The method.
    pub method: M,
    /// Options of every run. Margins are as accurate as these make the runs.
    pub options: Options,
    /// Where every run ends, if no terminal guard ends it before. Runs that stop before for
    /// another reason, as at an accumulation of switches, are errors: the window or the end
    /// has to be such that there are none.
    pub end: f64,
}

/// A run of a family failed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("at ({}, {}): {kind}", .point.x, .point.y)]
pub struct FamilyError {
    /// Where in the parameter plane.
    pub point: Point,
    /// Why.
    pub kind: FamilyErrorKind,
}

/// Why a run of a family failed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum FamilyErrorKind {
    /// The integration failed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The run did not come to its end.
    #[error("the run did not come to its end, nor to a guard that ends it: {0:?}")]
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

/// Takes down the guards that fire.
struct Fired(Vec<usize>);

impl<Mode, const N: usize> Observer<Mode, N> for Fired {
    fn on_switch(&mut self, event: &SwitchEvent<Mode, N>) {
        self.0.push(event.guard);
    }
}
