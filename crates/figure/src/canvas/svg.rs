//! Pictures as SVG: shapes, images and words.
//!
//! A picture has a white ground of its own, and every shape and text names its colour. It looks the
//! same on a dark page.

use std::fmt::{self, Display};

use super::markup;
use super::shape::{Px, Rectangle, Stroke};
use super::style::{FONT, INK};

/// A picture to which shapes and words are added. Later ones lie on top. Lengths are in pixels, and
/// y points down. What has a place or a size that is not finite is not added.
#[derive(Debug)]
pub struct Svg {
    width: f64,
    height: f64,
    title: String,
    body: String,
    parts: Vec<Rectangle>,
}

/// The point of a text that is at its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// The start of the text.
    Start,
    /// The middle of the text.
    Middle,
    /// The end of the text.
    End,
}

/// A text on one line.
#[derive(Clone, Copy, Debug)]
pub struct Words<'a> {
    /// The text, as [markup].
    pub text: &'a str,
    /// Font size in pixels.
    pub size: f64,
    /// The point of the text that is at its position.
    pub anchor: Anchor,
    /// Colour of the text.
    pub colour: &'a str,
    /// Whether the text runs upwards.
    pub upwards: bool,
}

impl<'a> Words<'a> {
    /// A text of the usual colour and direction.
    pub fn new(text: &'a str, size: f64, anchor: Anchor) -> Self {
        Self { text, size, anchor, colour: INK, upwards: false }
    }
}

impl Svg {
    /// An empty picture. Browsers and assistive programs show its title.
    pub fn new(width: f64, height: f64, title: &str) -> Self {
        let title = markup::escaped(&markup::plain(title));
        Self { width, height, title, body: String::new(), parts: Vec::new() }
    }

    /// The width of the picture.
    pub fn width(&self) -> f64 {
        self.width
    }

    /// The height of the picture.
    pub fn height(&self) -> f64 {
        self.height
    }

    /// The parts that a narrow page shows below each other, each as `viewBox` has it; none if the
    /// picture is shown as a whole.
    pub fn parts(&self) -> Vec<String> {
        let view = |part: &Rectangle| {
            let [x, y, width, height] = [part.left, part.top, part.width, part.height].map(Px);
            format!("{x} {y} {width} {height}")
        };
        self.parts.iter().map(view).collect()
    }

    /// Adds a part that a narrow page shows below those before.
    pub fn part(&mut self, at: Rectangle) {
        self.parts.push(at);
    }

