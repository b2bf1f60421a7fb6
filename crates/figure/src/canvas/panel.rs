//! A frame with two axes, and what is drawn against them.

use super::number::{minus, number};
use super::shape::{Rectangle, Stroke};
use super::style::{FRAME, SMALL, TEXT};
use super::svg::{Anchor, Svg, Words};

/// A frame whose inside is a part of a plane.
#[derive(Clone, Copy, Debug)]
pub struct Panel {
    /// Where it is in the picture.
    pub frame: Rectangle,
    /// Values at the left and the right edge.
    pub x: (f64, f64),
    /// Values at the lower and the upper edge.
    pub y: (f64, f64),
    /// How values lie along the width and along the height.
    pub scales: (Scale, Scale),
}

/// How values lie along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Equal differences are equally far apart.
    Linear,
    /// Equal ratios are; all values are above 0.
    Logarithmic,
}

impl Scale {
    /// What part of the way from `low` to `high` leads to `value`.
    fn part(self, value: f64, (low, high): (f64, f64)) -> f64 {
        let part = |value: f64, low: f64, high: f64| (value - low) / (high - low);
        match self {
            Self::Linear => part(value, low, high),
            Self::Logarithmic => part(value.ln(), low.ln(), high.ln()),
        }
    }

    /// The value to which a part of the way leads: the inverse of [`Self::part`].
    fn value(self, part: f64, (low, high): (f64, f64)) -> f64 {
        match self {
            Self::Linear => low + part * (high - low),
            Self::Logarithmic => low * (high / low).powf(part),
        }
    }
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

/// Both axes linear.
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

    /// Ticks with their values along an edge, in units of [`Self::power`]; without `labels` the
    /// ticks alone.
    pub fn ticks(&self, svg: &mut Svg, edge: Edge, labels: bool) {
        let frame = &self.frame;
        let (length, apart, closest) = match edge {
            Edge::Bottom => (frame.width, 70.0, 40.0),
            Edge::Left | Edge::Right => (frame.height, 30.0, 20.0),
        };
        let marks = match self.scale(edge) {
            Scale::Linear => ticks(self.range(edge), length / apart),
            Scale::Logarithmic => decade_ticks(self.range(edge), length / closest),
        };
        for (value, label) in marks {
            // Of the other axis, any value will do.
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
                svg.words(at, Words::new(&label, SMALL, anchor));
            }
        }
    }

    /// The power of ten in units of which the ticks of an edge are labelled, to follow the name of
    /// what they show; empty where numbers need none.
    pub fn power(&self, edge: Edge) -> String {
        match (self.scale(edge), exponent(self.range(edge))) {
            (Scale::Logarithmic, _) | (_, 0) => String::new(),
            (Scale::Linear, exponent) => minus(&format!(" (×10^{{{exponent}}})")),
        }
    }

    /// The name of the lower or left axis, `distance` from its edge.
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

/// About `count` round values between `low` and `high`, with their labels in units of
/// 10^[`exponent`].
fn ticks((low, high): (f64, f64), count: f64) -> Vec<(f64, String)> {
    let unit = 10_f64.powi(exponent((low, high)));
    let (low, high) = (low / unit, high / unit);
    let finest = (high - low) / count.max(1.0);
    let power = finest.log10().floor();
    let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * 10_f64.powf(power));
    let step = steps.into_iter().find(|&step| step >= finest * (1.0 - 1e-9)).unwrap_or(finest);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let decimals = (-(step.log10() + 1e-9).floor()).max(0.0) as usize;
    #[allow(clippy::cast_possible_truncation)]
    let indices = (low / step - 1e-9).ceil() as i64..=(high / step + 1e-9).floor() as i64;
    let label = |value: f64| {
        if value == 0.0 { "0".to_owned() } else { minus(&format!("{value:.decimals$}")) }
    };
    let values = indices.map(|index| index as f64 * step);
    values.map(|value| (value * unit, label(value))).collect()
}

