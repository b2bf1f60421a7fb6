//! What users of the facade rely on: runs and collisions allocate nothing, atlases of
//! the collision are those of the references, and the battery of events is found.

mod allocations;
mod atlas;
mod battery;
#[path = "../battery/cases.rs"]
#[allow(dead_code, reason = "the example uses the rest")]
mod cases;
#[path = "../common/mod.rs"]
mod common;
