//! Private modules of the crate, compiled here with the tests that stand in them, so that the crate
//! is not compiled once more for these.

#![allow(dead_code, reason = "the tests need a part of each module")]

pub mod curve {
    pub use stickslip_tracer::{Curve, Node, Vertex, VertexKind};
}

pub mod window {
    pub use stickslip_tracer::{Point, Window};
}

#[path = "../../src"]
pub mod source {
    pub mod cubic;
    pub mod lengths;
}
pub use source::{cubic, lengths};

#[path = "../../src/regions"]
pub mod regions {
    mod abscissae;
    mod verify {
        mod limit;
    }
}

#[path = "../../src/tracing"]
pub mod tracing {
    mod builder;
    pub mod end;
    pub mod network {
        pub use stickslip_tracer::tracing::{Network, TraceStatistics, Unresolved};
    }
}
