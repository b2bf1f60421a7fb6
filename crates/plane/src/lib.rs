//! What collisions of frictional spheres do over a plane of parameters.
//!
//! The stiffness κ, the impact ratio ψ and the damping, all scaled, decide how a collision switches
//! between stick and slip. This crate asks what happens over a plane of two parameters:
//!
//! - A [`CollisionPlane`] is the family of collisions over (κ, ψ) that the tracer can follow.
//! - A [`Grid`] is a window divided into cells, whose collisions [`sweep`] computes.
//! - A [`CollisionAtlas`](atlas::CollisionAtlas) holds every boundary on which the switches change,
//!   and the regions between the boundaries.
//!
//! Start reading in [`family`]. The modules in reading order:
//!
//! - [`chart`]: windows, and the coordinates in which the plane is traced
//! - [`label`] and [`family`]: collisions as a family for the tracer
//! - [`oblique`]: impacts of one speed at all angles
//! - [`sheet`]: a window in traced coordinates, and the accuracy of boundaries in it
//! - [`grid`]: windows divided into cells
//! - [`sweep`]: the results of a grid, and how they are computed
//! - [`progress`]: reports of how far a long computation has come, cancellation and threads
//! - [`atlas`]: boundaries and regions, traced and verified
//! - [`mod@stack`]: atlases over the damping, and what changes between them
//! - [`gaining`]: where |ε_t| is above 1
//! - `sealed`: documents with digests, so that a reader notices what has changed
//!
//! ```
//! use stickslip_plane::atlas::{Frame, trace};
//! use stickslip_plane::{Range, progress};
//!
//! let kappa = Range { low: 5.0, high: 8.0 };
//! let psi = Range { low: 0.8, high: 1.2 };
//! let frame = Frame::new(kappa, psi, 0.0);
//! let atlas = trace(frame, frame.tolerances().usual, progress::SILENT)?;
//! assert!(atlas.report.agrees);
//! // Every region has an itinerary: `+o-` is slip, stick and slip to the other side.
//! assert!(atlas.regions.regions().len() > 1);
//! # Ok::<(), stickslip_plane::atlas::AtlasError>(())
//! ```
//!
//! Parallel loops run on the rayon pool of the caller. Each point is computed for itself, so that
//! results do not depend on the number of threads.

pub mod atlas;
pub mod chart;
pub mod family;
pub mod gaining;
pub mod grid;
pub mod label;
pub mod oblique;
pub mod progress;
#[cfg(feature = "serde")]
pub mod sealed;
pub mod sheet;
pub mod stack;
pub mod sweep;

pub use chart::{Chart, Range};
pub use family::{CollisionFamily, CollisionPlane};
pub use grid::{Coordinates, Extent, Grid, GridAxis, Quantity};
pub use label::{CollisionEvent, CollisionLabel};
pub use oblique::Oblique;
pub use sheet::Sheet;
pub use sweep::Tile;

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
pub struct Readme;
