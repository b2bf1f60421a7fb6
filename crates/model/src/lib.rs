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

mod contact;
mod engines;
mod laws;
mod limits;
mod numerics;
mod result;
#[cfg(feature = "serde")]
mod serialize;
mod spheres;

pub use contact::{Contact, InvalidParameter};
pub use engines::domain::OutOfDomain;
pub use engines::history::{History, PhaseHistory, Snapshot};
/// The [`integrator`] under a second name.
pub use engines::integrator as collision;
pub use engines::integrator::{Collider, CollisionError};
pub use engines::sensitivity::{Derived, Sensitivity};
pub use engines::{Engine, EngineError, Tolerances};
pub use engines::{exact, history, integrator, sensitivity};
pub use laws::phase::{Regime, Side};
pub use laws::regularized;
pub use limits::{coulomb, inner, largest, normal};
pub use nalgebra::Vector3;
pub use result::{Collision, EnergyLedger, FEW_SWITCHES, NotFinite, Switch, Switches};
pub use spheres::bodies::{Body, Elasticity, Material, Sphere, Wall};
pub use spheres::encounter::{Encounter, EncounterError, Motion, WallMotion};
pub use spheres::observed::Observed;
pub use spheres::outcome::{EnergyAccount, ForceSwitch, Outcome};
pub use spheres::reduction::Reduction;
pub use spheres::report::{Comparison, ImpactReport};
pub use spheres::scaling::{Impact, Pair, Surface};
pub use spheres::{bodies, encounter, quantity, scaling};

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
pub struct Readme;
