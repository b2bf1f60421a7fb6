//! Pictures of maps: panels side by side, each with one quantity in colours.

use std::collections::BTreeSet;

use crate::canvas::Bitmap;
use crate::canvas::panel::{Edge, LINEAR, Panel};
use crate::canvas::shape::{Rectangle, Stroke};
use crate::canvas::style::{self, FRAME, HALO, SMALL, TEXT, TITLE};
use crate::canvas::svg::{Anchor, Svg, Words};
use crate::canvas::{Cells, place};
use crate::error::FigureError;

/// A quantity on a plane.
#[derive(Clone, Debug)]
pub struct MapPanel<'a> {
    /// What it is.
    pub heading: &'a str,
    /// The axis along a row.
    pub horizontal: MapAxis<'a>,
    /// The axis along a column.
    pub vertical: MapAxis<'a>,
    /// Cells in a row.
    pub columns: usize,
    /// Rows.
    pub rows: usize,
    /// The quantity row by row, the first at the lower end of the axis.
    pub values: Values<'a>,
    /// Lines over it.
    pub lines: Vec<(Stroke, Vec<(f64, f64)>)>,
    /// Points over it with their names, in ascending order on a vertical line; the names stand to
    /// the right of the panel.
    pub points: Vec<(&'a str, (f64, f64))>,
}

/// What is shown in colours.
#[derive(Clone, Copy, Debug)]
pub enum Values<'a> {
    /// Tangential restitution; NaN where there is none.
    Restitution(&'a [f64]),
    /// Number of switches, with labels in the regions that have room for one; negative where there
    /// is none.
    Switches(&'a [i32]),
}

/// One axis of a map.
#[derive(Clone, Copy, Debug)]
pub struct MapAxis<'a> {
    /// Its name, with its unit if it has one.
    pub name: &'a str,
    /// Where the first cell begins and the last one ends.
    pub range: (f64, f64),
}

/// From one panel to the next.
const STEP: f64 = 520.0;
const HEIGHT: f64 = 456.0;
const FIRST: Rectangle = Rectangle { left: 72.0, top: 64.0, width: 370.0, height: 340.0 };
/// Distance and width of the colour keys.
const KEY: (f64, f64) = (12.0, 16.0);
/// What the names of points need beside a panel.
const NAMES: f64 = 22.0;
/// Distance of names of points.
const APART: f64 = 12.5;
/// Radius of the mark of a point.
const MARK: f64 = 2.2;
/// Least pixels of the image of a panel, across and along.
const FINE: usize = 600;
const TITLE_AT: (f64, f64) = (72.0, 20.0);

/// Shades of restitution; the middle one is zero.
const SHADES: u8 = 255;
/// The shade after them stands for what has no value.
const NO_SHADE: u8 = SHADES;
/// Most numbers that stand beside the key of the switches.
const MOST_NUMBERS: usize = 16;

