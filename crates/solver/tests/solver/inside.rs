//! Private modules of the crate, compiled here with the tests that stand in them, so that the crate
//! is not compiled once more for these.

#![allow(dead_code, reason = "the tests need a part of each module")]

pub use stickslip_solver::hybrid;

#[path = "../../src/number"]
pub mod number {
    mod four;
    mod interval;

    pub use interval::Interval;
}

#[path = "../../src/method"]
pub mod method {
    mod control;
    mod dense;
    pub mod state {
        pub use stickslip_solver::State;
    }
    pub mod tableau {
        pub use stickslip_solver::Method;
    }

    pub use stickslip_solver::method::INTERIOR_NODES;
}

#[path = "../../src/events"]
pub mod events {
    pub mod isolate {
        mod notice;

        pub(crate) use notice::{Notice, Touch};
    }
    mod notices;
    mod quick;
}
