//! Spheres and walls in SI units: from bodies and their motions to a scaled
//! [`Contact`](crate::Contact), and from its [`Collision`](crate::Collision) back to forces,
//! motions and energies.

pub mod bodies;
pub mod encounter;
pub mod forces;
pub(crate) mod moment;
pub(crate) mod observed;
pub(crate) mod outcome;
pub mod quantity;
pub(crate) mod report;
pub mod scaling;
mod units;

pub use bodies::{Body, Elasticity, Material, Reduction, Sphere, Surface, Wall};
pub use encounter::{Encounter, Motion, WallMotion};
pub use forces::{Constants, Forces};
pub use moment::ForceSnapshot;
pub use nalgebra::Vector3;
pub use observed::Observed;
pub use outcome::{EnergyAccount, ForceSwitch, ImpactOutcome};
pub use report::{Comparison, ImpactReport};
pub use scaling::{BodyPair, Impact};
