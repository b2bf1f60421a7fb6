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
pub mod finding;
mod frame;
mod interior;
pub mod locate;
pub mod outline;
pub mod region;
pub mod subdivision;
pub mod verify;
