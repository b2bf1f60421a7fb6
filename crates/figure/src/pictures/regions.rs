//! What pictures of atlases have in common: marks of vertices, labels of regions, and hints.

use stickslip_tracer::{
    Point, VertexKind,
    regions::{CurveSide, OutlinePart, Subdivision},
};

use crate::canvas::panel::Panel;
use crate::canvas::shape::{Rectangle, Stroke};
use crate::canvas::style::{self, FRAME, INK, SMALL};
use crate::canvas::svg::{Anchor, Svg, Words};
use crate::canvas::{Cells, Legend, place};

/// Half the side of a vertex's mark.
const MARK: f64 = 2.5;
/// The line from a label to its region.
const LEADER: Stroke = Stroke::full(INK, 0.6);
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

/// Writes a text into each region that has room for it, and beside each other region, with a line
/// that leads there.
///
/// `region` is the index of the region at a point of the panel, if it has one, and `samples` are
/// points inside all regions.
pub fn labels(
    svg: &mut Svg,
    panel: &Panel,
    region: impl Fn((f64, f64)) -> Option<usize>,
    samples: &[(f64, f64)],
    text: impl Fn(usize) -> String,
) {
    let raster = Raster::new(panel, region);
    let text = |value: i32| usize::try_from(value).ok().map(&text).unwrap_or_default();
    let cells = Cells { columns: usize::from(COLUMNS), values: &raster.values };
    let half_size = |value: i32| {
        let (width, height) = half_size(&text(value));
        (width / raster.cell.0, height / raster.cell.1)
    };
    let (mut taken, mut labelled) = (Vec::new(), vec![false; samples.len()]);
    svg.begin_group("regions");
    for label in place(cells, half_size).into_iter().filter(|label| label.value >= 0) {
        let at = raster.middle(label.column as f64, label.row as f64);
        let text = text(label.value);
        svg.words(at, Words::new(&text, SMALL, Anchor::Middle));
        taken.push(around(at, self::half_size(&text)));
        if let Some(labelled) =
            usize::try_from(label.value).ok().and_then(|it| labelled.get_mut(it))
        {
            *labelled = true;
        }
    }
    for (index, sample) in samples.iter().enumerate().filter(|(index, _)| !labelled[*index]) {
        let from = panel.place(*sample);
        let text = text(i32::try_from(index).unwrap_or(-1));
        let half = self::half_size(&text);
        let Some(at) = raster.beside(from, half, &taken) else { continue };
        // The line ends at the edge of the text.
        let (across, along) = (from.0 - at.0, from.1 - at.1);
        let part = (half.0 / across.abs()).min(half.1 / along.abs());
        svg.line(from, (at.0 + part * across, at.1 + part * along), LEADER);
        svg.disc(from, 1.2, INK);
        svg.words(at, Words::new(&text, SMALL, Anchor::Middle));
        taken.push(around(at, half));
    }
    svg.end_group();
}

/// Adds a hint to each region, which browsers show under the pointer. `polyline` are the points of
/// a curve, and `value` is the point of the panel at a point of the plane.
pub fn hints<Label, Margin>(
    svg: &mut Svg,
    panel: &Panel,
    plane: &Subdivision<Label, Margin>,
    polylines: &[Vec<(f64, f64)>],
    value: impl Fn(&Point) -> (f64, f64),
    text: impl Fn(usize) -> String,
) {
    svg.begin_group("hints");
    for region in 0..plane.regions().len() {
        let rings = plane.outlines(region).into_iter().map(|ring| {
            let mut points: Vec<(f64, f64)> = Vec::new();
            for stretch in ring {
                match stretch {
                    OutlinePart::Curve(curve, CurveSide::Left) => points.extend(&polylines[curve]),
                    OutlinePart::Curve(curve, CurveSide::Right) => {
                        points.extend(polylines[curve].iter().rev());
                    }
                    OutlinePart::Window(ends) => points.extend(ends.iter().map(&value)),
                }
            }
            thinned(points.into_iter().map(|point| panel.place(point)))
        });
        svg.hint(&rings.collect::<Vec<_>>(), &text(region));
    }
    svg.end_group();
}

/// The points of a line without those that are closer than a pixel to the one before.
fn thinned(points: impl Iterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let mut kept: Vec<(f64, f64)> = Vec::new();
    for point in points {
        let near = |last: &(f64, f64)| (last.0 - point.0).hypot(last.1 - point.1) < 1.0;
        if !kept.last().is_some_and(near) {
            kept.push(point);
        }
    }
    kept
}

