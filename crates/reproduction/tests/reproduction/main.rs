//! Tests of the reproduction, in one program.

mod parts;
mod refusals;
