//! Colours, line styles and sizes of all pictures.
//!
//! Colours of lines are those of M. Okabe and K. Ito, *Color universal design* (2008). Readers with
//! any common colour blindness can tell them apart. The shades of phases also differ in lightness,
//! so that they survive grey print. The pictures of the Python package and the notebooks have the
//! same colours and line styles: `stickslip.style` reads them from here.

use colorous::Color;
use stickslip_plane::atlas::BoundaryKind;
use stickslip_solver::margin::{Margin, Place};

use super::shape::Stroke;

/// Blue.
pub const BLUE: &str = "#0072B2";
/// Vermilion, a red.
pub const VERMILION: &str = "#D55E00";
/// Bluish green.
pub const GREEN: &str = "#009E73";
/// Reddish purple.
pub const PURPLE: &str = "#CC79A7";
/// Orange.
pub const ORANGE: &str = "#E69F00";
/// Sky blue.
pub const SKY: &str = "#56B4E9";
/// Colour of text, frames and ticks.
pub const INK: &str = "#222222";
/// The ground of all pictures.
pub const GROUND: &str = "#FFFFFF";
/// The colours of series with their names, in the order in which they are used.
pub const COLOURS: [(&str, &str); 7] = [
    ("BLUE", BLUE),
    ("VERMILION", VERMILION),
    ("GREEN", GREEN),
    ("PURPLE", PURPLE),
    ("ORANGE", ORANGE),
    ("SKY", SKY),
    ("INK", INK),
];

/// Fonts of all texts. PNG pictures use the first one; an SVG viewer without it takes a font with
/// about the same widths.
pub const FONT: &str = "DejaVu Sans, Verdana, sans-serif";

/// Font size of axis names and legends.
pub const TEXT: f64 = 12.0;
/// Font size of tick labels and labels of regions.
pub const SMALL: f64 = 11.0;
/// Font size of the title.
pub const TITLE: f64 = 14.0;

/// Lines that divide.
pub const RULE: Stroke = Stroke::full("#888888", 0.8);
/// Frames and ticks.
pub const FRAME: Stroke = Stroke::full(INK, 1.0);

/// The edge that lines have over colours.
pub const HALO: Stroke = Stroke::full(GROUND, 2.6);

/// Quantities of the normal motion.
pub const NORMAL: Stroke = Stroke::full(INK, 1.2);
/// Quantities of the normal motion, with the opposite sign.
pub const NORMAL_MIRRORED: Stroke = Stroke { dashes: "6 4", ..NORMAL };
/// Quantities of the tangential motion.
pub const TANGENTIAL: Stroke = Stroke::full(BLUE, 2.0);

/// Boundaries on which a switch falls on the end of contact, or an event on the end of a run.
pub const BOUNDARY_END: Stroke = Stroke::full(INK, 1.6);
/// Boundaries on which the force touches its limit while sticking; grazes of any guard.
pub const BOUNDARY_STICK: Stroke = Stroke { colour: BLUE, width: 1.6, dashes: "7 3" };
/// Boundaries on which the spring all but sticks while sliding; changes of the order of events.
pub const BOUNDARY_SLIP: Stroke = Stroke { colour: VERMILION, width: 1.6, dashes: "2 2.5" };
/// Boundaries on which the force exceeds its limit where the limit is zero: at the start of
/// contact, or where the normal force begins to attract. Starts and branches of any system.
pub const BOUNDARY_START: Stroke = Stroke { colour: GREEN, width: 1.6, dashes: "10 3 2 3" };

/// The kinds of boundaries of collisions in the order of legends, with their names in files and in
/// words.
pub const KINDS: [(BoundaryKind, &str, &str); 5] = [
    (BoundaryKind::EndOfContact, "end-of-contact", "switch at the end of contact"),
    (BoundaryKind::StickGraze, "stick-graze", "graze while sticking"),
    (BoundaryKind::SlipGraze, "slip-graze", "graze while sliding"),
    (BoundaryKind::StartOfContact, "start-of-contact", "slip from the start"),
    (BoundaryKind::StartOfTail, "start-of-tail", "slip from where the force attracts"),
];

