//! Families: systems of one's own that depend on two parameters.
//!
//! In reading order: `blueprint` (what Python passes), `member` (one system of the family), `sizes`
//! (a family of any dimension as one type), `family` (what the tracer sees, and what Python calls),
//! `survey` (threads, progress, Ctrl-C), `atlas` (what is found), `failure` (why nothing is).

mod atlas;
mod blueprint;
mod failure;
mod family;
mod member;
mod sizes;
mod survey;

pub use atlas::FamilyAtlas;
pub use family::HybridFamily;
