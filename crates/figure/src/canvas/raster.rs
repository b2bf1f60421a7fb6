//! Pictures as PNG and GIF.

use std::collections::HashMap;
use std::mem;
use std::sync::Arc;

use color_quant::NeuQuant;
use gif::{Encoder, EncodingError, Frame, Repeat};
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
/// one pixel for each pixel of the SVG. The colours of all of them are those of the last one.
///
/// # Errors
/// As [`png()`], also without a picture or if GIF does not allow the size. [`FigureError::Gif`]: a
/// picture has another size than the last one.
pub fn gif(pictures: impl IntoIterator<Item = Svg>) -> Result<Vec<u8>, FigureError> {
    /// How hard 255 colours are looked for, from 1, the best, to 30.
    const SPEED: i32 = 10;
    /// The colour of a pixel that stays as it is in the picture before.
    const UNCHANGED: u8 = 255;
    let pictures: Vec<_> = pictures.into_iter().collect();
    let Some((last, others)) = pictures.split_last() else {
        return Err(FigureError::Size { width: 0.0, height: 0.0 });
    };
    let last = pixels(last, 1.0)?;
    let side = |pixels: u32| u16::try_from(pixels).map_err(|_| FigureError::Memory);
    let (width, height) = (side(last.width())?, side(last.height())?);
    let palette = NeuQuant::new(SPEED, usize::from(UNCHANGED), last.data());
    let mut file = Vec::new();
    let mut encoder = Encoder::new(&mut file, width, height, &palette.color_map_rgb())?;
    encoder.set_repeat(Repeat::Infinite)?;
    let mut indices = HashMap::new();
    let mut shown = vec![[0; 4]; last.pixels().len()];
    let drawn = others.iter().map(|picture| pixels(picture, 1.0)).map(|drawn| (drawn, PAUSES[0]));
    for (pixels, delay) in drawn.chain([(Ok(last), PAUSES[1])]) {
        let pixels = pixels?;
        if [pixels.width(), pixels.height()] != [width, height].map(u32::from) {
            return Err(EncodingError::FrameBufferTooSmallForDimensions.into());
        }
        let (colours, _) = pixels.data().as_chunks::<4>();
        let changes = colours.iter().zip(&mut shown).map(|(colour, shown)| {
            if mem::replace(shown, *colour) == *colour {
                return UNCHANGED;
            }
            // One of 255.
            let index = || palette.index_of(colour).try_into().unwrap_or_default();
            *indices.entry(*colour).or_insert_with(index)
        });
        let buffer = changes.collect();
        let transparent = Some(UNCHANGED);
        encoder.write_frame(&Frame {
            width,
            height,
            delay,
            transparent,
            buffer,
            ..Frame::default()
        })?;
    }
    drop(encoder);
    Ok(file)
}

/// The pixels of the picture, `scale` for each pixel of the SVG in each direction.
fn pixels(svg: &Svg, scale: f32) -> Result<Pixmap, FigureError> {
    let tree = tree(svg)?;
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

/// The picture as shapes, with its texts as outlines.
pub(super) fn tree(svg: &Svg) -> Result<Tree, FigureError> {
    let (width, height) = (svg.width(), svg.height());
    if ![width, height].iter().all(|side| side.is_finite() && *side > 0.0) {
        return Err(FigureError::Size { width, height });
    }
    let mut fonts = Database::new();
    fonts.load_font_data(FONT_FILE.to_vec());
    let options = Options { fontdb: Arc::new(fonts), ..Options::default() };
    Ok(Tree::from_str(&svg.document(), &options)?)
}
