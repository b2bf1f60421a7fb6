//! The collision of two frictional viscoelastic spheres, integrated and exact.
//!
//! During one contact the tangential force switches several times between Coulomb sliding and a
//! spring (Schwager, Becker and Pöschel, Eur. Phys. J. E 27, 107, 2008). In scaled variables a
//! collision has three parameters: the stiffness κ, the impact ratio ψ and the damping. Together
//! they are a [`Contact`]. A [`Collider`] integrates its collision; [`exact::collide`] solves it
//! without steps. Both return a [`Collision`] with every switch, and an [`Engine`] is a choice
//! between them.
//!
//! Start reading in [`integrator`]. Two crates below have what engines share and the exact
//! solution; what users need of them is here too. The source has one folder for each idea; in
//! reading order:
//!
//! | crate or folder | modules |
//! |---|---|
//! | `stickslip-contact` | [`Law`]: a contact law as data; [`presets`]: laws of particle codes; [`regularized`], [`general`]: the equations of the paper's law and of any law as hybrid systems; what every engine returns: [`Collision`], [`Switch`], [`EnergyLedger`] |
//! | `stickslip-exact` | [`exact`]: the solution of the paper's law; [`linear`]: the solution of linear contacts |
//! | `engines` | [`integrator`]: collisions by steps; [`history`]: their course in time; [`sensitivity`]: their derivatives |
//! | `spheres` | SI units: [`quantity`], [`bodies`], [`scaling`] to a [`Contact`], [`encounter`] in three dimensions, its [`Outcome`] and [`ImpactReport`] |
//! | `limits` | [`normal`], [`coulomb`], [`largest`], [`inner`]: closed forms and limits to compare with |
//! | | [`text`]: numbers in sentences and pictures |
//!
//! With the feature `serde`, results serialise themselves, and `document` says what computed them.
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

#[cfg(feature = "serde")]
pub mod document;
mod engines;
mod limits;
#[cfg(feature = "serde")]
mod serialize;
mod spheres;
pub mod text;

pub use engines::history::{History, Moment, PhaseHistory, Snapshot};
#[doc(hidden)]
pub use engines::integrator as collision;
pub use engines::integrator::{Collider, CollisionError};
pub use engines::sensitivity::{Derived, Sensitivity};
pub use engines::{Engine, EngineError, Estimate, InvalidChoice, Tolerances};
pub use engines::{history, integrator, sensitivity};
pub use limits::{coulomb, inner, largest, normal};
pub use nalgebra::Vector3;
pub use spheres::bodies::{Body, Elasticity, Material, Sphere, Wall};
pub use spheres::encounter::{Encounter, EncounterError, Motion, WallMotion};
pub use spheres::forces::{Constants, Forces, InvalidForces};
pub use spheres::moment::ForceSnapshot;
pub use spheres::observed::Observed;
pub use spheres::outcome::{EnergyAccount, ForceSwitch, Outcome};
pub use spheres::reduction::Reduction;
pub use spheres::report::{Comparison, ImpactReport};
pub use spheres::scaling::{BodyPair, Impact};
pub use spheres::surface::Surface;
pub use spheres::{bodies, encounter, quantity, scaling};
#[doc(inline)]
pub use stickslip_contact::domain::OutOfDomain;
#[doc(inline)]
pub use stickslip_contact::{
    Collision, Contact, Damping, End, EnergyLedger, FEW_SWITCHES, HistoryOf, InvalidParameter, Law,
    Normal, NotFinite, OtherLaw, Regime, Side, SpringEnergy, Switch, Switches, Tangential, general,
    presets, regularized,
};
#[doc(inline)]
pub use stickslip_exact::{exact, linear};

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
pub struct Readme;
