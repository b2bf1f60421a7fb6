//! Legends: keys with their meanings beside each other.

use super::markup;
use super::shape::Rectangle;
use super::style::TEXT;
use super::svg::{Anchor, Svg, Words};

/// The mean width of a character, in font sizes.
const CHARACTER: f64 = 0.53;
/// From a key to its text, and from the text to the next key.
const GAPS: (f64, f64) = (6.0, 24.0);
/// Height of a key.
const HEIGHT: f64 = 12.0;

/// A row of entries, which grows to the right.
#[derive(Debug)]
pub struct Legend {
    left: f64,
    y: f64,
}

impl Legend {
    /// An empty row; its first key begins at `left`, and its middle line is at `y`.
    pub fn new((left, y): (f64, f64)) -> Self {
        Self { left, y }
    }

    /// Adds an entry: `key` draws into a rectangle of this width, and `text` stands to its right.
    pub fn entry(
        &mut self,
        svg: &mut Svg,
        width: f64,
        text: &str,
        key: impl FnOnce(&mut Svg, Rectangle),
    ) {
        let at = Rectangle { left: self.left, top: self.y - 0.5 * HEIGHT, width, height: HEIGHT };
        key(svg, at);
        svg.words((at.right() + GAPS.0, self.y), Words::new(text, TEXT, Anchor::Start));
        let characters = markup::plain(text).chars().count() as f64;
        self.left = at.right() + GAPS.0 + CHARACTER * TEXT * characters + GAPS.1;
    }
}
