//! The figures of the paper computed anew, and all parts of the reproduction.
//!
//! Start reading in [`Part`]; then, in this order: [`Section`] (the result of a part),
//! [`Reproduction`] (what parts share), `figure1` to `figure6` and `boundaries` (the parts),
//! `points` (where the points a to o of Figure 4 are), `stiffness_map`, [`Sweep`] and
//! `course` (what several figures need).

pub mod boundaries;
mod course;
mod figure1;
pub mod figure2;
mod figure3;
mod figure4;
mod figure5;
mod figure6;
mod points;
mod reproduction;
mod section;
mod stiffness_map;
mod sweep;

pub use reproduction::{Part, Reproduction};
pub use section::{Content, DataFile, Section, headlines};
pub use sweep::Sweep;
