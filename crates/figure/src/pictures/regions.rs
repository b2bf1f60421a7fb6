//! What pictures of atlases have in common: the marks of vertices, and labels in regions.

use stickslip_tracer::VertexKind;

use crate::canvas::panel::Panel;
use crate::canvas::shape::Rectangle;
use crate::canvas::style::{self, FRAME, INK, SMALL};
use crate::canvas::svg::{Anchor, Svg, Words};
use crate::canvas::{Cells, Legend, place};

/// Half the side of a vertex's mark.
const MARK: f64 = 2.5;
/// Columns and rows of cells in which labels are placed; a cell has one to two pixels.
const COLUMNS: u16 = 540;
const ROWS: u16 = 356;

/// Draws the vertices inside the window, of which places in the picture are given, and adds their
/// marks to the legend.
pub fn vertices(svg: &mut Svg, places: &[(VertexKind, (f64, f64))], legend: &mut Legend) {
    let others = [VertexKind::Degenerate, VertexKind::GrazeAtEnd, VertexKind::VanishingPhase];
    for (class, text, kinds, colour) in [
        ("crossings", "crossing", &[VertexKind::Crossing][..], INK),
        ("other-vertices", "other vertex", &others, style::GROUND),
    ] {
        let square = |svg: &mut Svg, (x, y): (f64, f64)| {
            let (left, top, side) = (x - MARK, y - MARK, 2.0 * MARK);
            let at = Rectangle { left, top, width: side, height: side };
            svg.fill(at, colour);
            svg.outline(at, FRAME);
        };
        let mut places = places.iter().filter(|(kind, _)| kinds.contains(kind)).peekable();
        if places.peek().is_some() {
            legend.entry(svg, 2.0 * MARK, text, |svg, key| {
                square(svg, (key.left + MARK, key.top + 0.5 * key.height));
            });
        }
        svg.begin_group(class);
        for (_, place) in places {
            square(svg, *place);
        }
        svg.end_group();
    }
}

/// Writes a text into each region that has room for it. `region` is the index of the region at a
/// point of the panel, if it has one.
pub fn labels(
    svg: &mut Svg,
    panel: &Panel,
    region: impl Fn((f64, f64)) -> Option<usize>,
    text: impl Fn(usize) -> String,
) {
    let frame = &panel.frame;
    let cell = (frame.width / f64::from(COLUMNS), frame.height / f64::from(ROWS));
    let middle = |column: f64, row: f64| {
        (frame.left + (column + 0.5) * cell.0, frame.top + (row + 0.5) * cell.1)
    };
    let at = |(column, row): (u16, u16)| {
        let region = region(panel.value(middle(f64::from(column), f64::from(row))));
        region.and_then(|region| i32::try_from(region).ok()).unwrap_or(-1)
    };
    let cells = (0..ROWS).flat_map(|row| (0..COLUMNS).map(move |column| (column, row)));
    let values: Vec<i32> = cells.map(at).collect();
    let text = |value: i32| usize::try_from(value).ok().map(&text).unwrap_or_default();
    // Figures are 0.64 of the font size wide and 0.73 high.
    let half_size = |value: i32| {
        let digits = text(value).chars().count() as f64;
        ((0.32 * SMALL * digits + 2.0) / cell.0, (0.365 * SMALL + 2.0) / cell.1)
    };
    let cells = Cells { columns: usize::from(COLUMNS), values: &values };
    svg.begin_group("regions");
    for label in place(cells, half_size).into_iter().filter(|label| label.value >= 0) {
        let at = middle(label.column as f64, label.row as f64);
        svg.words(at, Words::new(&text(label.value), SMALL, Anchor::Middle));
    }
    svg.end_group();
}
