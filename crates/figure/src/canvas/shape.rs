//! Rectangles, lengths and strokes.

use std::fmt::{self, Display};

/// An upright rectangle, in pixels; y points down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// x of the left edge.
    pub left: f64,
    /// y of the upper edge.
    pub top: f64,
    /// Distance from the left to the right edge.
    pub width: f64,
    /// Distance from the upper to the lower edge.
    pub height: f64,
}

impl Rectangle {
    /// Whether its place and its size are finite.
    pub(super) fn is_finite(&self) -> bool {
        [self.left, self.top, self.width, self.height].into_iter().all(f64::is_finite)
    }

    /// x of the right edge.
    pub fn right(&self) -> f64 {
        self.left + self.width
    }

    /// y of the lower edge.
    pub fn bottom(&self) -> f64 {
        self.top + self.height
    }
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Stroke {
    /// Colour of the line.
    pub colour: &'static str,
    /// Width of the line.
    pub width: f64,
    /// Lengths of dashes and gaps; empty for a full line.
    pub dashes: &'static str,
}

impl Stroke {
    /// A full line.
    pub const fn full(colour: &'static str, width: f64) -> Self {
        Self { colour, width, dashes: "" }
    }
}

impl Display for Stroke {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, r#"stroke="{}" stroke-width="{}""#, self.colour, self.width)?;
        if !self.dashes.is_empty() {
            write!(f, r#" stroke-dasharray="{}""#, self.dashes)?;
        }
        Ok(())
    }
}

/// A length in pixels, written to a hundredth.
#[derive(Clone, Copy, Debug)]
pub struct Px(pub f64);

impl Display for Px {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Adding 0 turns −0 into 0.
        write!(f, "{}", (self.0 * 100.0).round() / 100.0 + 0.0)
    }
}
