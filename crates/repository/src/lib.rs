//! What must hold of the repository as a whole, and of no crate alone: `cargo test -p repository`.
