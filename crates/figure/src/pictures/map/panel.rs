//! A panel of a map: one quantity on a plane, with axes, lines and points over it.

use colorous::Color;

use crate::canvas::Bitmap;
use crate::canvas::panel::{Edge, Panel};
use crate::canvas::rises;
use crate::canvas::shape::{Rectangle, Stroke};
use crate::canvas::style::{FRAME, HALO, SMALL, TEXT};
use crate::canvas::svg::{Anchor, Svg, Words};
use crate::error::FigureError;

/// A quantity on a plane.
#[derive(Clone, Debug)]
pub struct MapPanel<'a> {
    /// The name of the quantity.
    pub heading: &'a str,
    /// The axis along a row.
    pub horizontal: MapAxis<'a>,
    /// The axis along a column.
    pub vertical: MapAxis<'a>,
    /// Number of cells in a row.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// The quantity in each cell, row by row, the first row at the lower end of the axis.
    pub values: MapValues<'a>,
    /// Lines over the colours.
    pub lines: Vec<(Stroke, Vec<(f64, f64)>)>,
    /// Points over the colours with their names, in ascending order on a vertical line. The names
    /// stand to the right of the panel.
    pub points: Vec<(&'a str, (f64, f64))>,
}

/// Values that are shown in colours.
#[derive(Clone, Copy, Debug)]
pub enum MapValues<'a> {
    /// Tangential restitution; NaN in cells without a collision.
    Restitution(&'a [f64]),
    /// Number of switches, which also labels each region with room for a label; negative in cells
    /// without a collision.
    Switches(&'a [i32]),
}

/// An axis of a map.
#[derive(Clone, Copy, Debug)]
pub struct MapAxis<'a> {
    /// The name of the axis, with the unit if there is one.
    pub name: &'a str,
    /// The lower end of the first cell and the upper end of the last one.
    pub range: (f64, f64),
}

/// What the names of points need beside a panel.
const NAMES: f64 = 22.0;
/// Distance of names of points.
const APART: f64 = 12.5;
/// Radius of the mark of a point.
const MARK: f64 = 2.2;
/// Distance and width of the colour keys.
const KEY: (f64, f64) = (12.0, 16.0);
/// Least number of pixels of the image of a panel, across and along.
const FINE: usize = 600;

impl MapPanel<'_> {
    /// Refuses a map without cells, with another number of values, or with an axis that shows
    /// nothing.
    pub(super) fn validate(&self) -> Result<(), FigureError> {
        let ranges = [self.horizontal.range, self.vertical.range];
        if let Some((low, high)) = ranges.into_iter().find(|&range| !rises(range)) {
            return Err(FigureError::Range { low, high });
        }
        let Self { columns, rows, .. } = *self;
        let values = match self.values {
            MapValues::Restitution(values) => values.len(),
            MapValues::Switches(values) => values.len(),
        };
        if values > 0 && columns.checked_mul(rows) == Some(values) {
            return Ok(());
        }
        Err(FigureError::Cells { columns, rows, values })
    }

    /// The cells as pixels, the last row on top.
    ///
    /// If there are few cells, each has several pixels, since not every viewer keeps the edges of
    /// pixels sharp.
    pub(super) fn bitmap(&self, pixel: impl Fn(usize) -> u8, palette: Vec<Color>) -> Bitmap {
        let repeat = |cells: usize| FINE.div_ceil(cells);
        let (wide, high) = (repeat(self.columns), repeat(self.rows));
        let (columns, rows) = (self.columns * wide, self.rows * high);
        let lines = (0..rows).rev().map(|row| (row / high) * self.columns);
        let cells = lines.flat_map(|line| (0..columns).map(move |column| line + column / wide));
        Bitmap { columns, rows, pixels: cells.map(pixel).collect(), palette }
    }

    /// Draws the frame, the axes and the heading.
    pub(super) fn axes(&self, svg: &mut Svg, panel: &Panel, heading: &str) {
        panel.border(svg);
        for edge in [Edge::Bottom, Edge::Left] {
            panel.ticks(svg, edge, true);
        }
        panel.name(svg, Edge::Bottom, 36.0, self.horizontal.name);
        panel.name(svg, Edge::Left, 56.0, self.vertical.name);
        let at = (panel.frame.left, panel.frame.top - 14.0);
        svg.words(at, Words::new(heading, TEXT, Anchor::Start));
    }

    /// Draws lines and points over the colours.
    pub(super) fn over(&self, svg: &mut Svg, panel: &Panel) {
        if !self.lines.is_empty() {
            svg.begin_inside(panel.frame);
            // Dark lines on dark colours need an edge.
            for (_, points) in &self.lines {
                panel.curve(svg, points.iter().copied(), HALO);
            }
            for (stroke, points) in &self.lines {
                panel.curve(svg, points.iter().copied(), *stroke);
            }
            svg.end_inside();
        }
        if self.points.is_empty() {
            return;
        }
        let right = panel.frame.right();
        let mut lowest = panel.frame.bottom() + 0.5 * APART;
        svg.begin_group("points");
        for (name, point) in &self.points {
            let at = panel.place(*point);
            lowest = at.1.min(lowest - APART);
            for stroke in [HALO, Stroke { width: 0.7, ..FRAME }] {
                svg.polyline([at, (right - 8.0, lowest), (right + 5.0, lowest)], stroke);
            }
            svg.words((right + 8.0, lowest), Words::new(name, SMALL, Anchor::Start));
        }
        for (_, point) in &self.points {
            svg.ring(panel.place(*point), MARK, FRAME);
        }
        svg.end_group();
    }

    /// `values`, but −1 in the columns of the points and their names, so that labels keep clear of
    /// them.
    pub(super) fn free_of_points(&self, panel: &Panel, values: &[i32]) -> Vec<i32> {
        let leftmost = self.points.iter().map(|(_, point)| panel.place(*point).0 - 2.0 * MARK);
        let leftmost = leftmost.fold(f64::INFINITY, f64::min) - panel.frame.left;
        let free = |column: usize| {
            (column + 1) as f64 * panel.frame.width <= leftmost * self.columns as f64
        };
        let value =
            |(cell, value): (usize, &i32)| if free(cell % self.columns) { *value } else { -1 };
        values.iter().enumerate().map(value).collect()
    }

    /// The width that the names of points take between the panel and its key.
    pub(super) fn names(&self) -> f64 {
        if self.points.is_empty() { 0.0 } else { NAMES }
    }

    /// The place of the colour key.
    pub(super) fn beside(&self, panel: &Panel) -> Rectangle {
        let (distance, width) = KEY;
        Rectangle { left: panel.frame.right() + distance + self.names(), width, ..panel.frame }
    }
}
