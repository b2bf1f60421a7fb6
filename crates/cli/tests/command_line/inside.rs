//! Private modules of the crate, compiled here with the tests that stand in them, so that the crate
//! is not compiled once more for these.

#![allow(dead_code, reason = "the tests need a part of each module")]

#[path = "../../src/shared/batch"]
mod batch {
    mod piece;
}

#[path = "../../src/output"]
mod output {
    mod text;
}

#[path = "../../src/page"]
mod page {
    mod markup;
}
