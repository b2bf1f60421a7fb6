//! Spheres and walls in SI units.

pub mod bodies;
pub mod encounter;
pub(crate) mod observed;
pub(crate) mod outcome;
pub mod quantity;
pub(crate) mod reduction;
pub(crate) mod report;
pub mod scaling;
