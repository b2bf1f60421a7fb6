//! The exact solution of a collision: a second opinion, which shares nothing with the integrator
//! but the contact and the shape of the result.
//!
//! Start reading in [`exact`], the solution of the paper's law; [`linear`] is the solution of
//! linear contacts, and `domain` has the ranges of both.

mod domain;
pub mod exact;
pub mod linear;

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
pub struct Readme;
