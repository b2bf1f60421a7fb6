//! Laws of the contact, as hybrid systems.
//!
//! There is one so far, [`regularized`]: viscoelastic spheres with a tangential spring of constant
//! stiffness. Each further law is a file of its own beside it; [`phase`] is what they share.

pub(crate) mod phase;
pub mod regularized;
