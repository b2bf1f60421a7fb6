//! The parts of which pictures are made.
//!
//! Start reading in [`panel`] (axes, and what is drawn against them) and [`mod@svg`] (shapes and
//! words). Then `ticks` (round values on axes), `legend` (keys and their meanings), `placement`
//! (places of labels in regions), [`markup`] and [`mod@number`] (texts), [`shape`] and [`style`]
//! (sizes and colours), `bitmap` (images in a picture) and [`raster`] (a picture as PNG).

mod bitmap;
mod legend;
pub mod markup;
pub mod number;
pub mod panel;
mod placement;
#[cfg(feature = "png")]
pub mod raster;
pub mod shape;
pub mod style;
pub mod svg;
mod ticks;

pub(crate) use bitmap::Bitmap;
pub(crate) use legend::Legend;
pub(crate) use placement::{Cells, place};
pub(crate) use ticks::rises;
