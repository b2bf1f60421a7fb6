//! The parts of which pictures are made.
//!
//! There is no plotting library. plotters, the usual one, places everything at whole pixels and an
//! image only at its own size, so that curves in SVG are ragged and a map cannot be one small
//! image; younger libraries bring tens of thousands of lines. What two axes need is short, and SVG
//! is text. A picture places [`panel::Panel`]s, draws into them, and ends as an [`svg::Svg`]. PNG
//! and PDF are the same SVG, read by usvg and drawn by resvg or shape by shape.
//!
//! Start reading in [`panel`] (axes, and what is drawn against them) and [`mod@svg`] (shapes and
//! words). Then `ticks` (round values on axes), `legend` (keys and their meanings), `placement`
//! (places of labels in regions), [`markup`] (texts), [`shape`] and [`style`]
//! (sizes and colours), `bitmap` (images in a picture) [`raster`] (a picture as PNG) and
//! [`mod@pdf`] (as PDF).

mod bitmap;
mod legend;
pub mod markup;
pub mod panel;
#[cfg(feature = "png")]
pub mod pdf;
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
