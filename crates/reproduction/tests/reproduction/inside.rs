//! The statements, compiled here with the tests that stand in them and reach their private parts,
//! so that the crate with its figures is not compiled once more for these.

#![allow(dead_code, unused_imports, reason = "the tests need a part of each module")]

#[path = "../../src"]
pub mod source {
    pub mod error;
    pub mod statements;
}
