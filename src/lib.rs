#![doc = include_str!("../README.md")]
#![cfg_attr(docsrs, feature(doc_cfg))]

/// Integration of piecewise-smooth ODEs: Dormand–Prince pairs, decided guards, hybrid runs.
pub use stickslip_solver as solver;

/// The collision of frictional viscoelastic spheres, integrated and exact.
#[cfg(feature = "model")]
pub use stickslip_model as model;

/// Curves in a parameter plane on which the switching changes.
pub use stickslip_tracer as tracer;

/// What collisions do over a plane of parameters: families, maps, atlases.
#[cfg(feature = "model")]
pub use stickslip_plane as plane;

/// Pictures as SVG, and with the feature `png` as PNG and GIF.
#[cfg(feature = "figure")]
pub use stickslip_figure as figure;

/// What users of particle codes ask: errors of time steps, constants from experiments.
#[cfg(feature = "practice")]
pub use stickslip_practice as practice;

/// The limit of stiff springs, and how accurate the integrators are.
#[cfg(feature = "studies")]
pub use stickslip_studies as studies;

/// The paper checked: its statements and figures.
#[cfg(feature = "reproduction")]
pub use stickslip_reproduction as reproduction;
