//! What users of the facade rely on: runs and collisions allocate nothing, the examples hold, and
//! atlases of the collision are those of the references.

mod allocations;
mod atlas;
#[path = "../common/mod.rs"]
mod common;
mod examples;
