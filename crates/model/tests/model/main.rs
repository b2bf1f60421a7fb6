//! Tests of the model, in one program.
//!
//! References are in `tests/data` of the workspace, whose README says where they come from.

#[cfg(feature = "serde")]
mod serialization;
