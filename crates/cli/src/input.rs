//! What is read: numbers and ranges, columns of a file, JSON files of bodies.

pub mod bodies;
pub mod json;
pub mod number;
pub mod parameter;
pub mod range;
pub mod recipe;
pub mod rows;
