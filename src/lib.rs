#![doc = include_str!("../README.md")]

/// Integration of piecewise-smooth ODEs: Dormand–Prince pairs, decided guards, hybrid runs.
pub use stickslip_solver as solver;

/// The collision of frictional viscoelastic spheres, integrated and exact.
pub use stickslip_model as model;

/// Curves in a parameter plane on which the switching changes.
pub use stickslip_tracer as tracer;

pub mod collisions;
