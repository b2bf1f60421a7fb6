//! The figures of the paper computed anew, and all parts of the reproduction.
//!
//! Start reading in [`Reproduction`]; then, in this order: [`Section`] (what a part results in),
//! `figure1` to `figure6`, `boundaries` and `studies` (the parts), `points` (where the points a to o
//! of Figure 4 are), `sweep` and `course` (what several figures need).

mod boundaries;
mod course;
mod figure1;
mod figure2;
mod figure3;
mod figure4;
mod figure5;
mod figure6;
mod points;
mod reproduction;
mod section;
mod studies;
mod sweep;

pub use reproduction::{Part, Reproduction};
pub use section::{Content, DataFile, Objection, Section};
pub use sweep::Sweep;
