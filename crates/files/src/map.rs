//! The files of a map: while it is computed, and when it is finished.
//!
//! Start reading in `task` (what is computed, divided into tiles); then, in this order: `results`
//! and `tiles` (what is stored, and where), `part_file` and `parts` (a map that is computed in
//! parts), `provenance` (what a map says about itself), `npz` and `csv` (the finished map),
//! `thumbnail` (what of it is drawn).

pub mod csv;
pub mod npz;
pub mod part_file;
mod parts;
mod provenance;
mod results;
mod task;
pub mod thumbnail;
mod tiles;

pub use parts::Parts;
pub use provenance::Provenance;
pub use results::{Results, Stored};
pub use task::Task;
pub use tiles::{Found, Tiles};
