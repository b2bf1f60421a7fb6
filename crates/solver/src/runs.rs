//! Runs from switch to switch, and observers that record them.
//!
//! Start reading in `runner` (the loop), `instant` (the events of one instant, in order) and
//! `clock` (the independent variable). Then come `smooth` (problems without guards), `closures`
//! (systems of one mode), `trajectory` (recorded runs), `samples` (output at given times), `both`
//! (two observers), `backwards` (runs that go backwards), `by_name` (pairs that are chosen at run
//! time), `weighted` (tolerances of components) and `unlocated` (runs without event location, for
//! comparison). `finite`, `rejected` and `last_part` are what several of these need.

pub(crate) mod at_switches;
pub(crate) mod backwards;
mod both;
mod by_name;
pub(crate) mod clock;
mod closures;
pub(crate) mod finite;
pub(crate) mod rejected;
pub(crate) mod runner;
mod samples;
pub mod smooth;
pub mod trajectory;
mod unlocated;
mod weighted;

pub use backwards::run_backwards;
pub use by_name::run_with;
pub use closures::Closures;
pub use runner::run;
pub use samples::{InvalidTimes, Sample, Samples};
pub use smooth::integrate;
pub use trajectory::{Recorder, Segment, Trajectory};
pub use unlocated::run_over_switches;
pub use weighted::Weighted;
