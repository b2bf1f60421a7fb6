//! Atlases: every boundary in a window on which the switches of a collision change, and the regions
//! between them.
//!
//! Start reading in [`trace()`](fn@trace); then, in this order: `frame` (the window and its coordinates),
//! `boundary` (what the tracer's curves mean), `regions` (the atlas itself), `verification` (an atlas
//! against collisions), `traced` (how it is made), `locate` and `crossings` (how it is looked up),
//! `polyline`, `geojson` and `document` (how it is handed on and read back).

mod boundary;
mod crossings;
#[cfg(feature = "serde")]
mod document;
mod frame;
#[cfg(feature = "geojson")]
mod geojson;
mod locate;
mod polyline;
#[cfg(feature = "serde")]
mod read;
mod regions;
mod tracing;
mod verification;

pub use boundary::Kind;
#[cfg(feature = "serde")]
pub use document::{Document, SCHEMA};
pub use frame::{Frame, RatioRange, Tolerances, TooNarrow, scaled, traced};
#[cfg(feature = "geojson")]
pub use geojson::geojson;
pub use locate::{Located, Unlocated};
pub use polyline::polyline;
#[cfg(feature = "serde")]
pub use read::DocumentError;
pub use regions::{Atlas, Regions, switch_count};
pub use tracing::{AtlasError, VerifiedAtlas, trace};
pub use verification::{LabelError, VerificationReport};
