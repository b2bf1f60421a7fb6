//! Laws and limits to compare collisions with, in closed form.

pub mod coulomb;
pub mod inner;
pub mod largest;
pub mod normal;
