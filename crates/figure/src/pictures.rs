//! Whole pictures, each drawn from data.
//!
//! Start reading in [`course`] and [`collision`]. Then [`gallery`] (many collisions), [`chart`]
//! (series of points), [`map`] and [`grid`] (quantities on a plane), [`atlas`] (boundaries on a
//! plane), [`family`] (an atlas of any family), and [`stack`] (atlases over the damping).

pub mod atlas;
pub mod chart;
pub mod collision;
pub mod course;
pub mod family;
pub mod gallery;
pub mod grid;
pub mod map;
mod regions;
pub mod run;
pub mod stack;
