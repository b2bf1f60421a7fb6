//! Pictures as PDF.

use std::io::{Cursor, Write};

use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref};
use png::{Decoder, Transformations};
use resvg::tiny_skia::{self, PathSegment, Transform};
use resvg::usvg::{
    Fill, FillRule, Group, Image, ImageKind, LineCap, LineJoin, Node, Paint, Path, Stroke,
};

use super::raster::tree;
use super::svg::Svg;
use crate::error::FigureError;

/// Points of print, of which 72 are an inch, for a pixel of the SVG.
const POINTS: f32 = 0.75;

/// The picture as a PDF file of one page, with lines as lines and letters as outlines, so that no
/// font is needed. A pixel of the SVG is three quarters of a point.
///
/// # Errors
/// [`FigureError::Size`]: the picture has no size.
pub fn pdf(svg: &Svg) -> Result<Vec<u8>, FigureError> {
    let tree = tree(svg)?;
    let (width, height) = (tree.size().width() * POINTS, tree.size().height() * POINTS);
    let mut page = Page { content: Content::new(), images: Vec::new() };
    // PDF counts upwards.
    page.content.transform([POINTS, 0.0, 0.0, -POINTS, 0.0, height]);
    page.group(tree.root());
    let Page { content, images } = page;

    let [catalog, pages, only, contents] = [1, 2, 3, 4].map(Ref::new);
    let image = |index: usize| Ref::new(5 + i32::try_from(index).unwrap_or(i32::MAX - 5));
    let mut pdf = Pdf::new();
    pdf.catalog(catalog).pages(pages);
    pdf.pages(pages).kids([only]).count(1);
    let mut written = pdf.page(only);
    written.parent(pages).contents(contents).media_box(Rect::new(0.0, 0.0, width, height));
    let mut resources = written.resources();
    let mut named = resources.x_objects();
    for index in 0..images.len() {
        named.pair(Name(name(index).as_bytes()), image(index));
    }
    named.finish();
    resources.finish();
    written.finish();
    pdf.stream(contents, &packed(&content.finish())).filter(Filter::FlateDecode);
    for (index, pixels) in images.iter().enumerate() {
        let data = packed(&pixels.data);
        let mut written = pdf.image_xobject(image(index), &data);
        written.filter(Filter::FlateDecode);
        written.width(pixels.width).height(pixels.height);
        written.color_space().device_rgb();
        written.bits_per_component(8);
    }
    Ok(pdf.finish())
}

/// What is drawn on a page.
struct Page {
    content: Content,
    images: Vec<Pixels>,
}

/// An image of red, green and blue.
struct Pixels {
    width: i32,
    height: i32,
    data: Vec<u8>,
}

fn name(image: usize) -> String {
    format!("Image{image}")
}

fn packed(data: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    // Writing to memory does not fail.
    let written = encoder.write_all(data).and_then(|()| encoder.finish());
    written.unwrap_or_default()
}

impl Page {
    /// Draws a group. Those of an [`Svg`] are opaque and have no masks and filters.
    fn group(&mut self, group: &Group) {
        if let Some(clip) = group.clip_path() {
            self.content.save_state();
            let place = group.abs_transform().pre_concat(clip.transform());
            for node in clip.root().children() {
                if let Node::Path(path) = node
                    && let place = place.pre_concat(path.abs_transform())
                    && let Some(outline) = path.data().clone().transform(place)
                {
                    self.outline(&outline);
                }
            }
            self.content.clip_nonzero().end_path();
        }
        for node in group.children() {
            match node {
                Node::Group(group) => self.group(group),
                Node::Text(text) => self.group(text.flattened()),
                Node::Path(path) => self.path(path),
                Node::Image(image) => self.image(image),
            }
        }
        if group.clip_path().is_some() {
            self.content.restore_state();
        }
    }

