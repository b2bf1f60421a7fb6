//! Curves and points against two axes, with a legend: the picture of a study.

use crate::canvas::panel::{Edge, Panel, Scale};
use crate::canvas::shape::{Rectangle, Stroke};
use crate::canvas::style::{SMALL, TITLE};
use crate::canvas::svg::{Anchor, Svg, Words};

/// A picture of some series.
#[derive(Clone, Debug)]
pub struct Chart<'a> {
    /// What holds for all of it.
    pub title: &'a str,
    /// The lower axis.
    pub x: ChartAxis<'a>,
    /// The left axis.
    pub y: ChartAxis<'a>,
    /// What is drawn, in the order of the legend; what comes later lies on top.
    pub series: Vec<Series>,
}

/// An axis.
#[derive(Clone, Copy, Debug)]
pub struct ChartAxis<'a> {
    /// Its name, with the unit.
    pub name: &'a str,
    /// From where to where.
    pub range: (f64, f64),
    /// How values lie along it.
    pub scale: Scale,
}

/// Points that belong together; those outside the axes or without a value are left out.
#[derive(Clone, Debug)]
pub struct Series {
    /// Its name in the legend; without one it is not there.
    pub name: String,
    /// Its points.
    pub points: Vec<(f64, f64)>,
    /// The line through them, if there is one.
    pub line: Option<Stroke>,
    /// What marks each of them, if something does.
    pub mark: Option<Mark>,
}

/// What marks a point.
#[derive(Clone, Copy, Debug)]
pub struct Mark {
    /// Its shape.
    pub shape: Shape,
    /// Its colour.
    pub colour: &'static str,
}

/// Shapes that can be told apart without their colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// ●
    Disc,
    /// ○
    Ring,
    /// ■
    Square,
    /// ×
    Cross,
}

const WIDTH: f64 = 900.0;
const TOP: f64 = 40.0;
const LEFT: f64 = 84.0;
const LINE: f64 = 18.0;
const COLUMN: f64 = 400.0;
const FRAME_HEIGHT: f64 = 440.0;
const SIZE: f64 = 3.5;

/// Draws `chart`.
pub fn draw(chart: &Chart<'_>) -> Svg {
    let named = || chart.series.iter().filter(|series| !series.name.is_empty());
    let lines = named().count().div_ceil(2) as f64;
    let top = TOP + LINE * lines + 10.0;
    let mut svg = Svg::new(WIDTH, top + FRAME_HEIGHT + 56.0, chart.title);
    svg.words((LEFT, 22.0), Words::new(chart.title, TITLE, Anchor::Start));
    let frame = Rectangle { left: LEFT, top, width: WIDTH - LEFT - 20.0, height: FRAME_HEIGHT };
    let (x, y) = (&chart.x, &chart.y);
    let panel = Panel { frame, x: x.range, y: y.range, scales: (x.scale, y.scale) };
    for (index, series) in named().enumerate() {
        let left = LEFT + COLUMN * (index % 2) as f64;
        legend(&mut svg, (left, TOP + LINE * (index / 2) as f64), series);
    }
    for series in &chart.series {
        svg.begin_group("series");
        curves(&mut svg, &panel, series);
        svg.end_group();
    }
    panel.border(&mut svg);
    for edge in [Edge::Bottom, Edge::Left] {
        panel.ticks(&mut svg, edge, true);
    }
    panel.name(&mut svg, Edge::Bottom, 40.0, x.name);
    panel.name(&mut svg, Edge::Left, 64.0, y.name);
    svg
}

/// Whether `value` lies on `axis`.
fn on(axis: (f64, f64), value: f64) -> bool {
    (axis.0..=axis.1).contains(&value)
}

fn curves(svg: &mut Svg, panel: &Panel, series: &Series) {
    let visible = |&(x, y): &(f64, f64)| on(panel.x, x) && on(panel.y, y);
    if let Some(stroke) = series.line {
        for run in series.points.split(|point| !visible(point)).filter(|run| run.len() > 1) {
            panel.curve(svg, run.iter().copied(), stroke);
        }
    }
    if let Some(mark) = series.mark {
        for &point in series.points.iter().filter(|point| visible(point)) {
            mark.draw(svg, panel.place(point));
        }
    }
}

fn legend(svg: &mut Svg, (left, y): (f64, f64), series: &Series) {
    if let Some(stroke) = series.line {
        svg.line((left, y), (left + 30.0, y), stroke);
    }
    if let Some(mark) = series.mark {
        mark.draw(svg, (left + 15.0, y));
    }
    svg.words((left + 38.0, y), Words::new(&series.name, SMALL, Anchor::Start));
}

impl Mark {
    /// Draws it at a place in the picture.
    fn draw(self, svg: &mut Svg, (x, y): (f64, f64)) {
        let stroke = Stroke::full(self.colour, 1.6);
        match self.shape {
            Shape::Disc => svg.disc((x, y), SIZE, self.colour),
            Shape::Ring => svg.ring((x, y), SIZE, stroke),
            Shape::Square => svg.fill(
                Rectangle { left: x - SIZE, top: y - SIZE, width: 2.0 * SIZE, height: 2.0 * SIZE },
                self.colour,
            ),
            Shape::Cross => {
                svg.line((x - SIZE, y - SIZE), (x + SIZE, y + SIZE), stroke);
                svg.line((x - SIZE, y + SIZE), (x + SIZE, y - SIZE), stroke);
            }
        }
    }
}