/// Draws `maps` from left to right; `title` holds for all of them.
///
/// # Errors
/// A map has no cells.
pub fn draw(title: &str, maps: &[MapPanel<'_>]) -> Result<Svg, FigureError> {
    let names = maps.iter().map(MapPanel::names).fold(0.0, f64::max);
    let step = STEP + names;
    let mut svg = Svg::new(step * maps.len() as f64 - 16.0, HEIGHT, title);
    svg.words(TITLE_AT, Words::new(title, TITLE, Anchor::Start));
    let counts = counts(maps);
    for (index, map) in maps.iter().enumerate() {
        let frame = Rectangle { left: FIRST.left + step * index as f64, ..FIRST };
        let panel = Panel { frame, x: map.horizontal.range, y: map.vertical.range, scales: LINEAR };
        match map.values {
            Values::Restitution(values) => restitution(&mut svg, map, &panel, values)?,
            Values::Switches(values) => switches(&mut svg, map, &panel, values, &counts)?,
        }
    }
    Ok(svg)
}

/// All numbers of switches that occur, so that each has one colour in all panels.
fn counts(maps: &[MapPanel<'_>]) -> Vec<i32> {
    let values = maps.iter().flat_map(|map| match map.values {
        Values::Switches(values) => values,
        Values::Restitution(_) => &[],
    });
    let counts: BTreeSet<i32> = values.copied().filter(|&count| count >= 0).collect();
    counts.into_iter().collect()
}

fn restitution(
    svg: &mut Svg,
    map: &MapPanel<'_>,
    panel: &Panel,
    values: &[f64],
) -> Result<(), FigureError> {
    let finite = values.iter().filter(|value| value.is_finite());
    let largest = finite.fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let largest = if largest > 0.0 { largest } else { 1.0 };
    let middle = f64::from(SHADES / 2);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let shade = |value: f64| {
        if value.is_finite() { (middle * (1.0 + value / largest)).round() as u8 } else { NO_SHADE }
    };
    let mut palette: Vec<_> =
        (0..SHADES).map(|i| style::diverging(f64::from(i) / middle - 1.0)).collect();
    let key = Bitmap {
        columns: 1,
        rows: usize::from(SHADES),
        pixels: (0..SHADES).rev().collect(),
        palette: palette.clone(),
    };
    palette.push(style::MISSING);
    svg.image(panel.frame, &map.bitmap(|cell| shade(values[cell]), palette).base64()?);

    let frame = map.beside(panel);
    let scale = Panel { frame, x: (0.0, 1.0), y: (-largest, largest), scales: LINEAR };
    svg.image(scale.frame, &key.base64()?);
    scale.border(svg);
    scale.ticks(svg, Edge::Right, true);
    map.over(svg, panel);
    map.axes(svg, panel, &format!("{}{}", map.heading, scale.power(Edge::Right)));
    Ok(())
}

fn switches(
    svg: &mut Svg,
    map: &MapPanel<'_>,
    panel: &Panel,
    values: &[i32],
    counts: &[i32],
) -> Result<(), FigureError> {
    // Beyond that many, neighbours share a colour.
    let colours = counts.len().min(usize::from(u8::MAX));
    let shade = |count: i32| {
        let rank = counts.binary_search(&count).ok()?;
        u8::try_from(rank * colours / counts.len()).ok()
    };
    let mut palette: Vec<_> = (0..colours).map(|i| style::ordered(i, colours)).collect();
    palette.push(style::MISSING);
    let missing = u8::try_from(colours).unwrap_or(u8::MAX);
    let colour = |count: i32| palette[usize::from(shade(count).unwrap_or(missing))];
    let pixel = |cell: usize| shade(values[cell]).unwrap_or(missing);
    svg.image(panel.frame, &map.bitmap(pixel, palette.clone()).base64()?);
    map.over(svg, panel);

    svg.begin_group("regions");
    let values = map.free_of_points(panel, values);
    let cells = Cells { columns: map.columns, values: &values };
    let cell_width = panel.frame.width / map.columns as f64;
    let cell_height = panel.frame.height / map.rows as f64;
    let half_size = |count: i32| {
        // Figures are 0.64 of the font size wide and 0.73 high.
        let digits = count.to_string().len() as f64;
        ((0.32 * SMALL * digits + 2.0) / cell_width, (0.365 * SMALL + 2.0) / cell_height)
    };
    for label in place(cells, half_size).into_iter().filter(|label| label.value >= 0) {
        let x = panel.frame.left + (label.column as f64 + 0.5) * cell_width;
        let y = panel.frame.bottom() - (label.row as f64 + 0.5) * cell_height;
        let text = label.value.to_string();
        let words = Words::new(&text, SMALL, Anchor::Middle);
        svg.words((x, y), Words { colour: style::readable_on(colour(label.value)), ..words });
    }
    svg.end_group();
    map.axes(svg, panel, map.heading);

    let frame = map.beside(panel);
    let key = Panel { frame, x: (0.0, 1.0), y: (0.0, counts.len().max(1) as f64), scales: LINEAR };
    // Each colour down to the bottom, under those that follow: no seams.
    for (rank, count) in counts.iter().enumerate().rev() {
        let (left, top) = key.place((0.0, rank as f64 + 1.0));
        let height = key.frame.bottom() - top;
        svg.fill(Rectangle { left, top, height, ..key.frame }, &style::hex(colour(*count)));
    }
    let apart = counts.len().div_ceil(MOST_NUMBERS).max(1);
    svg.begin_group("counts");
    for (rank, count) in counts.iter().enumerate().step_by(apart) {
        let (x, y) = key.place((1.0, rank as f64 + 0.5));
        svg.words((x + 8.0, y), Words::new(&count.to_string(), SMALL, Anchor::Start));
    }
    svg.end_group();
    key.border(svg);
    Ok(())
}

impl MapPanel<'_> {
    /// The cells as pixels, the last row on top.
    ///
    /// Few cells are several pixels each, since not every viewer keeps the edges of pixels sharp.
    fn bitmap(&self, pixel: impl Fn(usize) -> u8, palette: Vec<colorous::Color>) -> Bitmap {
        let repeat = |cells: usize| FINE.div_ceil(cells);
        let (wide, high) = (repeat(self.columns), repeat(self.rows));
        let (columns, rows) = (self.columns * wide, self.rows * high);
        let lines = (0..rows).rev().map(|row| (row / high) * self.columns);
        let cells = lines.flat_map(|line| (0..columns).map(move |column| line + column / wide));
        Bitmap { columns, rows, pixels: cells.map(pixel).collect(), palette }
    }

    fn axes(&self, svg: &mut Svg, panel: &Panel, heading: &str) {
        panel.border(svg);
        for edge in [Edge::Bottom, Edge::Left] {
            panel.ticks(svg, edge, true);
        }
        panel.name(svg, Edge::Bottom, 36.0, self.horizontal.name);
        panel.name(svg, Edge::Left, 56.0, self.vertical.name);
        let at = (panel.frame.left, panel.frame.top - 14.0);
        svg.words(at, Words::new(heading, TEXT, Anchor::Start));
    }

    /// Lines and points over the colours.
    fn over(&self, svg: &mut Svg, panel: &Panel) {
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

    /// `values` without those where points and their names are, so that labels keep clear of them.
    fn free_of_points(&self, panel: &Panel, values: &[i32]) -> Vec<i32> {
        let leftmost = self.points.iter().map(|(_, point)| panel.place(*point).0 - 2.0 * MARK);
        let leftmost = leftmost.fold(f64::INFINITY, f64::min) - panel.frame.left;
        let free = |column: usize| {
            (column + 1) as f64 * panel.frame.width <= leftmost * self.columns as f64
        };
        let value =
            |(cell, value): (usize, &i32)| if free(cell % self.columns) { *value } else { -1 };
        values.iter().enumerate().map(value).collect()
    }

    /// What the names of points take between a panel and its key.
    fn names(&self) -> f64 {
        if self.points.is_empty() { 0.0 } else { NAMES }
    }

    /// The place of a colour key beside a panel.
    fn beside(&self, panel: &Panel) -> Rectangle {
        let (distance, width) = KEY;
        Rectangle { left: panel.frame.right() + distance + self.names(), width, ..panel.frame }
    }
}
