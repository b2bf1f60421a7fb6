//! The picture of a fit: data and minima over the angle of impact.

use stickslip_practice::fit::{Fit, FittedCourse, Measured};

use crate::canvas::panel::{Edge, LINEAR, Panel};
use crate::canvas::shape::{Rectangle, Stroke};
use crate::canvas::style::{INK, MINIMA, RULE, SMALL, TITLE};
use crate::canvas::svg::{Anchor, Svg, Words};

const WIDTH: f64 = 900.0;
const LEFT: f64 = 84.0;
const TOP: f64 = 44.0;
const LINE: f64 = 18.0;
const HEIGHT: f64 = 340.0;
const GAP: f64 = 34.0;
/// Width of a label on top of the first panel, and half the width of the end of an error bar.
const LABEL: f64 = 20.0;
const CAP: f64 = 3.0;

/// Draws the data with their errors, the best fit and the two next minima over the angle, a panel
/// for each quantity. Vertical lines are where the switches of the best fit change; the numbers of
/// switches stand between them. `None` without [`Fit::course`].
pub fn draw(fit: &Fit) -> Option<Svg> {
    let course = fit.course.as_ref()?;
    let measured = |quantity: &Measured| {
        fit.residuals.iter().any(|residual| residual.datum.quantity == *quantity)
    };
    let quantities: Vec<_> = Measured::ALL.into_iter().filter(measured).collect();
    let shown = fit.minima.len().min(MINIMA.len());
    let top = TOP + LINE * shown as f64 + 26.0;
    let height = top + (HEIGHT + GAP) * quantities.len() as f64 + 26.0;
    let mut svg = Svg::new(WIDTH, height, "Fit of measured impacts");
    svg.words((LEFT, 22.0), Words::new("Fit of measured impacts", TITLE, Anchor::Start));
    legend(&mut svg, fit);
    for (index, quantity) in quantities.into_iter().enumerate() {
        let at = top + (HEIGHT + GAP) * index as f64;
        let frame = Rectangle { left: LEFT, top: at, width: WIDTH - LEFT - 20.0, height: HEIGHT };
        panel(&mut svg, fit, course, quantity, frame);
        if index == 0 {
            switches(&mut svg, course, frame);
        }
    }
    let name = "angle of impact from the normal [°]";
    let words = Words::new(name, SMALL + 1.0, Anchor::Middle);
    svg.words((LEFT + 0.5 * (WIDTH - LEFT - 20.0), height - 14.0), words);
    Some(svg)
}

fn legend(svg: &mut Svg, fit: &Fit) {
    for (index, (minimum, stroke)) in fit.minima.iter().zip(MINIMA).enumerate() {
        let y = TOP + LINE * index as f64;
        svg.line((LEFT, y), (LEFT + 30.0, y), stroke);
        let which = if index == 0 { "best fit" } else { "another minimum" };
        let values = &minimum.values;
        let text = format!(
            "{which}: κ = {:.4}, μ = {:.4}, misfit {:.4}",
            values.kappa, values.mu, minimum.misfit
        );
        svg.words((LEFT + 38.0, y), Words::new(&text, SMALL, Anchor::Start));
    }
}

fn panel(svg: &mut Svg, fit: &Fit, course: &FittedCourse, quantity: Measured, frame: Rectangle) {
    let data = fit.residuals.iter().map(|residual| residual.datum);
    let data = data.filter(|datum| datum.quantity == quantity).map(|datum| {
        let (value, error) = (quantity.shown(datum.value), datum.error.unwrap_or(0.0));
        (datum.angle_rad().to_degrees(), value, quantity.shown(error))
    });
    let data: Vec<(f64, f64, f64)> = data.collect();
    let curves = course.curves.iter().filter(|curve| curve.quantity == quantity);
    let values = curves.clone().flat_map(|curve| curve.points.iter().map(|point| point.1));
    let bars = data.iter().flat_map(|(_, value, error)| [value - error, value + error]);
    let (low, high) = values
        .chain(bars)
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
    let room = 0.04 * (high - low) + 1e-9 * high.abs().max(1e-9);
    let x = (course.angles_rad.low.to_degrees(), course.angles_rad.high.to_degrees());
    let panel = Panel { frame, x, y: (low - room, high + room), scales: LINEAR };
    svg.begin_inside(frame);
    for boundary in &course.boundaries {
        let angle = boundary.angle_rad.to_degrees();
        svg.line(panel.place((angle, panel.y.0)), panel.place((angle, panel.y.1)), RULE);
    }
    for curve in curves {
        if let Some(stroke) = MINIMA.get(curve.minimum) {
            panel.curve(svg, curve.points.iter().copied(), *stroke);
        }
    }
    for (angle, value, error) in data {
        let stroke = Stroke::full(INK, 1.2);
        let ends = [value - error, value + error].map(|end| panel.place((angle, end)));
        if error > 0.0 {
            svg.line(ends[0], ends[1], stroke);
            for (x, y) in ends {
                svg.line((x - CAP, y), (x + CAP, y), stroke);
            }
        }
        svg.disc(panel.place((angle, value)), 3.5, INK);
    }
    svg.end_inside();
    panel.border(svg);
    panel.ticks(svg, Edge::Bottom, true);
    panel.ticks(svg, Edge::Left, true);
    panel.name(svg, Edge::Left, 64.0, name(quantity));
}

/// Writes the numbers of switches between the boundaries, above a frame, where there is room.
fn switches(svg: &mut Svg, course: &FittedCourse, frame: Rectangle) {
    let stickslip_plane::Range { low, high } = course.angles_rad;
    let place = |angle: f64| frame.left + frame.width * (angle - low) / (high - low);
    let angles = course.boundaries.iter().map(|boundary| boundary.angle_rad);
    let ends: Vec<f64> = std::iter::once(low).chain(angles).chain([high]).collect();
    let count = |itinerary: &str| itinerary.chars().count().saturating_sub(1);
    for (index, ends) in ends.windows(2).enumerate() {
        let (from, to) = (place(ends[0]), place(ends[1]));
        let below = course.boundaries.get(index).map(|boundary| &boundary.below);
        let above = || course.boundaries.last().map(|boundary| &boundary.above);
        if let Some(itinerary) = below.or_else(above).filter(|_| to - from >= LABEL) {
            let text = count(itinerary).to_string();
            let words = Words::new(&text, SMALL, Anchor::Middle);
            svg.words((0.5 * (from + to), frame.top - 9.0), words);
        }
    }
    let words = Words::new("switches", SMALL, Anchor::End);
    svg.words((frame.left - 8.0, frame.top - 9.0), words);
}

fn name(quantity: Measured) -> &'static str {
    match quantity {
        Measured::EpsN => "ε_n",
        Measured::EpsT => "ε_t",
        Measured::CentreRestitution => "e_t of the centre",
        Measured::Spin => "spin [rad/s]",
        Measured::ReboundAngle => "rebound angle [°]",
    }
}
