//! Tests of the reproduction, in one program.

mod inside;
mod parts;
mod refusals;

// Where modules of the crate find each other.
use inside::source::error;
