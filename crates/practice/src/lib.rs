//! What users of particle codes ask of the collision of two frictional spheres.
//!
//! [`time_steps`]: how wrong the coefficients of restitution are at the time step of a simulation,
//! and which step keeps their errors below a wanted one.
//!
//! [`mod@fit`]: the stiffness, friction and damping of a contact law with which it comes
//! closest to measured impacts.
//!
//! [`tables`]: the restitution over a window of parameters, to be looked up in nanoseconds, with a
//! bound of its error.
//!
//! [`inputs`]: the lines with which a particle code computes the contacts of two bodies.
//!
//! Each question is a function from plain settings to a result. Parallel loops run on the rayon
//! pool of the caller, and results do not depend on the number of threads.
//!
//! ```
//! use stickslip_model::{Contact, presets};
//! use stickslip_plane::progress;
//! use stickslip_practice::time_steps::{self, SteppedQuantity, TimeStepSettings};
//!
//! let law = presets::find("gran/hertz/history").ok_or("no such law")?.law;
//! let contact = Contact::new(4.0, 0.5, 0.1)?.with_law(law, 0.0)?;
//! let settings = TimeStepSettings { contacts: vec![contact], ..TimeStepSettings::default() };
//! let result = time_steps::run(&settings, progress::SILENT)?;
//! // Twenty steps a contact are few enough for errors of ε_t below 0.02 in this impact.
//! let largest = result.largest_step(SteppedQuantity::TangentialRestitution, 0.02);
//! assert_eq!(largest, Some(1.0 / 20.0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod fit;
pub mod inputs;
pub mod tables;
pub mod time_steps;

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
pub struct Readme;
