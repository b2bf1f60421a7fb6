//! Errors of pictures.

/// The reason why a picture cannot be made.
#[derive(Debug, thiserror::Error)]
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
    /// An image has more pixels than PNG allows.
    #[error("an image of {pixels} pixels in a row or column; expected up to 4294967295")]
    TooLarge {
        /// Number of pixels in a row or a column.
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
