//! The regions into which curves divide a window.
//!
//! In reading order:
//!
//! - `subdivision`: curves in, regions out
//! - `frame`: the window's boundary, cut at vertices
//! - `abscissae`: vertical curves made exactly vertical
//! - `arrangement`: the curves cut into pieces that have an order
//! - `region`: regions and their labels
//! - `interior`: a point well inside each region
//! - `finding`: what can be wrong
//! - `locate`: where a point lies
//! - `outline`: the rings around a region
//! - `verify`: runs against the subdivision

mod abscissae;
pub(crate) mod arrangement;
pub(crate) mod finding;
mod frame;
mod interior;
pub(crate) mod locate;
pub(crate) mod outline;
pub(crate) mod region;
pub(crate) mod subdivision;
pub(crate) mod verify;

pub use finding::{Euler, Finding, SubdivisionError};
pub use locate::Location;
pub use outline::OutlinePart;
pub use region::{CurveSide, Region};
pub use subdivision::Subdivision;
pub use verify::report::{Checkpoint, Mismatch, Origin, Reason, Unverified, Verification};
pub use verify::{VerifyOptions, verify, verify_unless_cancelled, verify_with};
