//! Families: systems of one's own that depend on two parameters.
//!
//! In reading order: `blueprint` (what Python passes, and the systems of the family),
//! `runner` (what the tracer sees), `survey` (threads, progress, Ctrl-C), `atlas` (what is found),
//! `family` (what Python calls), `stack` (a third parameter), `failure` (why nothing is found).

mod atlas;
mod blueprint;
mod failure;
mod family;
mod runner;
mod stack;
mod survey;

pub use atlas::FamilyAtlas;
pub use family::HybridFamily;
pub use stack::stack_family;
