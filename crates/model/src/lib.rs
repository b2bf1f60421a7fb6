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
//! | [`spheres`] | SI units: [`quantity`](spheres::quantity), [`bodies`](spheres::bodies), [`scaling`](spheres::scaling) to a [`Contact`], [`encounter`](spheres::encounter) in three dimensions, its [`ImpactOutcome`](spheres::ImpactOutcome) and [`ImpactReport`](spheres::ImpactReport) |
//! | [`limits`] | [`normal`](limits::normal), [`coulomb`](limits::coulomb), [`largest`](limits::largest), [`inner`](limits::inner): closed forms and limits to compare with |
//! | | [`restitution`]: the damping with which a law has a coefficient of normal restitution |
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

mod engines;
pub mod limits;
pub mod restitution;
pub mod spheres;

#[cfg(feature = "serde")]
pub mod document;
#[cfg(feature = "serde")]
mod serialize;
pub mod text;

pub use engines::error::{CollisionError, CollisionFailure};
#[doc(hidden)]
pub use engines::integrator as collision;
pub use engines::integrator::Collider;
pub use engines::{Engine, Estimate, Tolerances};
pub use engines::{history, integrator, sensitivity};
pub use spheres::Reduction;
#[doc(inline)]
pub use stickslip_contact::domain::OutOfDomain;
#[doc(inline)]
pub use stickslip_contact::{
    Collision, Contact, ContactEnd, CoulombTest, Damping, EnergyLedger, FEW_SWITCHES, Friction,
    GivenValue, HistoryOf, InvalidValue, Law, Normal, NotFinite, OtherLaw, Regime, Side,
    SpringEnergy, Switch, Switches, Tangential, adhesive, general, presets, regularized,
};
#[doc(inline)]
pub use stickslip_exact::{exact, linear};

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
pub struct Readme;
