//! Runs from switch to switch, and observers that record them.
//!
//! Start reading in `runner` (the loop), `instant` (the events of one instant, in order) and
//! `clock` (the independent variable). Then come `smooth` (problems without guards), `closures`
//! (systems of closures), `steps` (a run as an iterator), `trajectory` (recorded runs), `samples`
//! (output at given times), `both` (two observers), `backwards` (runs that go backwards), `by_name`
//! (pairs that are chosen at run time), `weighted` (tolerances of components) and `unlocated` (runs
//! without event location, for comparison). `finite`, `rejected` and `last_part` are what several
//! of these need.

pub(crate) mod at_switches;
pub(crate) mod backwards;
pub(crate) mod both;
mod by_name;
pub(crate) mod clock;
mod closures;
pub(crate) mod finite;
pub(crate) mod rejected;
pub(crate) mod runner;
mod samples;
pub mod smooth;
mod steps;
pub mod trajectory;
mod unlocated;
mod weighted;

use crate::error::RunError;
use crate::hybrid::Run;

pub use backwards::run_backwards;
pub use by_name::run_with;
pub use closures::Closures;
pub use runner::run;
pub use samples::{Sample, Samples};
pub use smooth::integrate;
pub use steps::{StepTaken, Stepper, Steps};
pub use trajectory::{Recorder, Trajectory, TrajectorySegment};
pub use unlocated::run_over_switches;
pub use weighted::Weighted;

impl<Mode, const N: usize> Run<Mode, N> {
    /// The run, if it came to a regular end: the end of its span or a terminal guard.
    ///
    /// # Errors
    /// [`RunError::Unfinished`] if the run ended early: at a limit, at an accumulation of switches,
    /// or because the observer stopped it.
    pub fn finished(self) -> Result<Self, RunError> {
        RunError::unless_regular(self.outcome, self.s).map(|()| self)
    }
}
