//! The collision of two frictional viscoelastic spheres.

pub mod collision;
mod contact;
mod energy;
pub mod exact;
pub mod regularized;
mod reversals;

pub use collision::{Collider, CollisionError};
pub use contact::{Collision, Contact, InvalidContact, Regime, Side, Switch};
pub use energy::EnergyLedger;