/// At most about `count` values 1, 2, 5 or 1 times powers of ten between `low` and `high`, above 0,
/// with their labels.
fn decade_ticks((low, high): (f64, f64), count: f64) -> Vec<(f64, String)> {
    #[allow(clippy::cast_possible_truncation)]
    let [first, last] = [low, high].map(|end| end.log10().floor() as i32);
    let decades = (high / low).log10();
    let factors: &[f64] = if 3.0 * decades <= count { &[1.0, 2.0, 5.0] } else { &[1.0] };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let apart = (decades / count.max(1.0)).ceil().max(1.0) as usize;
    let within = |value: &f64| (low * (1.0 - 1e-9)..=high * (1.0 + 1e-9)).contains(value);
    (first..=last)
        .step_by(apart)
        // Parsed, because powers computed are not always the nearest doubles.
        .flat_map(|power| factors.iter().filter_map(move |f| format!("{f}e{power}").parse().ok()))
        .filter(within)
        .map(|value| (value, number(value, 3)))
        .collect()
}

/// The power of ten that ticks leave out: 0 for numbers that fit beside an axis as they are.
fn exponent((low, high): (f64, f64)) -> i32 {
    #[allow(clippy::cast_possible_truncation)]
    let exponent = low.abs().max(high.abs()).log10().floor() as i32;
    // Below, 10^−exponent is no number any more.
    if (-2..5).contains(&exponent) { 0 } else { exponent.max(-300) }
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
        assert_eq!(labels((17.9, 18.1), 3.0), ["17.9", "18.0", "18.1"]);
        assert_eq!(labels((0.0, 3e4), 3.0), ["0", "10000", "20000", "30000"]);
    }

    #[test]
    fn decades_have_round_ticks() {
        let labels = |range, count| {
            decade_ticks(range, count).into_iter().map(|tick| tick.1).collect::<Vec<_>>()
        };
        assert_eq!(labels((5.0, 100.0), 20.0), ["5", "10", "20", "50", "100"]);
        assert_eq!(labels((0.05, 1.5), 20.0), ["0.05", "0.1", "0.2", "0.5", "1"]);
        assert_eq!(labels((1e-3, 1e3), 8.0), ["0.001", "0.01", "0.1", "1", "10", "100", "1000"]);
        assert_eq!(labels((1.0, 1e9), 4.0), ["1", "1000", "1×10^{6}", "1×10^{9}"]);
    }

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
    fn very_large_and_small_numbers_leave_out_a_power_of_ten() {
        let frame = Rectangle { left: 0.0, top: 0.0, width: 100.0, height: 100.0 };
        for (range, exponent, shown) in [
            ((0.0, 2e6), " (×10^{6})", ["0", "0.5", "1.0", "1.5", "2.0"].as_slice()),
            ((-3e-5, 3e-5), " (×10^{−5})", &["−2", "0", "2"]),
            ((0.0, 2e-300), " (×10^{−300})", &["0", "0.5", "1.0", "1.5", "2.0"]),
            ((0.0, 99999.0), "", &["0", "50000"]),
        ] {
            let panel = Panel { frame, x: range, y: range, scales: LINEAR };
            assert_eq!(panel.power(Edge::Left), exponent);
            let count =
                if shown.len() > 3 { 4.0 } else { 3.0 - f64::from(u8::from(shown.len() == 2)) };
            assert_eq!(labels(range, count), shown);
        }
        let (value, _) = ticks((0.0, 2e6), 4.0)[3];
        assert!((value - 1.5e6).abs() < 1e-6);
    }

    #[test]
    fn points_have_places() {
        let frame = Rectangle { left: 10.0, top: 20.0, width: 100.0, height: 50.0 };
        let panel = Panel { frame, x: (0.0, 2.0), y: (-1.0, 1.0), scales: LINEAR };
        assert_eq!(panel.place((0.0, -1.0)), (10.0, 70.0));
        assert_eq!(panel.place((2.0, 1.0)), (110.0, 20.0));
    }
}
