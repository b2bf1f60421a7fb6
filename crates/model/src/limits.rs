//! Closed forms and limits with which collisions are compared.

pub mod coulomb;
pub mod inner;
pub mod largest;
pub mod normal;
