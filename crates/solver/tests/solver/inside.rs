//! Private modules of the crate, compiled here with the tests that stand in them, so that the crate
//! is not compiled once more for these.

#![allow(dead_code, reason = "the tests need a part of each module")]

pub use stickslip_solver::hybrid;

#[path = "../../src/events"]
pub mod events {
    pub mod isolate {
        mod notice;

        pub(crate) use notice::{Notice, Touch};
    }
    mod notices;
}
