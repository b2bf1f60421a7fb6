//! Atlases: every boundary in a window on which the switches of a collision change, and the regions
//! between them.
//!
//! Start reading in [`trace()`](fn@trace), which makes a [`CollisionAtlas`] and verifies it. The
//! files in reading order:
//!
//! - `frame`: the window of an atlas
//! - `boundary`: what the tracer's margins mean for a collision
//! - `regions`: the atlas itself
//! - `tracing` and `draft`: how an atlas is made, and `error`: why there is none
//! - `verification`: what the comparison with collisions found
//! - `locate`: how points are looked up in it
//! - `angles`: where lines cross its boundaries, also those of impacts of one speed
//! - `geojson` and `document`: how it is exported, written and read back

mod angles;
mod boundary;
#[cfg(feature = "serde")]
mod document;
mod draft;
mod error;
mod frame;
#[cfg(feature = "geojson")]
mod geojson;
mod locate;
mod regions;
mod tracing;
mod verification;

pub(crate) use crate::family::general::itinerary;
pub use crate::sheet::ToleranceRange;
pub use angles::ObliqueBoundaries;
pub use boundary::BoundaryKind;
#[cfg(feature = "serde")]
pub use document::{
    AtlasDocument, AtlasDocumentError, BoundaryEnd, BoundaryFields, ExtremalParameter,
    ExtremumFields, RegionFields, SCHEMA, Switching, VertexFields, WindowFields,
};
pub use error::AtlasError;
pub use frame::{Frame, RatioRange};
#[cfg(feature = "geojson")]
pub use geojson::{document_geojson, geojson};
pub use locate::{Located, ParameterPlace, Unlocated};
pub(crate) use regions::polyline;
pub use regions::{CollisionAtlas, Regions, switch_count};
pub use tracing::{divide, trace, trace_with};
pub(crate) use tracing::{require_traceable, trace_options};
pub use verification::{EulerFields, MismatchFields, VerificationReport};
