//! Private modules of the crate, compiled here with the tests that stand in them, so that the crate
//! is not compiled once more for these.

#![allow(dead_code, reason = "the tests need a part of each module")]

#[path = "../../src/engines/integrator"]
mod integrator {
    mod reversals;
}

#[path = "../../src/limits"]
mod limits {
    mod inner;
}
