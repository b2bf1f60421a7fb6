//! Laws of the contact, as hybrid systems.
//!
//! There is one so far, [`regularized`]: viscoelastic spheres and a tangential spring of constant
//! stiffness. A further law is a file beside it. [`phase`] holds what laws have in common.

pub(crate) mod phase;
pub mod regularized;
