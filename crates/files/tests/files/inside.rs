//! Private modules of the crate, compiled here with the tests that stand in them, so that the crate
//! is not compiled once more for these.

#![allow(dead_code, reason = "the tests need a part of each module")]

pub mod error {
    pub use stickslip_files::FileError;
}

pub mod input {
    pub use stickslip_files::input::part;
}

#[path = "../../src/input/rows"]
mod rows {
    mod portions;
    mod scan;
}

#[path = "../../src/map"]
mod map {
    mod task;
}

#[path = "../../src/output"]
mod output {
    use stickslip_files::output::file;

    mod csv;
    mod npz;
    mod picture;
}
