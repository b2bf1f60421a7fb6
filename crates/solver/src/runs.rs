//! Runs from switch to switch, and what is kept of them.

pub(crate) mod clock;
pub(crate) mod runner;
pub mod smooth;
pub mod trajectory;
mod unlocated;

pub use runner::run;
pub use smooth::integrate;
pub use trajectory::{Recorder, Segment, Trajectory};
pub use unlocated::run_over_switches;
