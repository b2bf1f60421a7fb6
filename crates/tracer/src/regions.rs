//! What curves make of a window.
//!
//! In reading order: `subdivision` (curves in, regions out), `piece` and `slabs` (monotone pieces,
//! in order), `faces` and `union` (what is connected), `crossing`, `finding` and `outline` (what
//! can be wrong), `interior` (a place well inside), `locate` (where a point lies), `verify` (runs
//! against the subdivision).

mod crossing;
mod faces;
pub mod finding;
mod interior;
pub mod locate;
pub mod outline;
mod piece;
mod slabs;
pub mod subdivision;
mod union;
pub mod verify;
