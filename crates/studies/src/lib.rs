//! The paper checked: T. Schwager, V. Becker and T. Pöschel, *Coefficient of tangential restitution
//! for viscoelastic spheres*, Eur. Phys. J. E 27, 107 (2008), computed anew.
//!
//! Each study is a function from plain settings to a [`Study`]: findings in sentences, numbers,
//! tables and pictures. It writes no files. Parallel loops run on the rayon pool of the caller.
//!
//! Start reading in [`study`]; then, in this order: [`paper`] (what the paper's symbols and axes
//! mean), [`figures`] (its figures, and everything together), [`statements`] (its statements, each
//! with a verdict), [`stiff_springs`] (the limit of stiff springs), [`convergence`] (how accurate
//! the integrators are), `search` (maxima and zeros).
//!
//! ```
//! use stickslip_studies::statements::{self, Spring, Verdict};
//!
//! // Statement 4: a collision ends with sliding.
//! let audit = statements::run(Spring::Reset, &[4], stickslip_plane::progress::SILENT)?;
//! assert_eq!(audit.statements[0].finding.verdict, Verdict::Holds);
//! # Ok::<(), stickslip_studies::StudyError>(())
//! ```

pub mod convergence;
mod error;
pub mod figures;
pub mod paper;
mod search;
pub mod statements;
pub mod stiff_springs;
pub mod study;

pub use error::{CollisionFailure, StudyError};
pub use search::SearchError;
pub use study::{Cell, Column, Picture, Study, Table};

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
pub struct Readme;
