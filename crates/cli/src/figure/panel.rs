//! A frame with two axes, and what is drawn against them.

use super::style::{FRAME, SMALL, TEXT};
use super::svg::{Anchor, Rectangle, Stroke, Svg, Words};
use super::text;

/// A frame whose inside is a part of a plane.
#[derive(Clone, Copy, Debug)]
pub struct Panel {
    /// Where it is in the picture.
    pub frame: Rectangle,
    /// Values at the left and the right edge.
    pub x: (f64, f64),
    /// Values at the lower and the upper edge.
    pub y: (f64, f64),
}

/// An edge of a panel that carries an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// The left one.
    Left,
    /// The right one.
    Right,
    /// The lower one.
    Bottom,
}

/// Length of a tick.
const TICK: f64 = 4.0;

impl Panel {
    /// The place of a point in the picture.
    pub fn place(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let part = |value: f64, (low, high): (f64, f64)| (value - low) / (high - low);
        (
            self.frame.left + part(x, self.x) * self.frame.width,
            self.frame.bottom() - part(y, self.y) * self.frame.height,
        )
    }

    /// Fills the panel's height from one value of x to another.
    pub fn span(&self, svg: &mut Svg, (from, to): (f64, f64), colour: &str) {
        let (left, _) = self.place((from, self.y.0));
        let (right, _) = self.place((to, self.y.0));
        svg.fill(Rectangle { left, width: right - left, ..self.frame }, colour);
    }

    /// A horizontal line over the panel's width.
    pub fn horizontal(&self, svg: &mut Svg, y: f64, stroke: Stroke) {
        svg.line(self.place((self.x.0, y)), self.place((self.x.1, y)), stroke);
    }

    /// A line through points.
    pub fn curve(
        &self,
        svg: &mut Svg,
        points: impl IntoIterator<Item = (f64, f64)>,
        stroke: Stroke,
    ) {
        svg.polyline(points.into_iter().map(|point| self.place(point)), stroke);
    }

    /// The frame.
    pub fn border(&self, svg: &mut Svg) {
        svg.outline(self.frame, FRAME);
    }

    /// Ticks with their values along an edge; without `labels` the ticks alone.
    pub fn ticks(&self, svg: &mut Svg, edge: Edge, labels: bool) {
        let frame = &self.frame;
        let (range, length, apart) = match edge {
            Edge::Bottom => (self.x, frame.width, 70.0),
            Edge::Left | Edge::Right => (self.y, frame.height, 30.0),
        };
        for (value, label) in ticks(range, length / apart) {
            let (x, y) = self.place((value, value));
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
                svg.words(at, Words::new(&label, SMALL, anchor));
            }
        }
    }

    /// The name of an axis, `distance` from its edge.
    pub fn name(&self, svg: &mut Svg, edge: Edge, distance: f64, name: &str) {
        let frame = &self.frame;
        let (across, along) = (frame.left + 0.5 * frame.width, frame.top + 0.5 * frame.height);
        let words = Words::new(name, TEXT, Anchor::Middle);
        let (at, upwards) = match edge {
            Edge::Bottom => ((across, frame.bottom() + distance), false),
            Edge::Left => ((frame.left - distance, along), true),
            Edge::Right => ((frame.right() + distance, along), true),
        };
        svg.words(at, Words { upwards, ..words });
    }
}

/// About `count` round values between `low` and `high`, with their labels.
fn ticks((low, high): (f64, f64), count: f64) -> Vec<(f64, String)> {
    let finest = (high - low) / count.max(1.0);
    let power = finest.log10().floor();
    let unit = 10_f64.powf(power);
    let step = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * unit);
    let step = step.into_iter().find(|&step| step >= finest * (1.0 - 1e-9)).unwrap_or(finest);
    let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
    #[allow(clippy::cast_possible_truncation)]
    let indices = first as i64..=last as i64;
    let values = indices.map(|index| index as f64 * step);
    let largest = low.abs().max(high.abs());
    values.map(|value| (value, tick_label(value, step, largest))).collect()
}

/// `value` with the digits that tell it from its neighbours a `step` away.
fn tick_label(value: f64, step: f64, largest: f64) -> String {
    #[allow(clippy::cast_possible_truncation)]
    let exponent_of = |value: f64| (value.log10() + 1e-9).floor() as i32;
    let (exponent, finest) = (exponent_of(largest), exponent_of(step));
    let fixed =
        |value: f64, finest: i32| format!("{value:.*}", usize::try_from(-finest).unwrap_or(0));
    if value == 0.0 {
        return "0".to_owned();
    }
    if (-3..5).contains(&exponent) {
        return text::minus(&fixed(value, finest));
    }
    text::power(&fixed(value / 10_f64.powi(exponent), finest - exponent), exponent)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(range: (f64, f64), count: f64) -> Vec<String> {
        ticks(range, count).into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(labels((0.0, 3.218), 8.0), ["0", "0.5", "1.0", "1.5", "2.0", "2.5", "3.0"]);
        assert_eq!(labels((-1.2, 1.2), 6.0), ["−1.0", "−0.5", "0", "0.5", "1.0"]);
        assert_eq!(labels((0.0, 20.0), 5.0), ["0", "5", "10", "15", "20"]);
        assert_eq!(
            labels((0.0, 2e6), 4.0),
            ["0", "0.5×10^{6}", "1.0×10^{6}", "1.5×10^{6}", "2.0×10^{6}"]
        );
        assert_eq!(labels((-3e-5, 3e-5), 3.0), ["−2×10^{−5}", "0", "2×10^{−5}"]);
        assert_eq!(labels((0.0, 1e-300), 2.0), ["0", "0.5×10^{−300}", "1.0×10^{−300}"]);
    }

    #[test]
    fn points_have_places() {
        let frame = Rectangle { left: 10.0, top: 20.0, width: 100.0, height: 50.0 };
        let panel = Panel { frame, x: (0.0, 2.0), y: (-1.0, 1.0) };
        assert_eq!(panel.place((0.0, -1.0)), (10.0, 70.0));
        assert_eq!(panel.place((2.0, 1.0)), (110.0, 20.0));
    }
}
