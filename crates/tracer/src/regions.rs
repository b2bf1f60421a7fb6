//! What curves make of a window.
//!
//! In reading order: `subdivision` (curves in, regions out), `arrangement` (the curves cut into
//! pieces that have an order), `finding` and `outline` (what can be wrong), `interior` (a place
//! well inside), `locate` (where a point lies), `verify` (runs against the subdivision).

mod arrangement;
pub mod finding;
mod interior;
pub mod locate;
pub mod outline;
pub mod subdivision;
pub mod verify;
