//! What collisions of frictional spheres do over a plane of parameters.
//!
//! Two numbers decide the switching of an undamped collision, the scaled stiffness κ and the impact
//! ratio ψ. This crate asks what happens over the plane of both: a [`CollisionPlane`] is the family
//! that the tracer follows, a [`Grid`] is a window divided into cells whose collisions [`sweep`]
//! computes, and an [`Atlas`](atlas::Atlas) holds every boundary on which the switches change, with
//! the regions between them.
//!
//! Start reading in [`family`]; then, in this order: [`range`], [`grid`], [`tile`] and [`sweep`] (maps
//! on a grid), [`atlas`] (boundaries and regions, verified), [`progress`].
//!
//! ```
//! use stickslip_plane::atlas::{Frame, trace};
//! use stickslip_plane::{Range, progress};
//!
//! let kappa = Range { low: 5.0, high: 8.0 };
//! let psi = Range { low: 0.8, high: 1.2 };
//! let frame = Frame { kappa, psi, ratio: None, damping: 0.0 };
//! let verified = trace(frame, frame.tolerances().usual, progress::SILENT)?;
//! assert!(verified.report.agrees);
//! // Every region has an itinerary: `+o-` is slip, stick and slip to the other side.
//! assert!(verified.atlas.regions.regions().len() > 1);
//! # Ok::<(), stickslip_plane::atlas::AtlasError>(())
//! ```
//!
//! Parallel loops run on the rayon pool of the caller. Each point depends on itself alone, so that
//! results do not depend on the number of threads.

pub mod atlas;
pub mod family;
pub mod grid;
pub mod progress;
pub mod range;
pub mod sweep;
pub mod tile;

pub use family::{CollisionFamily, CollisionFamilyError, CollisionPlane};
pub use grid::{Coordinates, Extent, Grid, GridAxis, Quantity};
pub use range::Range;
pub use tile::Tile;

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
pub struct Readme;
