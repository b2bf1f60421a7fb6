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
pub(crate) mod reduction;
pub(crate) mod report;
pub mod scaling;
pub(crate) mod surface;
