//! Private modules of the crate, compiled here with the tests that stand in them, so that the crate
//! is not compiled once more for these.

#![allow(dead_code, reason = "the tests need a part of each module")]

#[path = "../../src/canvas"]
pub mod canvas {
    pub use stickslip_figure::canvas::{shape, style};

    mod markup;
    mod number;
    mod placement;
    mod ticks;
}

#[path = "../../src/pictures/map"]
mod map {
    mod colour_scale;
    mod steps;
}
