//! Pictures as PNG and GIF.

use std::sync::Arc;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use colorous::Color;
use png::{BitDepth, ColorType, Compression, Encoder, Filter};
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::fontdb::Database;
use resvg::usvg::{Options, Tree};

use super::svg::Svg;
use crate::error::FigureError;

/// The number of pixels of the PNG for one pixel of the SVG, in each direction.
const SCALE: f32 = 2.0;

/// The font DejaVu Sans, so that no font needs to be installed; see `assets/README.md`.
const FONT_FILE: &[u8] = include_bytes!("../../assets/DejaVuSans-subset.ttf");

/// Hundredths of a second for each picture of an animation, and for the last one.
const PAUSES: [u16; 2] = [6, 200];

/// The picture as a PNG file, with two pixels for each pixel of the SVG.
///
/// # Errors
/// [`FigureError::Size`]: the picture has no size. [`FigureError::Memory`]: it is too large for
/// memory.
pub fn png(svg: &Svg) -> Result<Vec<u8>, FigureError> {
    Ok(pixels(svg, SCALE)?.encode_png()?)
}

/// Pictures of one size as a GIF file, which shows them one after another, again and again, with
/// one pixel for each pixel of the SVG.
///
/// # Errors
/// As [`png()`], also without a picture or if GIF does not allow the size. [`FigureError::Gif`]: a
/// picture is larger than the first one.
pub fn gif(pictures: impl IntoIterator<Item = Svg>) -> Result<Vec<u8>, FigureError> {
    /// How hard 256 colours are looked for, from 1, the best, to 30.
    const SPEED: i32 = 10;
    let mut pictures = pictures.into_iter().map(|picture| pixels(&picture, 1.0));
    let Some(first) = pictures.next().transpose()? else {
        return Err(FigureError::Size { width: 0.0, height: 0.0 });
    };
    let side = |pixels: u32| u16::try_from(pixels).map_err(|_| FigureError::Memory);
    let (width, height) = (side(first.width())?, side(first.height())?);
    let mut file = Vec::new();
    let mut encoder = gif::Encoder::new(&mut file, width, height, &[])?;
    encoder.set_repeat(gif::Repeat::Infinite)?;
    let mut next = Some(first);
    while let Some(pixels) = next {
        next = pictures.next().transpose()?;
        let (width, height) = (side(pixels.width())?, side(pixels.height())?);
        let mut pixels = pixels.take_demultiplied();
        let mut frame = gif::Frame::from_rgba_speed(width, height, &mut pixels, SPEED);
        frame.delay = PAUSES[usize::from(next.is_none())];
        encoder.write_frame(&frame)?;
    }
    drop(encoder);
    Ok(file)
}

/// The pixels of the picture, `scale` for each pixel of the SVG in each direction.
fn pixels(svg: &Svg, scale: f32) -> Result<Pixmap, FigureError> {
    let (width, height) = (svg.width(), svg.height());
    if ![width, height].iter().all(|side| side.is_finite() && *side > 0.0) {
        return Err(FigureError::Size { width, height });
    }
    let mut fonts = Database::new();
    fonts.load_font_data(FONT_FILE.to_vec());
    let options = Options { fontdb: Arc::new(fonts), ..Options::default() };
    let tree = Tree::from_str(&svg.document(), &options)?;
    let size = tree.size().to_int_size().scale_by(scale);
    let size = size.ok_or(FigureError::Memory)?;
    // Pixmap::new aborts where this fails.
    let pixels = (size.width() as usize).saturating_mul(size.height() as usize);
    Vec::<u8>::new()
        .try_reserve_exact(pixels.saturating_mul(4))
        .map_err(|_| FigureError::Memory)?;
    let mut pixels = Pixmap::new(size.width(), size.height()).ok_or(FigureError::Memory)?;
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixels.as_mut());
    Ok(pixels)
}

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
