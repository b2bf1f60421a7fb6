//! What pictures are made of.

mod bitmap;
mod label;
pub mod markup;
pub mod number;
pub mod panel;
pub mod raster;
pub mod shape;
pub mod style;
pub mod svg;

pub(crate) use bitmap::Bitmap;
pub(crate) use label::{Cells, place};