/// Half the width and half the height of a label, with room around it, in pixels.
fn half_size(text: &str) -> (f64, f64) {
    // Figures are 0.64 of the font size wide and 0.73 high.
    (0.32 * SMALL * text.chars().count() as f64 + 2.0, 0.365 * SMALL + 2.0)
}

/// The rectangle around a place.
fn around((x, y): (f64, f64), (across, along): (f64, f64)) -> Rectangle {
    Rectangle { left: x - across, top: y - along, width: 2.0 * across, height: 2.0 * along }
}

/// The regions at the cells of a panel.
struct Raster {
    frame: Rectangle,
    /// The width and the height of a cell.
    cell: (f64, f64),
    /// The region of each cell, row by row from the top; −1 where there is none.
    values: Vec<i32>,
}

impl Raster {
    fn new(panel: &Panel, region: impl Fn((f64, f64)) -> Option<usize>) -> Self {
        let frame = panel.frame;
        let cell = (frame.width / f64::from(COLUMNS), frame.height / f64::from(ROWS));
        let mut raster = Self { frame, cell, values: Vec::new() };
        let cells = (0..ROWS).flat_map(|row| (0..COLUMNS).map(move |column| (column, row)));
        let at = |(column, row): (u16, u16)| {
            let middle = raster.middle(f64::from(column), f64::from(row));
            let region = region(panel.value(middle));
            region.and_then(|region| i32::try_from(region).ok()).unwrap_or(-1)
        };
        raster.values = cells.map(at).collect();
        raster
    }

    /// The middle of a cell.
    fn middle(&self, column: f64, row: f64) -> (f64, f64) {
        (self.frame.left + (column + 0.5) * self.cell.0, self.frame.top + (row + 0.5) * self.cell.1)
    }

    /// The nearest place beside `from` for a label, inside one region and clear of what is `taken`.
    fn beside(
        &self,
        from: (f64, f64),
        half: (f64, f64),
        taken: &[Rectangle],
    ) -> Option<(f64, f64)> {
        /// Distances from the point in pixels, and directions.
        const DISTANCES: std::ops::Range<u32> = 18..90;
        const DIRECTIONS: u32 = 24;
        DISTANCES.step_by(4).find_map(|distance| {
            (0..DIRECTIONS).find_map(|direction| {
                let angle = std::f64::consts::TAU * f64::from(direction) / f64::from(DIRECTIONS);
                let (y, x) = angle.sin_cos();
                let far = f64::from(distance);
                let at = (from.0 + far * x, from.1 + far * y);
                let own = around(at, half);
                let free = taken.iter().all(|other| !overlap(&own, other));
                // No line leads over another label.
                let passes = || {
                    (1..=8).all(|step| {
                        let part = f64::from(step) / 8.0;
                        let on = (from.0 + part * far * x, from.1 + part * far * y);
                        taken.iter().all(|other| !overlap(&around(on, (1.0, 1.0)), other))
                    })
                };
                (free && passes() && self.is_uniform(&own)).then_some(at)
            })
        })
    }

    /// Whether a rectangle lies within one region.
    fn is_uniform(&self, at: &Rectangle) -> bool {
        let frame = &self.frame;
        if at.left < frame.left
            || at.right() > frame.right()
            || at.top < frame.top
            || at.bottom() > frame.bottom()
        {
            return false;
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let index = |length: f64, cell: f64, most: u16| {
            ((length / cell) as usize).min(usize::from(most) - 1)
        };
        let columns = index(at.left - frame.left, self.cell.0, COLUMNS)
            ..=index(at.right() - frame.left - 1e-9, self.cell.0, COLUMNS);
        let mut rows = index(at.top - frame.top, self.cell.1, ROWS)
            ..=index(at.bottom() - frame.top - 1e-9, self.cell.1, ROWS);
        let value = |row: usize, column: usize| self.values[row * usize::from(COLUMNS) + column];
        let first = value(*rows.start(), *columns.start());
        first >= 0 && rows.all(|row| columns.clone().all(|column| value(row, column) == first))
    }
}

fn overlap(one: &Rectangle, two: &Rectangle) -> bool {
    one.left < two.right()
        && two.left < one.right()
        && one.top < two.bottom()
        && two.top < one.bottom()
}
