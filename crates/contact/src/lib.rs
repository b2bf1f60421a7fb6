//! The contact of two frictional spheres: its parameters, its law as data and as equations, and
//! what a collision is.
//!
//! In scaled variables a collision has three parameters: the stiffness κ, the impact ratio ψ and
//! the damping. With a [`Law`] they are a [`Contact`]. Whoever computes its [`Collision`] uses the
//! names of this crate: `stickslip-exact` solves the equations in closed form, `stickslip-model`
//! integrates them.
//!
//! Start reading in [`Contact`]; then, in this order: `law` (a contact law as data), `contact`
//! (parameters), [`phase`] (what all laws have in common), [`presets`] (the laws of particle
//! codes), [`regularized`], [`general`] and [`adhesive`] (the equations of the paper's law, of any
//! law, and of laws with adhesion as hybrid systems), `start` (how near a contact is to starting
//! otherwise), `result` (what every engine returns), [`domain`] (ranges of engines), [`numerics`]
//! (numbers with twice the digits, roots in a bracket).
//!
//! With the feature `serde`, results serialise themselves.

pub mod adhesive;
mod contact;
pub mod domain;
pub mod general;
mod law;
pub mod numerics;
pub mod phase;
pub mod presets;
pub mod regularized;
mod result;
#[cfg(feature = "serde")]
mod serialize;
mod start;

pub use contact::{Contact, OtherLaw};
pub use law::{
    ContactEnd, CoulombTest, Damping, Friction, HistoryOf, Law, Normal, SpringEnergy, Tangential,
};
pub use phase::{Regime, Side};
pub use result::{Collision, EnergyLedger, FEW_SWITCHES, NotFinite, Switch, Switches};
pub use stickslip_solver::{GivenValue, InvalidValue};

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
pub struct Readme;
