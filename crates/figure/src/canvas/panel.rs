//! A frame with two axes, and what is drawn against them.

use stickslip_model::text::minus;

use super::shape::{Rectangle, Stroke};
use super::style::{FRAME, SMALL, TEXT};
use super::svg::{Anchor, Svg, Words};
use super::ticks::{self, Tick};

/// A frame that shows a part of a plane.
#[derive(Clone, Copy, Debug)]
pub struct Panel {
    /// The place of the frame in the picture.
    pub frame: Rectangle,
    /// Values at the left and the right edge.
    pub x: (f64, f64),
    /// Values at the lower and the upper edge.
    pub y: (f64, f64),
    /// The scales of x and of y.
    pub scales: (Scale, Scale),
}

/// How values lie along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Equal differences are equally far apart.
    Linear,
    /// Equal ratios are equally far apart; all values are above 0.
    Logarithmic,
}

impl Scale {
    /// The part of the way from `low` to `high` at which `value` lies.
    fn part(self, value: f64, (low, high): (f64, f64)) -> f64 {
        let part = |value: f64, low: f64, high: f64| (value - low) / (high - low);
        match self {
            Self::Linear => part(value, low, high),
            Self::Logarithmic => part(value.ln(), low.ln(), high.ln()),
        }
    }

    /// The value at a part of the way: the inverse of [`Self::part`].
    fn value(self, part: f64, (low, high): (f64, f64)) -> f64 {
        match self {
            Self::Linear => low + part * (high - low),
            Self::Logarithmic => low * (high / low).powf(part),
        }
    }
}

/// An edge of a panel that has ticks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// The left edge.
    Left,
    /// The right edge.
    Right,
    /// The lower edge.
    Bottom,
}

/// The scales of a panel with two linear axes.
pub const LINEAR: (Scale, Scale) = (Scale::Linear, Scale::Linear);

/// Length of a tick.
const TICK: f64 = 4.0;

impl Panel {
    /// The place of a point in the picture.
    pub fn place(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let along = self.scales.0.part(x, self.x);
        let up = self.scales.1.part(y, self.y);
        (self.frame.left + along * self.frame.width, self.frame.bottom() - up * self.frame.height)
    }

    /// The point at a place in the picture: the inverse of [`Self::place`].
    pub fn value(&self, (left, top): (f64, f64)) -> (f64, f64) {
        let along = (left - self.frame.left) / self.frame.width;
        let up = (self.frame.bottom() - top) / self.frame.height;
        (self.scales.0.value(along, self.x), self.scales.1.value(up, self.y))
    }

    /// Fills the panel over its whole height from one value of x to another.
    pub fn span(&self, svg: &mut Svg, (from, to): (f64, f64), colour: &str) {
        let (left, _) = self.place((from, self.y.0));
        let (right, _) = self.place((to, self.y.0));
        svg.fill(Rectangle { left, width: right - left, ..self.frame }, colour);
    }

    /// Draws a horizontal line over the whole width.
    pub fn horizontal(&self, svg: &mut Svg, y: f64, stroke: Stroke) {
        svg.line(self.place((self.x.0, y)), self.place((self.x.1, y)), stroke);
    }

    /// Draws a line through points.
    pub fn curve(
        &self,
        svg: &mut Svg,
        points: impl IntoIterator<Item = (f64, f64)>,
        stroke: Stroke,
    ) {
        svg.polyline(points.into_iter().map(|point| self.place(point)), stroke);
    }

    /// Draws the frame.
    pub fn border(&self, svg: &mut Svg) {
        svg.outline(self.frame, FRAME);
    }

    /// Draws ticks along an edge. Labels are in units of [`Self::power`]; without `labels` there
    /// are ticks alone.
    pub fn ticks(&self, svg: &mut Svg, edge: Edge, labels: bool) {
        let (length, apart, closest) = match edge {
            Edge::Bottom => (self.frame.width, 70.0, 40.0),
            Edge::Left | Edge::Right => (self.frame.height, 30.0, 20.0),
        };
        let ticks = match self.scale(edge) {
            Scale::Linear => ticks::linear(self.range(edge), length / apart),
            Scale::Logarithmic => ticks::logarithmic(self.range(edge), length / closest),
        };
        self.draw_ticks(svg, edge, &ticks, labels);
    }

    /// Draws the ticks of a linear axis along an edge at all multiples of `step`, with labels.
    pub fn ticks_every(&self, svg: &mut Svg, edge: Edge, step: f64) {
        self.draw_ticks(svg, edge, &ticks::every(step, self.range(edge)), true);
    }

