//! The collision of two frictional viscoelastic spheres, integrated and exact.
//!
//! During one contact the tangential force switches several times between Coulomb sliding and a
//! spring (Schwager, Becker and Pöschel, Eur. Phys. J. E 27, 107, 2008). In scaled variables two
//! numbers decide all of it, the stiffness κ and the impact ratio ψ, and a third one with damping:
//! a [`Contact`]. A [`Collider`] integrates it, [`exact::collide`] solves it in closed form where
//! there is no damping; both return a [`Collision`] with every switch.
//!
//! Start reading in [`collision`]; then [`regularized`] (the equations), [`exact`] (the closed form),
//! [`Engine`] (either of them), [`history`] (its course in time), [`scaling`] (SI units), [`bodies`] and
//! [`encounter`] (spheres in three dimensions), [`normal`], [`coulomb`], [`largest`] and [`inner`] (closed
//! forms to compare with), [`sensitivity`] (derivatives).
//!
//! ```
//! use stickslip_model::{Collider, Contact, exact};
//!
//! let contact = Contact::new(18.0, 0.4, 0.0)?;
//! let integrated = Collider::default().collide(contact)?;
//! let closed = exact::collide(contact)?;
//! assert_eq!(integrated.itinerary(), closed.itinerary());
//! assert!((integrated.eps_t() - closed.eps_t()).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod bodies;
pub mod collision;
mod contact;
pub mod coulomb;
mod domain;
pub mod encounter;
mod energy;
mod engine;
pub mod exact;
pub mod history;
pub mod inner;
pub mod largest;
mod last_slip;
mod law;
pub mod normal;
mod observed;
mod outcome;
mod double_double;
pub mod quantity;
mod reduction;
mod refine;
pub mod regularized;
mod reversals;
pub mod scaling;
pub mod sensitivity;

pub use bodies::{Body, Elasticity, Material, Sphere, Wall};
pub use collision::{Collider, CollisionError};
pub use contact::{
    Collision, Contact, FEW_SWITCHES, InvalidParameter, Regime, Side, Switch, Switches,
};
pub use domain::OutOfDomain;
pub use encounter::{Encounter, EncounterError, Motion, WallMotion};
pub use energy::EnergyLedger;
pub use engine::{Engine, EngineError, NotFinite, Tolerances};
pub use history::{History, PhaseHistory, Snapshot};
pub use nalgebra::Vector3;
pub use observed::Observed;
pub use outcome::{EnergyAccount, ForceSwitch, Outcome};
pub use reduction::Reduction;
pub use scaling::{Impact, Pair, Surface};
pub use sensitivity::{Derived, Sensitivity};

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
pub struct Readme;
