//! Charts: curves and points against two axes, with a legend.

use crate::canvas::panel::{Edge, Panel, Scale};
use crate::canvas::shape::{Rectangle, Stroke};
use crate::canvas::style::{SMALL, TITLE};
use crate::canvas::svg::{Anchor, Svg, Words};

/// A chart of some series.
#[derive(Clone, Debug)]
pub struct LineChart<'a> {
    /// The title of the chart.
    pub title: &'a str,
    /// The lower axis.
    pub x: ChartAxis<'a>,
    /// The left axis.
    pub y: ChartAxis<'a>,
    /// The series, in the order of the legend. Later ones lie on top.
    pub series: Vec<Series>,
}

/// An axis of a chart.
#[derive(Clone, Copy, Debug)]
pub struct ChartAxis<'a> {
    /// The name of the axis, with the unit.
    pub name: &'a str,
    /// The values at the ends of the axis.
    pub range: (f64, f64),
    /// Whether the axis is linear or logarithmic.
    pub scale: Scale,
}

impl<'a> ChartAxis<'a> {
    /// A logarithmic axis around values above 0, with room for marks at its ends. Where there are
    /// no two values, it has any range.
    pub fn around(name: &'a str, (low, high): (f64, f64)) -> Self {
        let room = (high / low).powf(0.02);
        let range = if low < high { (low / room, high * room) } else { (0.1, 1.0) };
        Self { name, range, scale: Scale::Logarithmic }
    }
}

/// Points that belong together. Points outside the axes or without a value are not drawn.
#[derive(Clone, Debug)]
pub struct Series {
    /// The name in the legend. A series without a name, or without a visible point, is not in the
    /// legend.
    pub name: String,
    /// The points.
    pub points: Vec<(f64, f64)>,
    /// The line through the points, if there is one.
    pub line: Option<Stroke>,
    /// The mark of each point, if there is one.
    pub mark: Option<Mark>,
}

/// The mark of a point.
#[derive(Clone, Copy, Debug)]
pub struct Mark {
    /// Shape of the mark.
    pub shape: Shape,
    /// Colour of the mark.
    pub colour: &'static str,
}

/// Shapes of marks, which can be told apart without their colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// A small filled circle, for many points.
    Dot,
    /// A filled circle ●.
    Disc,
    /// A circle ○.
    Ring,
    /// A filled square ■.
    Square,
    /// A cross ×.
    Cross,
}

const WIDTH: f64 = 900.0;
const TOP: f64 = 44.0;
const LEFT: f64 = 84.0;
const LINE: f64 = 18.0;
const COLUMN: f64 = 400.0;
const FRAME_HEIGHT: f64 = 440.0;
/// Half the size of a mark.
const SIZE: f64 = 3.5;
/// The radius of a small mark.
const DOT: f64 = 1.0;

/// Draws `chart`.
pub fn draw(chart: &LineChart<'_>) -> Svg {
    let (x, y) = (&chart.x, &chart.y);
    let named = || {
        let named = chart.series.iter().filter(|series| !series.name.is_empty());
        named.filter(|series| series.is_visible(x.range, y.range))
    };
    let lines = named().count().div_ceil(2) as f64;
    let top = TOP + LINE * lines + 10.0;
    let mut svg = Svg::new(WIDTH, top + FRAME_HEIGHT + 56.0, chart.title);
    svg.words((LEFT, 22.0), Words::new(chart.title, TITLE, Anchor::Start));
    let frame = Rectangle { left: LEFT, top, width: WIDTH - LEFT - 20.0, height: FRAME_HEIGHT };
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

impl Series {
    /// Whether something of the series is inside the axes.
    fn is_visible(&self, x: (f64, f64), y: (f64, f64)) -> bool {
        let lines = self.line.is_some() && self.runs(x, y).any(|run| run.len() > 1);
        let marks = self.mark.is_some() && self.runs(x, y).any(|run| !run.is_empty());
        lines || marks
    }

    /// The longest pieces of the series that lie inside the axes.
    fn runs(&self, x: (f64, f64), y: (f64, f64)) -> impl Iterator<Item = &[(f64, f64)]> {
        let on = |(low, high): (f64, f64), value: f64| (low..=high).contains(&value);
        self.points.split(move |point| !(on(x, point.0) && on(y, point.1)))
    }
}

/// Draws the lines and marks of a series.
fn curves(svg: &mut Svg, panel: &Panel, series: &Series) {
    let runs = || series.runs(panel.x, panel.y);
    if let Some(stroke) = series.line {
        for run in runs().filter(|run| run.len() > 1) {
            panel.curve(svg, run.iter().copied(), stroke);
        }
    }
    if let Some(mark) = series.mark {
        for &point in runs().flatten() {
            mark.draw(svg, panel.place(point));
        }
    }
}

/// Draws an entry of the legend.
fn legend(svg: &mut Svg, (left, y): (f64, f64), series: &Series) {
    if let Some(stroke) = series.line {
        svg.line((left, y), (left + 30.0, y), stroke);
    }
    if let Some(mark) = series.mark {
        // One dot alone would hardly have a colour.
        let shape = if mark.shape == Shape::Dot { Shape::Disc } else { mark.shape };
        Mark { shape, ..mark }.draw(svg, (left + 15.0, y));
    }
    svg.words((left + 38.0, y), Words::new(&series.name, SMALL, Anchor::Start));
}

impl Mark {
    /// Draws the mark at a place in the picture.
    fn draw(self, svg: &mut Svg, (x, y): (f64, f64)) {
        let stroke = Stroke::full(self.colour, 1.6);
        match self.shape {
            Shape::Dot => svg.disc((x, y), DOT, self.colour),
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
