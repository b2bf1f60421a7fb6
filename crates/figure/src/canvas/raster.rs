//! Pictures as PNG.

use std::sync::Arc;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::fontdb::Database;
use resvg::usvg::{Options, Tree};

use super::svg::Svg;
use crate::error::FigureError;

/// The number of pixels of the PNG for one pixel of the SVG, in each direction.
const SCALE: f32 = 2.0;

/// The font DejaVu Sans, so that no font needs to be installed; see `assets/README.md`.
const FONT_FILE: &[u8] = include_bytes!("../../assets/DejaVuSans-subset.ttf");

/// The picture as a PNG file, with two pixels for each pixel of the SVG.
///
/// # Errors
/// [`FigureError::Size`]: the picture has no size. [`FigureError::Memory`]: it is too large for
/// memory.
pub fn png(svg: &Svg) -> Result<Vec<u8>, FigureError> {
    let (width, height) = (svg.width(), svg.height());
    if ![width, height].iter().all(|side| side.is_finite() && *side > 0.0) {
        return Err(FigureError::Size { width, height });
    }
    let mut fonts = Database::new();
    fonts.load_font_data(FONT_FILE.to_vec());
    let options = Options { fontdb: Arc::new(fonts), ..Options::default() };
    let tree = Tree::from_str(&svg.document(), &options)?;
    let size = tree.size().to_int_size().scale_by(SCALE);
    let size = size.ok_or(FigureError::Memory)?;
    // Pixmap::new aborts where this fails.
    let pixels = (size.width() as usize).saturating_mul(size.height() as usize);
    Vec::<u8>::new()
        .try_reserve_exact(pixels.saturating_mul(4))
        .map_err(|_| FigureError::Memory)?;
    let mut pixels = Pixmap::new(size.width(), size.height()).ok_or(FigureError::Memory)?;
    resvg::render(&tree, Transform::from_scale(SCALE, SCALE), &mut pixels.as_mut());
    Ok(pixels.encode_png()?)
}
