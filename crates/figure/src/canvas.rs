//! The parts of which pictures are made.
//!
//! There is no plotting library. plotters, the usual one, places everything at whole pixels and an
//! image only at its own size, so that curves in SVG are ragged and a map cannot be one small
//! image; younger libraries bring tens of thousands of lines. What two axes need is short, and SVG
//! is text. A picture places [`panel::Panel`]s, draws into them, and ends as an [`svg::Svg`]. PNG
//! is the same SVG, drawn by resvg.
//!
//! Start reading in [`panel`] (axes, and what is drawn against them) and [`mod@svg`] (shapes and
//! words). Then `ticks` (round values on axes), `legend` (keys and their meanings), `placement`
//! (places of labels in regions), [`markup`] (texts), [`shape`] and [`style`]
//! (sizes and colours), and [`raster`] (images in a picture, and a picture as PNG).

mod legend;
pub mod markup;
pub mod panel;
mod placement;
#[cfg(feature = "png")]
pub mod raster;
pub mod shape;
pub mod style;
pub mod svg;
mod ticks;

pub(crate) use legend::Legend;
pub(crate) use placement::{Cells, place};
pub(crate) use raster::Bitmap;
pub(crate) use ticks::rises;