    fn path(&mut self, path: &Path) {
        self.content.save_state().transform(array(path.abs_transform()));
        if let Some(stroke) = path.stroke() {
            self.prepare(stroke);
        }
        if let Some(Paint::Color(colour)) = path.fill().map(Fill::paint) {
            self.content.set_fill_rgb(share(colour.red), share(colour.green), share(colour.blue));
        }
        self.outline(path.data());
        match (path.fill().map(Fill::rule), path.stroke()) {
            (Some(FillRule::NonZero), Some(_)) => self.content.fill_nonzero_and_stroke(),
            (Some(FillRule::EvenOdd), Some(_)) => self.content.fill_even_odd_and_stroke(),
            (Some(FillRule::NonZero), None) => self.content.fill_nonzero(),
            (Some(FillRule::EvenOdd), None) => self.content.fill_even_odd(),
            (None, Some(_)) => self.content.stroke(),
            (None, None) => self.content.end_path(),
        };
        self.content.restore_state();
    }

    /// Goes along an outline.
    fn outline(&mut self, outline: &tiny_skia::Path) {
        // PDF has curves of the third degree only.
        let mut last = (0.0, 0.0);
        for segment in outline.segments() {
            match segment {
                PathSegment::MoveTo(to) => self.content.move_to(to.x, to.y),
                PathSegment::LineTo(to) => self.content.line_to(to.x, to.y),
                PathSegment::QuadTo(by, to) => {
                    let towards = |from: f32, by: f32| from + (by - from) * 2.0 / 3.0;
                    self.content.cubic_to(
                        towards(last.0, by.x),
                        towards(last.1, by.y),
                        towards(to.x, by.x),
                        towards(to.y, by.y),
                        to.x,
                        to.y,
                    )
                }
                PathSegment::CubicTo(a, b, to) => {
                    self.content.cubic_to(a.x, a.y, b.x, b.y, to.x, to.y)
                }
                PathSegment::Close => self.content.close_path(),
            };
            if let PathSegment::MoveTo(to)
            | PathSegment::LineTo(to)
            | PathSegment::QuadTo(_, to)
            | PathSegment::CubicTo(_, _, to) = segment
            {
                last = (to.x, to.y);
            }
        }
    }

    fn prepare(&mut self, stroke: &Stroke) {
        if let Paint::Color(colour) = stroke.paint() {
            self.content.set_stroke_rgb(share(colour.red), share(colour.green), share(colour.blue));
        }
        self.content.set_line_width(stroke.width().get());
        self.content.set_line_cap(match stroke.linecap() {
            LineCap::Butt => LineCapStyle::ButtCap,
            LineCap::Round => LineCapStyle::RoundCap,
            LineCap::Square => LineCapStyle::ProjectingSquareCap,
        });
        self.content.set_line_join(match stroke.linejoin() {
            LineJoin::Miter | LineJoin::MiterClip => LineJoinStyle::MiterJoin,
            LineJoin::Round => LineJoinStyle::RoundJoin,
            LineJoin::Bevel => LineJoinStyle::BevelJoin,
        });
        if let Some(dashes) = stroke.dasharray() {
            self.content.set_dash_pattern(dashes.iter().copied(), stroke.dashoffset());
        }
    }

    fn image(&mut self, image: &Image) {
        let Some(pixels) = pixels_of(image) else { return };
        let (width, height) = (image.size().width(), image.size().height());
        // An image is a square from 0 to 1, whose first row is at the top.
        let square = Transform::from_row(width, 0.0, 0.0, -height, 0.0, height);
        let place = square.post_concat(image.abs_transform());
        let name = name(self.images.len());
        self.content.save_state().transform(array(place));
        self.content.x_object(Name(name.as_bytes())).restore_state();
        self.images.push(pixels);
    }
}

/// The pixels of an image. Those of an [`Svg`] are PNGs of its own.
fn pixels_of(image: &Image) -> Option<Pixels> {
    let ImageKind::PNG(file) = image.kind() else { return None };
    let mut decoder = Decoder::new(Cursor::new(&file[..]));
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info().ok()?;
    let mut data = vec![0; reader.output_buffer_size()?];
    let info = reader.next_frame(&mut data).ok()?;
    let (width, height) = (i32::try_from(info.width).ok()?, i32::try_from(info.height).ok()?);
    Some(Pixels { width, height, data })
}

fn array(transform: Transform) -> [f32; 6] {
    let Transform { sx, kx, ky, sy, tx, ty } = transform;
    [sx, ky, kx, sy, tx, ty]
}

fn share(colour: u8) -> f32 {
    f32::from(colour) / 255.0
}
