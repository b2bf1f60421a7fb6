//! Studies of the collision of frictional viscoelastic spheres: the limit of stiff springs, how
//! accurate the integrators are, also for a system of one's own, and what the contact laws of
//! particle codes do.
//!
//! Each study is a function from plain settings to what was measured, of which a [`Study`] is made:
//! findings in sentences, numbers and tables. `stickslip_figure::pictures` draws it. No study
//! writes files. Parallel loops run on the rayon pool of the caller.
//!
//! Start reading in [`study`]; then, in this order: [`paper`] (what the symbols and axes of the
//! paper mean), [`stiff_springs`] (the limit of stiff springs), [`convergence`] (how accurate the
//! integrators are), [`own_system`] (the same for a system that is a text), [`contact_laws`] (the
//! laws of particle codes), [`search`] (maxima and zeros), [`unreset`] and [`three_parameters`]
//! (the collision with another spring, and in other parameters).
//! The figures and statements of the paper are studies of `stickslip-reproduction`.
//!
//! ```
//! use stickslip_plane::{Range, progress};
//! use stickslip_studies::stiff_springs::{self, StiffSpringSettings};
//!
//! let kappa = Range { low: 10.0, high: 100.0 };
//! let settings = StiffSpringSettings { kappa, psi: vec![1.0] };
//! let measured = stiff_springs::run(&settings, progress::SILENT)?;
//! assert_eq!(measured.study().tables[0].name, "asymptote_envelope");
//! # Ok::<(), stickslip_studies::StudyError>(())
//! ```

pub mod contact_laws;
pub mod convergence;
mod error;
mod limits;
pub mod own_system;
pub mod paper;
pub mod search;
pub mod stiff_springs;
pub mod study;
pub mod three_parameters;
pub mod unreset;

pub use error::StudyError;
pub use study::{Cell, Study, StudyColumn, StudyTable};

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
pub struct Readme;
