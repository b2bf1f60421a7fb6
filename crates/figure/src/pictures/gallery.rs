//! The picture of many collisions: the forces of each in a small panel of its own.

use stickslip_model::Collision;
use stickslip_model::history::History;

use super::collision::{FORCE, TIME};
use super::course::{self, Course};
use crate::canvas::panel::Edge;
use crate::canvas::shape::Rectangle;
use crate::canvas::style::{SMALL, TEXT, TITLE};
use crate::canvas::svg::{Anchor, Svg, Words};

/// A collision with the texts above its panel.
#[derive(Clone, Debug)]
pub struct Exhibit {
    /// The text to the left.
    pub name: String,
    /// The text to the right.
    pub remark: String,
    /// The collision.
    pub collision: Collision,
    /// The course of the collision.
    pub history: History,
}

/// About the number of pixels from the start of contact to its end.
pub const PANEL_WIDTH: f64 = 224.0;

const COLUMNS: usize = 4;
const WIDTH: f64 = 1024.0;
const FIRST: Rectangle = Rectangle { left: 72.0, top: 92.0, width: PANEL_WIDTH, height: 128.0 };
/// From one panel to the next, across and along.
const STEP: (f64, f64) = (239.0, 160.0);
const TITLE_AT: (f64, f64) = (72.0, 22.0);
const LEGEND_AT: (f64, f64) = (72.0, 50.0);
/// The legend as a part of its own, on pages that show half of the columns.
const LEGEND: Rectangle = Rectangle { left: 60.0, top: 38.0, width: 640.0, height: 26.0 };

/// Draws `exhibits` row by row; all panels have the same axes.
pub fn draw(title: &str, exhibits: &[Exhibit]) -> Svg {
    let rows = exhibits.len().div_ceil(COLUMNS).max(1) as f64;
    let mut svg = Svg::new(WIDTH, FIRST.top + STEP.1 * rows + 16.0, title);
    svg.words(TITLE_AT, Words::new(title, TITLE, Anchor::Start));
    let courses: Vec<Course<'_>> = exhibits
        .iter()
        .map(|exhibit| Course::new(&exhibit.collision, &exhibit.history, FIRST.width))
        .collect();
    course::legend(&mut svg, LEGEND_AT, &courses);
    let largest = courses.iter().map(Course::largest_force).fold(0.0, f64::max);
    for (index, (exhibit, course)) in exhibits.iter().zip(&courses).enumerate() {
        let (column, row) = (index % COLUMNS, index / COLUMNS);
        let left = FIRST.left + STEP.0 * column as f64;
        let top = FIRST.top + STEP.1 * row as f64;
        let panel = course.forces(&mut svg, Rectangle { left, top, ..FIRST }, largest);
        panel.ticks(&mut svg, Edge::Left, column == 0);
        // Nothing is below the last panel of a column.
        panel.ticks(&mut svg, Edge::Bottom, index + COLUMNS >= exhibits.len());
        svg.words((left, top - 11.0), Words::new(&exhibit.name, TITLE, Anchor::Start));
        let right = (left + FIRST.width, top - 11.0);
        svg.words(right, Words::new(&exhibit.remark, SMALL, Anchor::End));
    }
    let height = STEP.1 * rows - (STEP.1 - FIRST.height);
    let middle = (FIRST.left - 52.0, FIRST.top + 0.5 * height);
    svg.words(middle, Words { upwards: true, ..Words::new(FORCE, TEXT, Anchor::Middle) });
    // Both halves have the name of the axis.
    let half = 0.5 * STEP.0 * COLUMNS as f64;
    let right = FIRST.left + half - 8.0;
    for start in [FIRST.left, FIRST.left + half] {
        let below = (start + 0.5 * half, FIRST.top + height + 36.0);
        svg.words(below, Words::new(TIME, TEXT, Anchor::Middle));
    }
    svg.part(LEGEND);
    let top = LEGEND.top + LEGEND.height;
    let halves = Rectangle { left: 0.0, top, width: right, height: svg.height() - top };
    svg.part(halves);
    svg.part(Rectangle { left: right, width: WIDTH - right, ..halves });
    svg
}
