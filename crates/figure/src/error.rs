//! What can go wrong with a picture.

/// Why a picture cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// An image has no pixels, or more than PNG allows.
    #[error("an image of {pixels} pixels in a row or column; expected 1 to 4294967295")]
    TooLarge {
        /// Pixels in a row or a column.
        pixels: usize,
    },
    /// An image cannot be written as PNG.
    #[error("the image cannot be written as PNG: {0}")]
    Png(#[from] png::EncodingError),
    /// The SVG cannot be read.
    #[error("the SVG cannot be read: {0}")]
    Svg(#[from] resvg::usvg::Error),
    /// The picture does not fit into memory.
    #[error("the picture does not fit into memory")]
    Memory,
}
