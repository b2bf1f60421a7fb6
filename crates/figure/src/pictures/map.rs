//! Pictures of maps: panels side by side, each with one quantity in colours.
//!
//! Start reading in `panel` (cells, axes, lines and points), then `restitution` and `switches` (the
//! colours of each quantity and their keys).

mod panel;
mod restitution;
mod switches;

pub use panel::{MapAxis, MapPanel, MapValues};

use crate::canvas::panel::{LINEAR, Panel};
use crate::canvas::shape::Rectangle;
use crate::canvas::style::TITLE;
use crate::canvas::svg::{Anchor, Svg, Words};
use crate::error::FigureError;

/// From one panel to the next.
const STEP: f64 = 512.0;
const HEIGHT: f64 = 456.0;
const FIRST: Rectangle = Rectangle { left: 72.0, top: 64.0, width: 358.0, height: 340.0 };
const TITLE_AT: (f64, f64) = (72.0, 20.0);
/// The part of the height that the title has.
const TITLE_HEIGHT: f64 = 34.0;

/// Draws `maps` from left to right; `title` holds for all of them.
///
/// # Errors
/// [`FigureError`]: an axis of a map shows nothing, or a map has no cells, not one value for each,
/// or too many cells.
pub fn draw(title: &str, maps: &[MapPanel<'_>]) -> Result<Svg, FigureError> {
    maps.iter().try_for_each(MapPanel::validate)?;
    let names = maps.iter().map(MapPanel::names).fold(0.0, f64::max);
    let step = STEP + names;
    let mut svg = Svg::new(step * maps.len().max(1) as f64, HEIGHT, title);
    svg.words(TITLE_AT, Words::new(title, TITLE, Anchor::Start));
    let counts = switches::counts(maps);
    for (index, map) in maps.iter().enumerate() {
        let frame = Rectangle { left: FIRST.left + step * index as f64, ..FIRST };
        svg.part(Rectangle {
            left: step * index as f64,
            top: TITLE_HEIGHT,
            width: step,
            height: HEIGHT - TITLE_HEIGHT,
        });
        let panel = Panel { frame, x: map.horizontal.range, y: map.vertical.range, scales: LINEAR };
        match map.values {
            MapValues::Restitution(values) => restitution::draw(&mut svg, map, &panel, values)?,
            MapValues::Switches(values) => switches::draw(&mut svg, map, &panel, values, &counts)?,
        }
    }
    Ok(svg)
}
