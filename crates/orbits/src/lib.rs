//! Periodic orbits of piecewise-smooth ODEs, their stability, and where they change.
//!
//! [`Orbits`] has the orbits of a [`System`](stickslip_expression::System): a text, functions of
//! Python, or a [system of Rust](stickslip_expression::NativeSystem). An [`Orbit`] is found from a
//! [`Guess`], from a run that settles, or from an orbit at other parameters. [`Orbits::branch`]
//! follows it over a parameter and locates the [special orbits](SpecialOrbit) on the way;
//! [`Orbits::resumed`] goes on from the ends of a branch. [`Orbits::curve`] follows a special orbit
//! over two parameters, and [`Orbits::switched`] goes over to another branch at a flip or a branch
//! point. [`Orbits::regions`] has where over two parameters the orbit exists and is stable, as an
//! atlas. What runs lead to, orbit or not, is shown by [`Orbits::section`] and [`Orbits::diagram`]
//! as points, by [`Orbits::exponents`] as Lyapunov exponents, and by [`Orbits::basins`] over
//! initial values.
//!
//! ```
//! use stickslip_expression::System;
//! use stickslip_orbits::{Guess, Orbits, Verdict};
//!
//! // A relay with hysteresis. Each half of its orbit takes log((1 + width)/(1 - width)).
//! let relay = System::parse(
//!     "parameter width = 0.5\nstate x = 0\nmode up\n  x' = 1 - x\n  \
//!      when x > width \"down\" -> down\nmode down\n  x' = -1 - x\n  \
//!      when x < -width \"up\" -> up\nstart in up",
//! )?;
//! let orbits = Orbits::new(&relay)?;
//! let guess = Guess { itinerary: &["down", "up"], ..Guess::default() };
//! let orbit = orbits.find(&relay.values(), &guess)?;
//! assert!((orbit.period - 2.0 * 3.0_f64.ln()).abs() < 1e-12);
//! assert_eq!(orbit.verdict, Verdict::Admissible);
//! // The state is one number, whose direction is that of the orbit itself.
//! assert_eq!(orbit.multipliers, Some(vec![]));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A system of Rust has the same functions, once for all numbers:
//!
//! ```
//! use stickslip_expression::{Jump, NativeSystem, System};
//! use stickslip_orbits::{Guess, Orbits};
//! use stickslip_solver::{Direction, Guard, Number};
//!
//! /// A neuron that is driven, and forgets its potential when it fires.
//! struct Neuron;
//!
//! impl NativeSystem<1, 1, 1> for Neuron {
//!     type Mode = ();
//!
//!     fn parameters(&self) -> [(&str, f64); 1] {
//!         [("drive", 1.5)]
//!     }
//!     fn components(&self) -> [(&str, f64); 1] {
//!         [("v", 0.0)]
//!     }
//!     fn modes(&self) -> &[()] {
//!         &[()]
//!     }
//!     fn field<T: Number>(&self, (): (), drive: &[T; 1], _time: T, v: &[T; 1]) -> [T; 1] {
//!         [drive[0] - v[0]]
//!     }
//!     fn guards(&self, (): ()) -> [(&str, Guard); 1] {
//!         [("fires", Guard::new(Direction::Below))]
//!     }
//!     fn guard_values<T: Number>(&self, (): (), _: &[T; 1], _time: T, v: &[T; 1]) -> [T; 1] {
//!         [-v[0] + 1.0]
//!     }
//!     fn transition<T: Number>(
//!         &self, (): (), _: usize, _: &[T; 1], _time: T, _: &[T; 1],
//!     ) -> Jump<(), T, 1> {
//!         Jump::to((), [T::from(0.0)])
//!     }
//! }
//!
//! let orbits = Orbits::new(&System::of_native(&Neuron)?)?;
//! let guess = Guess { itinerary: &["fires"], ..Guess::default() };
//! let orbit = orbits.find(&[2.0], &guess)?;
//! assert!((orbit.period - 2.0_f64.ln()).abs() < 1e-13 && orbit.is_admissible());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Accuracy
//!
//! Flows are computed with a tolerance of 1e-13. Beside closed forms, states and special values of
//! parameters are right to 1e-11 of their size, and multipliers to 1e-11 of the largest one (the
//! tests have the figures). A verdict is decided: along the whole orbit, no condition of another
//! rule becomes negative, and that of its own rule does so at its end and not before. Where
//! rounding hides whether one does, the verdict says so. On a branch each *point* is decided; what
//! happens between two neighbours, and back again, is not seen.
//!
//! # What is refused
//!
//! Equations that jump within a mode (`if`, `sign` and `floor` of what moves): modes or `sliding
//! on` take their place. Orbits whose equations depend on the time need a rule `every …` in their
//! itinerary, whose period is that of the equations; or the phase as a component. Itineraries have
//! as many segments as make up to 1200 unknowns.
//!
//! The modules in reading order: `itinerary`, `orbit` and `error` are what is spoken of;
//! `equations` has the equations of an orbit with a prescribed itinerary; `newton` solves them by
//! the tracer's one search for points; `multipliers` and `admissible` judge what was found; `find`
//! and `settle` have the ways to an orbit, `branch` follows it, `regions` makes an atlas of it,
//! `attractors` looks at runs that need not settle, `watch` says how far work is, and `document`
//! writes orbits.

mod admissible;
mod attractors;
mod branch;
#[cfg(feature = "serde")]
pub mod document;
mod equations;
mod error;
mod find;
mod itinerary;
mod multipliers;
mod newton;
mod orbit;
mod regions;
mod settle;
mod spaces;
mod watch;

pub use attractors::{Attractor, Basins, Column, Exponents, Section, SectionPoint};
pub use branch::curve::{Meeting, SpecialCurve};
pub use branch::{Branch, BranchOptions, SpecialKind, SpecialOrbit};
pub use error::OrbitError;
pub use find::{Guess, Orbits};
pub use itinerary::Leg;
pub use orbit::{Obstacle, Orbit, Segment, Verdict};
pub use regions::{FollowedOrbits, OrbitAtlas, OrbitBoundary, OrbitNames, RegionOptions};
pub use stickslip_expression::InvalidValue;
pub use watch::OrbitWatch;

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
pub struct Readme;
