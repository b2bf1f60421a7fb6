//! The paper checked: T. Schwager, V. Becker and T. Pöschel, *Coefficient of tangential restitution
//! for viscoelastic spheres*, Eur. Phys. J. E 27, 107 (2008), computed anew.
//!
//! The crate computes the figures and tests the statements of the paper; all of it together is a
//! list of parts. No part writes files. Parallel loops run on the rayon pool of the caller. What
//! the paper's symbols and axes mean is in [`stickslip_studies::paper`].
//!
//! Start reading in [`figures`] (the figures, and all parts of the reproduction); then
//! [`statements`] (the statements, each with a verdict).
//!
//! ```
//! use stickslip_reproduction::statements::{self, Spring, StatementVerdict};
//!
//! // Statement 4: a collision ends with sliding.
//! let audit = statements::run(Spring::Reset, &[4], stickslip_plane::progress::SILENT)?;
//! assert_eq!(audit.statements[0].finding.verdict, StatementVerdict::Holds);
//! # Ok::<(), stickslip_reproduction::ReproductionError>(())
//! ```

mod error;
pub mod figures;
pub mod statements;

pub use error::ReproductionError;

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
pub struct Readme;
