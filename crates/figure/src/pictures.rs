//! Whole pictures, each drawn from data.
//!
//! Start reading in [`course`] and [`collision`]. Then [`gallery`] (many collisions), [`chart`]
//! (series of points), [`map`] and [`grid`] (quantities on a plane), [`atlas`] (boundaries on a
//! plane), [`family`] (an atlas of any family), [`stack`] (atlases over the damping), [`run`] (the
//! course of a run), [`branch`] (orbits over a parameter), and what users of particle codes and
//! studies compute: `fit`, `time_steps` and `studies`, each behind a feature.

pub mod atlas;
pub mod branch;
pub mod chart;
pub mod collision;
pub mod course;
pub mod family;
#[cfg(feature = "practice")]
pub mod fit;
pub mod gallery;
pub mod grid;
pub mod map;
mod regions;
pub mod run;
pub mod stack;
#[cfg(feature = "studies")]
pub mod studies;
#[cfg(feature = "practice")]
pub mod time_steps;