    /// The picture as an SVG document.
    pub fn document(&self) -> String {
        let Self { width, height, title, body, .. } = self;
        // Some viewers drop blanks at the ends of lowered and raised words without this attribute.
        format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" font-family="{FONT}" xml:space="preserve">
<title>{title}</title>
<rect width="{width}" height="{height}" fill="white"/>
{body}</svg>
"#
        )
    }

    /// Begins a group of a class, which lasts until [`Self::end_group`].
    pub fn begin_group(&mut self, class: &str) {
        self.element(format_args!(r#"<g class="{class}">"#));
    }

    /// Ends the last group that was begun.
    pub fn end_group(&mut self) {
        self.element(format_args!("</g>"));
    }

    /// Shows only the part inside a rectangle of what is added until [`Self::end_inside`].
    pub fn begin_inside(&mut self, at: Rectangle) {
        if !at.is_finite() {
            self.element(format_args!(r#"<svg width="0" height="0">"#));
            return;
        }
        let [x, y, width, height] = [at.left, at.top, at.width, at.height].map(Px);
        // Unlike a clip path it needs no name, which would have to be unique on a page of pictures.
        self.element(format_args!(
            r#"<svg {} viewBox="{x} {y} {width} {height}" overflow="hidden">"#,
            Sides(at)
        ));
    }

    /// Ends what [`Self::begin_inside`] began.
    pub fn end_inside(&mut self) {
        self.element(format_args!("</svg>"));
    }

    /// Adds a filled rectangle.
    pub fn fill(&mut self, at: Rectangle, colour: &str) {
        if !at.is_finite() {
            return;
        }
        self.element(format_args!(r#"<rect {} fill="{colour}"/>"#, Sides(at)));
    }

    /// Adds the edge of a rectangle.
    pub fn outline(&mut self, at: Rectangle, stroke: Stroke) {
        if !at.is_finite() {
            return;
        }
        self.element(format_args!(r#"<rect {} fill="none" {stroke}/>"#, Sides(at)));
    }

    /// Adds a filled circle.
    pub fn disc(&mut self, centre: (f64, f64), radius: f64, colour: &str) {
        if !(is_finite(centre) && radius.is_finite()) {
            return;
        }
        let [x, y, r] = [centre.0, centre.1, radius].map(Px);
        self.element(format_args!(r#"<circle cx="{x}" cy="{y}" r="{r}" fill="{colour}"/>"#));
    }

    /// Adds a circle filled with white.
    pub fn ring(&mut self, centre: (f64, f64), radius: f64, stroke: Stroke) {
        if !(is_finite(centre) && radius.is_finite()) {
            return;
        }
        let [x, y, r] = [centre.0, centre.1, radius].map(Px);
        self.element(format_args!(r#"<circle cx="{x}" cy="{y}" r="{r}" fill="white" {stroke}/>"#));
    }

    /// Adds a straight line.
    pub fn line(&mut self, (x1, y1): (f64, f64), (x2, y2): (f64, f64), stroke: Stroke) {
        if !(is_finite((x1, y1)) && is_finite((x2, y2))) {
            return;
        }
        let [x1, y1, x2, y2] = [x1, y1, x2, y2].map(Px);
        self.element(format_args!(r#"<line x1="{x1}" y1="{y1}" x2="{x2}" y2="{y2}" {stroke}/>"#));
    }

    /// Adds a line through points. Points too close to be told apart are left out; a point that is
    /// not finite interrupts the line.
    pub fn polyline(&mut self, points: impl IntoIterator<Item = (f64, f64)>, stroke: Stroke) {
        let mut run = Vec::new();
        for point in points {
            if is_finite(point) {
                run.push(point);
            } else {
                self.unbroken(&run, stroke);
                run.clear();
            }
        }
        self.unbroken(&run, stroke);
    }

    /// Adds a line through points, all of which are finite.
    fn unbroken(&mut self, points: &[(f64, f64)], stroke: Stroke) {
        /// No eye and no usual magnification tells points apart that are closer.
        const APART: f64 = 0.1;
        if points.is_empty() {
            return;
        }
        let mut list = String::new();
        let mut write =
            |(x, y): (f64, f64)| markup::append(&mut list, format_args!("{},{} ", Px(x), Px(y)));
        let (mut written, mut skipped) = (None::<(f64, f64)>, None);
        for &point in points {
            let near =
                |(x, y): (f64, f64)| (x - point.0).abs() < APART && (y - point.1).abs() < APART;
            if written.is_some_and(near) {
                skipped = Some(point);
            } else {
                // The last point before a jump belongs to the line.
                skipped.take().into_iter().chain([point]).for_each(&mut write);
                written = Some(point);
            }
        }
        skipped.into_iter().for_each(write);
        let list = list.trim_end();
        self.element(format_args!(
            r#"<polyline points="{list}" fill="none" stroke-linejoin="round" {stroke}/>"#
        ));
    }

    /// Adds a filled polygon.
    pub fn area(&mut self, corners: impl IntoIterator<Item = (f64, f64)>, colour: &str) {
        let corners = corners.into_iter().filter(|&corner| is_finite(corner));
        let corners: Vec<String> = corners.map(|(x, y)| format!("{},{}", Px(x), Px(y))).collect();
        let list = corners.join(" ");
        self.element(format_args!(r#"<polygon points="{list}" fill="{colour}"/>"#));
    }

    /// Adds an area that is not visible, inside closed lines; lines in others are holes. Browsers
    /// show its title where the pointer is over it.
    pub fn hint(&mut self, lines: &[Vec<(f64, f64)>], title: &str) {
        let mut path = String::new();
        for line in lines {
            for (index, (x, y)) in line.iter().filter(|point| is_finite(**point)).enumerate() {
                let to = if index == 0 { 'M' } else { 'L' };
                markup::append(&mut path, format_args!("{to}{},{}", Px(*x), Px(*y)));
            }
            path.push('Z');
        }
        let title = markup::escaped(title);
        self.element(format_args!(
            r#"<path d="{path}" fill="none" fill-rule="evenodd" pointer-events="all"><title>{title}</title></path>"#
        ));
    }

    /// Adds an image, each pixel of which becomes a sharp rectangle. `png` is its file in base 64.
    pub fn image(&mut self, at: Rectangle, png: &str) {
        if !at.is_finite() {
            return;
        }
        // The attribute is for viewers that do not know the newer word in the style.
        self.element(format_args!(
            r#"<image {} preserveAspectRatio="none" image-rendering="optimizeSpeed" style="image-rendering:pixelated" href="data:image/png;base64,{png}"/>"#,
            Sides(at)
        ));
    }

    /// Adds a text; its position is at the middle of its height.
    pub fn words(&mut self, (x, y): (f64, f64), words: Words<'_>) {
        let Words { text, size, anchor, colour, upwards } = words;
        if !(is_finite((x, y)) && size.is_finite()) {
            return;
        }
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        // Half the height of a figure.
        let lowered = 0.365 * size;
        let turn = if upwards {
            format!(r#" transform="rotate(-90 {} {})""#, Px(x), Px(y))
        } else {
            String::new()
        };
        let spans = markup::spans(text, size);
        self.element(format_args!(
            r#"<text x="{}" y="{}" font-size="{size}" text-anchor="{anchor}" fill="{colour}"{turn}>{spans}</text>"#,
            Px(x),
            Px(y + lowered),
        ));
    }

    fn element(&mut self, element: fmt::Arguments<'_>) {
        markup::append(&mut self.body, element);
        self.body.push('\n');
    }
}

fn is_finite((x, y): (f64, f64)) -> bool {
    x.is_finite() && y.is_finite()
}

/// The attributes of a rectangle.
struct Sides(Rectangle);

impl Display for Sides {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, width, height] = [self.0.left, self.0.top, self.0.width, self.0.height].map(Px);
        f.write_fmt(format_args!(r#"x="{x}" y="{y}" width="{width}" height="{height}""#))
    }
}
