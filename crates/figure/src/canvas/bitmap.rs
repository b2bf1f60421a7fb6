//! Images of few colours as PNG: small, and with no colour that is not in the palette.

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use colorous::Color;
use png::{BitDepth, ColorType, Compression, Encoder, Filter};

use crate::error::FigureError;

/// Colours by number, row by row from the top.
#[derive(Debug)]
pub struct Bitmap {
    /// Pixels in a row.
    pub columns: usize,
    /// Rows.
    pub rows: usize,
    /// The number of each pixel's colour.
    pub pixels: Vec<u8>,
    /// The colours.
    pub palette: Vec<Color>,
}

impl Bitmap {
    /// The image as a PNG file in base 64.
    ///
    /// # Errors
    /// The image is empty, or larger than the format allows.
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
        // Differences of colour numbers mean nothing to a filter.
        encoder.set_filter(Filter::NoFilter);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.pixels)?;
        writer.finish()?;
        Ok(BASE64_STANDARD.encode(file))
    }
}
