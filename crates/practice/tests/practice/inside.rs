//! Private modules of the crate, compiled here with the tests that stand in them, so that the crate
//! is not compiled once more for these.

#![allow(dead_code, reason = "the tests need a part of each module")]

#[path = "../../src/fit"]
mod fit {
    use stickslip_practice::fit::{FitError, SearchError};

    mod minima;
    mod quantile;
    mod search;
}

#[path = "../../src/tables"]
mod tables {
    mod chebyshev;
    mod stretch;
}