/// The stroke of the boundaries of a kind.
pub fn boundary(kind: BoundaryKind) -> Stroke {
    match kind {
        BoundaryKind::EndOfContact => BOUNDARY_END,
        BoundaryKind::StickGraze => BOUNDARY_STICK,
        BoundaryKind::SlipGraze => BOUNDARY_SLIP,
        BoundaryKind::StartOfContact | BoundaryKind::StartOfTail => BOUNDARY_START,
    }
}

/// The kinds of boundaries of hybrid systems in the order of legends: the places at which a margin
/// vanishes, as files name them, the kind in words, and its stroke.
pub const PLACES: [(&[&str], &str, Stroke); 4] = [
    (&["end"], "event at the end", BOUNDARY_END),
    (&["minimum", "maximum"], "graze", BOUNDARY_STICK),
    (&["exit"], "order of events", BOUNDARY_SLIP),
    (&["start", "branch", "condition"], "start or branch", BOUNDARY_START),
];

/// The kind of a boundary on which `margin` vanishes, as an index of [`PLACES`].
pub fn place(margin: &Margin) -> usize {
    match margin.place {
        Place::End => 0,
        Place::Minimum { .. } | Place::Maximum { .. } => 1,
        Place::Exit(_) => 2,
        Place::Start { .. } | Place::Branch(_) | Place::Condition => 3,
    }
}

/// A closed form of a boundary, drawn beneath the traced one.
pub const CLOSED_FORM: Stroke = Stroke::full("#F3C77B", 7.0);

/// Colour of slip phases on side +1.
pub const SLIP_POSITIVE: &str = "#F8D8A8";
/// Colour of slip phases on side −1.
pub const SLIP_NEGATIVE: &str = "#DDF0FA";
/// Colour of stick phases.
pub const STICK: &str = GROUND;
/// The shades of the modes of a run, which differ in lightness too. Further modes begin again.
pub const MODES: [&str; 6] = [STICK, SLIP_POSITIVE, SLIP_NEGATIVE, "#D9C3DC", "#CDE5C8", "#F3C7BE"];

/// The methods Dormand–Prince 5(4) and 8(5,3). The dashes of one let the line of the other show
/// where both coincide.
pub const METHODS: [Stroke; 2] =
    [Stroke::full(BLUE, 1.4), Stroke { colour: VERMILION, width: 1.4, dashes: "6 4" }];
/// The best minimum of a fit, and those next to it.
pub const MINIMA: [Stroke; 3] = [
    Stroke::full(VERMILION, 2.0),
    Stroke { dashes: "7 4", ..Stroke::full(BLUE, 1.4) },
    Stroke { dashes: "2 3", ..Stroke::full(GREEN, 1.4) },
];

/// Colour of cells without a value.
pub const MISSING: Color = Color { r: 0xB0, g: 0xB0, b: 0xB0 };

/// A colour from blue through white to red, for `t` from −1 to 1.
pub fn diverging(t: f64) -> Color {
    colorous::RED_BLUE.eval_continuous(0.5 - 0.5 * t)
}

/// Colour `i` of `n` ordered colours, from light to dark.
pub fn ordered(i: usize, n: usize) -> Color {
    let t = if n > 1 { i as f64 / (n - 1) as f64 } else { 0.0 };
    colorous::YELLOW_GREEN_BLUE.eval_continuous(0.06 + 0.94 * t)
}

/// `colour` as SVG writes it.
pub fn hex(colour: Color) -> String {
    format!("#{colour:X}")
}

/// Black or white, whichever is readable on `colour`.
pub fn readable_on(Color { r, g, b }: Color) -> &'static str {
    // Luma of ITU-R BT.601.
    let lightness = 0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b);
    if lightness > 140.0 { INK } else { GROUND }
}
