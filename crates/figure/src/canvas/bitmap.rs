//! Images of few colours as PNG, which are small and have no colour outside their palette.

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use colorous::Color;
use png::{BitDepth, ColorType, Compression, Encoder, Filter};

use crate::error::FigureError;

/// An image whose pixels are indices into a palette.
#[derive(Debug)]
pub struct Bitmap {
    /// Number of pixels in a row.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// The colour of each pixel as an index, row by row from the top.
    pub pixels: Vec<u8>,
    /// The colours, at most 256.
    pub palette: Vec<Color>,
}

impl Bitmap {
    /// The image as a PNG file in base 64.
    ///
    /// # Errors
    /// [`FigureError`]: the image is larger than the format allows.
    pub fn base64(&self) -> Result<String, FigureError> {
        let side =
            |pixels: usize| u32::try_from(pixels).map_err(|_| FigureError::TooLarge { pixels });
        let mut file = Vec::new();
        let mut encoder = Encoder::new(&mut file, side(self.columns)?, side(self.rows)?);
        encoder.set_color(ColorType::Indexed);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_palette(
            self.palette.iter().flat_map(|&Color { r, g, b }| [r, g, b]).collect::<Vec<_>>(),
        );
        encoder.set_compression(Compression::High);
        // Filters compare neighbours, and differences between indices mean nothing.
        encoder.set_filter(Filter::NoFilter);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.pixels)?;
        writer.finish()?;
        Ok(BASE64_STANDARD.encode(file))
    }
}
