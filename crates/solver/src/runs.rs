//! Runs from switch to switch, and observers that record them.
//!
//! Start reading in `runner` (the loop) and `clock` (its independent variable). Then come `smooth`
//! (problems without guards), `trajectory` (recorded runs) and `unlocated` (runs without event
//! location, for comparison).

pub(crate) mod clock;
pub(crate) mod runner;
pub mod smooth;
pub mod trajectory;
mod unlocated;

pub use runner::run;
pub use smooth::integrate;
pub use trajectory::{Recorder, Segment, Trajectory};
pub use unlocated::run_over_switches;
