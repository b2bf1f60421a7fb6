//! Whole pictures, each drawn from data.

pub mod atlas;
pub mod chart;
pub mod collision;
pub mod course;
pub mod gallery;
pub mod grid;
pub mod map;
