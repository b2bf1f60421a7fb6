//! The picture of a map: tangential restitution to the left, number of switches to the right.

use std::collections::BTreeSet;
use std::io;

use super::bitmap::Bitmap;
use super::label::{self, Cells};
use super::panel::{Edge, LINEAR, Panel};
use super::style::{self, SMALL, TEXT, TITLE};
use super::svg::{Anchor, Rectangle, Svg, Words};

/// What is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Map<'a> {
    /// What holds for all of it.
    pub title: &'a str,
    /// The axis along a row.
    pub horizontal: Axis<'a>,
    /// The axis along a column.
    pub vertical: Axis<'a>,
    /// Cells in a row.
    pub columns: usize,
    /// Rows.
    pub rows: usize,
    /// Tangential restitution row by row, the first at the lower end of the axis; NaN where there is none.
    pub eps_t: &'a [f64],
    /// Number of switches; negative where there is none.
    pub switch_count: &'a [i32],
}

/// One axis of a map.
#[derive(Clone, Copy, Debug)]
pub struct Axis<'a> {
    /// Its name, with its unit if it has one.
    pub name: &'a str,
    /// Where the first cell begins and the last one ends.
    pub range: (f64, f64),
}

const WIDTH: f64 = 1024.0;
const HEIGHT: f64 = 456.0;
const RESTITUTION: Rectangle = Rectangle { left: 72.0, top: 64.0, width: 370.0, height: 340.0 };
const SWITCHES: Rectangle = Rectangle { left: 592.0, ..RESTITUTION };
/// Distance and width of the colour keys.
const KEY: (f64, f64) = (12.0, 16.0);
/// Least pixels of the image of a panel, across and along.
const FINE: usize = 600;
const TITLE_AT: (f64, f64) = (72.0, 20.0);

/// Shades of restitution; the middle one is zero.
const SHADES: u8 = 255;
/// The shade after them stands for what has no value.
const NO_SHADE: u8 = SHADES;
/// Most numbers that stand beside the key of the switches.
const MOST_NUMBERS: usize = 16;

/// Draws `map`.
///
/// # Errors
/// The map has no cells.
pub fn draw(map: &Map<'_>) -> io::Result<Svg> {
    let mut svg = Svg::new(WIDTH, HEIGHT, map.title);
    svg.words(TITLE_AT, Words::new(map.title, TITLE, Anchor::Start));
    restitution(&mut svg, map)?;
    switches(&mut svg, map)?;
    Ok(svg)
}

fn restitution(svg: &mut Svg, map: &Map<'_>) -> io::Result<()> {
    let panel = map.panel(RESTITUTION);
    let finite = map.eps_t.iter().filter(|value| value.is_finite());
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
    svg.image(panel.frame, &map.bitmap(|cell| shade(map.eps_t[cell]), palette).base64()?);

    let scale =
        Panel { frame: beside(&panel), x: (0.0, 1.0), y: (-largest, largest), scales: LINEAR };
    svg.image(scale.frame, &key.base64()?);
    scale.border(svg);
    scale.ticks(svg, Edge::Right, true);
    map.axes(svg, &panel, &format!("tangential restitution ε_t{}", scale.power(Edge::Right)));
    Ok(())
}

fn switches(svg: &mut Svg, map: &Map<'_>) -> io::Result<()> {
    let panel = map.panel(SWITCHES);
    let counts: BTreeSet<i32> =
        map.switch_count.iter().copied().filter(|&count| count >= 0).collect();
    let counts: Vec<i32> = counts.into_iter().collect();
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
    let pixel = |cell: usize| shade(map.switch_count[cell]).unwrap_or(missing);
    svg.image(panel.frame, &map.bitmap(pixel, palette.clone()).base64()?);

    svg.begin_group("regions");
    let cells = Cells { columns: map.columns, values: map.switch_count };
    let cell_width = panel.frame.width / map.columns as f64;
    let cell_height = panel.frame.height / map.rows as f64;
    let half_size = |count: i32| {
        // Figures are 0.64 of the font size wide and 0.73 high.
        let digits = count.to_string().len() as f64;
        ((0.32 * SMALL * digits + 2.0) / cell_width, (0.365 * SMALL + 2.0) / cell_height)
    };
    for label in label::place(cells, half_size).into_iter().filter(|label| label.value >= 0) {
        let x = panel.frame.left + (label.column as f64 + 0.5) * cell_width;
        let y = panel.frame.bottom() - (label.row as f64 + 0.5) * cell_height;
        let text = label.value.to_string();
        let words = Words::new(&text, SMALL, Anchor::Middle);
        svg.words((x, y), Words { colour: style::readable_on(colour(label.value)), ..words });
    }
    svg.end_group();
    map.axes(svg, &panel, "number of switches");

    let key = Panel {
        frame: beside(&panel),
        x: (0.0, 1.0),
        y: (0.0, counts.len().max(1) as f64),
        scales: LINEAR,
    };
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

impl Map<'_> {
    fn panel(&self, frame: Rectangle) -> Panel {
        Panel { frame, x: self.horizontal.range, y: self.vertical.range, scales: LINEAR }
    }

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
}

/// The place of a colour key beside a panel.
fn beside(panel: &Panel) -> Rectangle {
    let (distance, width) = KEY;
    Rectangle { left: panel.frame.right() + distance, width, ..panel.frame }
}
