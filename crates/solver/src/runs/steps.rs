//! A run as an iterator over its steps.

use std::marker::PhantomData;

use crate::error::RunError;
use crate::events::{Event, Note};
use crate::hybrid::{HybridSystem, Run, Start, SwitchEvent};
use crate::method::{DenseOf, Method, State, StepOf};
use crate::options::Options;
use crate::runs::runner::{Runner, Watcher, switch_event};
use crate::runs::trajectory::TrajectorySegment;
use crate::system::Fixed;

/// A system whose runs are taken step by step.
///
/// A run is that of [`run`](crate::run), bit for bit. What happens between two steps is up to the
/// caller: nothing is computed ahead.
///
/// ```
/// use stickslip_solver::{Closures, Direction, Dop853, Guard, Options, Start, State, Stepper};
///
/// let ball = Closures::new(|_time, y: &State<2>| State::from([y[1], -9.81]))
///     .guards([Guard::new(Direction::Below)], |_time, y| [y[0]])
///     .transition(|_guard, _time, y| State::from([0.0, -0.5 * y[1]]));
/// let start = Start { mode: (), s: 0.0, state: State::from([4.905, 0.0]) };
/// let options = Options::default();
/// let mut stepper = Stepper::new(&ball);
/// let mut highest = 0.0_f64;
/// for step in stepper.steps(Dop853, start, 10.0, &options)? {
///     let step = step?;
///     if let [bounce, ..] = &step.switches[..] {
///         assert!((bounce.s - 1.0).abs() < 1e-14);
///         break;
///     }
///     highest = highest.max(step.segment.dense.at(0.5)[0]);
/// }
/// assert!(highest < 4.905);
/// # Ok::<(), stickslip_solver::RunError>(())
/// ```
pub struct Stepper<'a, S: HybridSystem<N, G>, const N: usize, const G: usize> {
    system: Fixed<'a, S, N, G>,
    taken: Taken<S::Mode, N>,
}

/// The steps of a run, in order. An error is the last item.
pub struct Steps<'a, 'b, M, S: HybridSystem<N, G>, const N: usize, const G: usize> {
    runner: Runner<'b, Fixed<'a, S, N, G>, Taken<S::Mode, N>>,
    step: StepOf<State<N>>,
    event: Option<Event<Fixed<'a, S, N, G>>>,
    run: Option<Run<S::Mode, N>>,
    failed: bool,
    method: PhantomData<M>,
}

/// An accepted step.
#[derive(Clone, Debug)]
pub struct StepTaken<Mode, const N: usize> {
    /// Its mode, and the state along it.
    pub segment: TrajectorySegment<Mode, N>,
    /// The switches since the step before: those on this step and at its end, and on the first step
    /// those at the start of the run.
    pub switches: Vec<SwitchEvent<Mode, N>>,
}

/// What is seen of a run.
struct Taken<Mode, const N: usize> {
    segment: Option<TrajectorySegment<Mode, N>>,
    switches: Vec<SwitchEvent<Mode, N>>,
}

impl<S, const N: usize, const G: usize> Watcher<Fixed<'_, S, N, G>> for Taken<S::Mode, N>
where
    S: HybridSystem<N, G>,
{
    const WANTS_SEGMENTS: bool = true;

    fn on_switch(&mut self, note: &Note<Fixed<'_, S, N, G>>) {
        self.switches.push(switch_event(note));
    }
    fn forget(&mut self, switches: usize) {
        self.switches.truncate(self.switches.len().saturating_sub(switches));
    }
    fn stops(&self, _: f64) -> bool {
        false
    }
    fn on_segment(&mut self, mode: S::Mode, dense: &DenseOf<State<N>>) {
        self.segment = Some(TrajectorySegment { mode, dense: *dense });
    }
}

impl<'a, S: HybridSystem<N, G>, const N: usize, const G: usize> Stepper<'a, S, N, G> {
    /// Runs of `system`.
    #[must_use]
    pub const fn new(system: &'a S) -> Self {
        let taken = Taken { segment: None, switches: Vec::new() };
        Self { system: Fixed(system), taken }
    }

    /// The steps of a run from `start` to `end`.
    ///
    /// # Errors
    /// Those of [`run`](crate::run) that concern options and the start. Others are items, the last
    /// of the iterator.
    pub fn steps<'b, M: Method>(
        &'b mut self,
        _method: M,
        start: Start<S::Mode, N>,
        end: f64,
        options: &'b Options,
    ) -> Result<Steps<'a, 'b, M, S, N, G>, RunError> {
        self.taken = Taken { segment: None, switches: Vec::new() };
        let from = (start.mode, start.s, &start.state);
        let runner = Runner::at::<M>(&self.system, from, end, options, &mut self.taken)?;
        let step = StepOf::blank();
        Ok(Steps { runner, step, event: None, run: None, failed: false, method: PhantomData })
    }
}

impl<M, S: HybridSystem<N, G>, const N: usize, const G: usize> Steps<'_, '_, M, S, N, G> {
    /// How the run ended, if all of its steps were taken.
    pub fn run(&self) -> Option<Run<S::Mode, N>> {
        self.run
    }
}

impl<M: Method, S, const N: usize, const G: usize> Iterator for Steps<'_, '_, M, S, N, G>
where
    S: HybridSystem<N, G>,
{
    type Item = Result<StepTaken<S::Mode, N>, RunError>;

    fn next(&mut self) -> Option<Self::Item> {
        while self.run.is_none() && !self.failed {
            match self.runner.go_on::<M>(&mut self.step, &mut self.event) {
                Ok(None) => {}
                Ok(Some(outcome)) => self.run = Some(self.runner.end(outcome).into()),
                Err(error) => {
                    self.failed = true;
                    return Some(Err(error));
                }
            }
            let Taken { segment, switches } = &mut *self.runner.observer;
            if let Some(segment) = segment.take() {
                return Some(Ok(StepTaken { segment, switches: std::mem::take(switches) }));
            }
        }
        None
    }
}
