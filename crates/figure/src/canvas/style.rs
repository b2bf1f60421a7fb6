//! Colours and sizes of all pictures.
//!
//! Colours of lines are those of M. Okabe and K. Ito, *Color universal design* (2008). Readers with
//! any common colour blindness can tell them apart. The shades of phases also differ in lightness,
//! so that they survive grey print.

use colorous::Color;

use super::shape::Stroke;

/// Fonts of all texts. PNG pictures use the first one; an SVG viewer without it takes a font with
/// about the same widths.
pub const FONT: &str = "DejaVu Sans, Verdana, sans-serif";

/// Font size of axis names and legends.
pub const TEXT: f64 = 12.0;
/// Font size of tick labels and labels of regions.
pub const SMALL: f64 = 11.0;
/// Font size of the title.
pub const TITLE: f64 = 14.0;

/// Colour of text, frames and ticks.
pub const INK: &str = "#222222";
/// Lines that divide.
pub const RULE: Stroke = Stroke::full("#888888", 0.8);
/// Frames and ticks.
pub const FRAME: Stroke = Stroke::full(INK, 1.0);

/// The edge that lines have over colours.
pub const HALO: Stroke = Stroke::full("#FFFFFF", 2.6);

/// Quantities of the normal motion.
pub const NORMAL: Stroke = Stroke::full("#222222", 1.2);
/// Quantities of the normal motion, with the opposite sign.
pub const NORMAL_MIRRORED: Stroke = Stroke { dashes: "6 4", ..NORMAL };
/// Quantities of the tangential motion.
pub const TANGENTIAL: Stroke = Stroke::full("#0072B2", 2.0);

/// Boundaries on which a switch falls on the end of contact.
pub const BOUNDARY_END: Stroke = Stroke::full("#222222", 1.6);
/// Boundaries on which the force touches its limit while sticking.
pub const BOUNDARY_STICK: Stroke = Stroke { colour: "#0072B2", width: 1.6, dashes: "7 3" };
/// Boundaries on which the spring all but sticks while sliding.
pub const BOUNDARY_SLIP: Stroke = Stroke { colour: "#D55E00", width: 1.6, dashes: "2 2.5" };

/// Boundaries on which the force exceeds its limit where the limit is zero: at the start of
/// contact, or where the normal force begins to attract.
pub const BOUNDARY_START: Stroke = Stroke { colour: "#009E73", width: 1.6, dashes: "10 3 2 3" };

/// A closed form of a boundary, drawn beneath the traced one.
pub const CLOSED_FORM: Stroke = Stroke::full("#F3C77B", 7.0);

/// Colour of slip phases on side +1.
pub const SLIP_POSITIVE: &str = "#F8D8A8";
/// Colour of slip phases on side −1.
pub const SLIP_NEGATIVE: &str = "#DDF0FA";
/// Colour of stick phases.
pub const STICK: &str = "#FFFFFF";

/// Colour of cells without a value.
pub const MISSING: Color = Color { r: 0xB0, g: 0xB0, b: 0xB0 };

/// A colour from blue through white to red, for `t` from −1 to 1.
#[must_use]
pub fn diverging(t: f64) -> Color {
    colorous::RED_BLUE.eval_continuous(0.5 - 0.5 * t)
}

/// Colour `i` of `n` ordered colours, from light to dark.
#[must_use]
pub fn ordered(i: usize, n: usize) -> Color {
    let t = if n > 1 { i as f64 / (n - 1) as f64 } else { 0.0 };
    colorous::YELLOW_GREEN_BLUE.eval_continuous(0.06 + 0.94 * t)
}

/// `colour` as SVG writes it.
#[must_use]
pub fn hex(colour: Color) -> String {
    format!("#{colour:X}")
}

/// Black or white, whichever is readable on `colour`.
#[must_use]
pub fn readable_on(Color { r, g, b }: Color) -> &'static str {
    // Luma of ITU-R BT.601.
    let lightness = 0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b);
    if lightness > 140.0 { INK } else { "#FFFFFF" }
}