    fn draw_ticks(&self, svg: &mut Svg, edge: Edge, ticks: &[Tick], labels: bool) {
        let frame = &self.frame;
        for Tick { value, label } in ticks {
            let value = *value;
            // Any value of the other axis will do.
            let (x, y) = match edge {
                Edge::Bottom => self.place((value, self.y.0)),
                Edge::Left | Edge::Right => self.place((self.x.0, value)),
            };
            let (from, to, at, anchor) = match edge {
                Edge::Bottom => {
                    let y = frame.bottom();
                    ((x, y), (x, y + TICK), (x, y + TICK + 9.0), Anchor::Middle)
                }
                Edge::Left => {
                    let x = frame.left;
                    ((x, y), (x - TICK, y), (x - TICK - 4.0, y), Anchor::End)
                }
                Edge::Right => {
                    let x = frame.right();
                    ((x, y), (x + TICK, y), (x + TICK + 4.0, y), Anchor::Start)
                }
            };
            svg.line(from, to, FRAME);
            if labels {
                svg.words(at, Words::new(label, SMALL, anchor));
            }
        }
    }

    /// The power of ten that the labels of an edge leave out, to follow the name of the axis; empty
    /// if they leave out none.
    pub fn power(&self, edge: Edge) -> String {
        match (self.scale(edge), ticks::exponent(self.range(edge))) {
            (Scale::Logarithmic, _) | (_, 0) => String::new(),
            (Scale::Linear, exponent) => minus(&format!(" (×10^{{{exponent}}})")),
        }
    }

    /// Writes the name of the lower or left axis, `distance` from its edge.
    pub fn name(&self, svg: &mut Svg, edge: Edge, distance: f64, name: &str) {
        let frame = &self.frame;
        let name = format!("{name}{}", self.power(edge));
        let words = Words::new(&name, TEXT, Anchor::Middle);
        if edge == Edge::Bottom {
            svg.words((frame.left + 0.5 * frame.width, frame.bottom() + distance), words);
        } else {
            let at = (frame.left - distance, frame.top + 0.5 * frame.height);
            svg.words(at, Words { upwards: true, ..words });
        }
    }

    fn scale(&self, edge: Edge) -> Scale {
        match edge {
            Edge::Bottom => self.scales.0,
            Edge::Left | Edge::Right => self.scales.1,
        }
    }

    fn range(&self, edge: Edge) -> (f64, f64) {
        match edge {
            Edge::Bottom => self.x,
            Edge::Left | Edge::Right => self.y,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_and_values_are_inverse() {
        let frame = Rectangle { left: 10.0, top: 20.0, width: 300.0, height: 100.0 };
        for scale in [Scale::Linear, Scale::Logarithmic] {
            let panel = Panel { frame, x: (0.5, 200.0), y: (0.1, 10.0), scales: (scale, scale) };
            let (x, y) = panel.value(panel.place((7.0, 0.3)));
            assert!((x - 7.0).abs() < 1e-12 && (y - 0.3).abs() < 1e-14);
            let (left, top) = panel.place((10.0, 1.0));
            let middle = (frame.left + 0.5 * frame.width, frame.top + 0.5 * frame.height);
            assert_eq!((left - middle.0).abs() < 1e-9, scale == Scale::Logarithmic);
            assert_eq!((top - middle.1).abs() < 1e-9, scale == Scale::Logarithmic);
        }
    }

    #[test]
    fn a_power_of_ten_that_labels_leave_out_follows_the_name() {
        let frame = Rectangle { left: 0.0, top: 0.0, width: 100.0, height: 100.0 };
        for (range, power) in
            [((0.0, 2e6), " (×10^{6})"), ((-3e-5, 3e-5), " (×10^{−5})"), ((0.0, 99999.0), "")]
        {
            let linear = Panel { frame, x: range, y: range, scales: LINEAR };
            assert_eq!(linear.power(Edge::Left), power);
            let scales = (Scale::Logarithmic, Scale::Logarithmic);
            assert_eq!(Panel { scales, ..linear }.power(Edge::Left), "");
        }
    }

    #[test]
    fn points_have_places() {
        let frame = Rectangle { left: 10.0, top: 20.0, width: 100.0, height: 50.0 };
        let panel = Panel { frame, x: (0.0, 2.0), y: (-1.0, 1.0), scales: LINEAR };
        assert_eq!(panel.place((0.0, -1.0)), (10.0, 70.0));
        assert_eq!(panel.place((2.0, 1.0)), (110.0, 20.0));
    }
}
