//! Periodic orbits of piecewise-smooth ODEs.

mod admissible;
mod branch;
#[cfg(feature = "serde")]
pub mod document;
mod equations;
mod error;
mod find;
mod itinerary;
mod multipliers;
mod newton;
mod orbit;

pub use branch::{Branch, BranchOptions, SpecialKind, SpecialOrbit};
pub use error::OrbitError;
pub use find::{Guess, Orbits};
pub use itinerary::Leg;
pub use orbit::{Obstacle, Orbit, Segment, Verdict};
