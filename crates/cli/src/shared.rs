//! What several commands have in common: options, with their checks and what they lead to.
//!
//! Start reading in `collision` (the parameters of collisions, one by one or as intervals); then
//! `law` and `method` (what is computed, and how), `system` (systems that are texts), `orbit`
//! (their periodic orbits), `files`
//! (outputs are files of their own), `batch` (a file with a case in each row), `course` (forces
//! against time), `threads` and `study` (how the work runs).

pub mod batch;
pub mod collision;
pub mod course;
pub mod files;
pub mod law;
pub mod method;
pub mod orbit;
pub mod study;
pub mod system;
pub mod threads;

use clap::ValueEnum;

/// How one result is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// A readable table
    Table,
    /// One JSON object
    Json,
}
