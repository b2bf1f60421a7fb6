//! Errors of pictures.

/// The reason why a picture cannot be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FigureError {
    /// A map has no cells, or not one value for each.
    #[error(
        "a map of {columns} × {rows} cells with {values} values; expected at least one cell, and one \
         value for each"
    )]
    Cells {
        /// Number of cells in a row.
        columns: usize,
        /// Number of rows.
        rows: usize,
        /// Number of values.
        values: usize,
    },
    /// An axis of a map shows nothing.
    #[error("an axis from {low:?} to {high:?}; expected two finite numbers, the second one larger")]
    Range {
        /// The lower end of the axis.
        low: f64,
        /// Its upper end.
        high: f64,
    },
    /// An image has more pixels than PNG allows.
    #[error("an image of {pixels} pixels in a row or column; expected up to 4294967295")]
    TooLarge {
        /// Number of pixels in a row or a column.
        pixels: usize,
    },
    /// An image cannot be written as PNG.
    #[error("the image cannot be written as PNG: {0}")]
    Png(#[from] png::EncodingError),
    /// Pictures cannot be written as GIF.
    #[cfg(feature = "png")]
    #[error("the pictures cannot be written as GIF: {0}")]
    Gif(#[from] gif::EncodingError),
    /// The SVG cannot be read.
    #[cfg(feature = "png")]
    #[error("the SVG cannot be read: {0}")]
    Svg(#[from] resvg::usvg::Error),
    /// A picture has no size.
    #[error("a picture of {width:?} by {height:?} pixels; expected two finite numbers above 0")]
    Size {
        /// The width of the picture.
        width: f64,
        /// The height of the picture.
        height: f64,
    },
    /// The picture does not fit into memory.
    #[error("the picture does not fit into memory")]
    Memory,
}
