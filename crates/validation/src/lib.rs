//! Long batteries, whose figures are in docs/validation.md.
//!
//! Each is an example: `cargo run --release -p validation --example NAME`. Tests run a part of
//! each.
