//! The picture of the errors of time steps.

use stickslip_practice::time_steps::{
    Status, SteppedQuantity, TimeStepErrors, TimeStepRow, TimeSteps,
};

use super::chart::{self, ChartAxis, LineChart, Mark, Series, Shape};
use crate::canvas::panel::Scale;
use crate::canvas::shape::Stroke;
use crate::canvas::style::{BLUE, GREEN, INK, VERMILION};
use crate::canvas::svg::Svg;

/// Draws the median and the largest errors over dt/t_c, both axes logarithmic. Crosses mark steps
/// that do not resolve a spring. Steps at which contacts do not end, and errors of 0, are not
/// drawn.
pub fn draw(result: &TimeSteps) -> Svg {
    let mut series = Vec::new();
    for quantity in SteppedQuantity::ALL {
        let (symbol, colour, shape) = look(quantity);
        let median = |errors: TimeStepErrors| errors.median;
        let worst = |errors: TimeStepErrors| errors.worst.error;
        let full = Stroke::full(colour, 1.6);
        let mark = Some(Mark { shape, colour });
        let line = |name, stroke, mark, points| Series { name, points, line: Some(stroke), mark };
        let points = curve(result, quantity, worst);
        series.push(line(format!("{symbol}: largest error"), full, mark, points));
        let dashed = Stroke { dashes: "6 4", ..full };
        let points = curve(result, quantity, median);
        series.push(line(format!("{symbol}: median"), dashed, mark, points));
    }
    series.push(unstable(result));
    chart(result, series)
}

fn curve(
    result: &TimeSteps,
    quantity: SteppedQuantity,
    error: fn(TimeStepErrors) -> f64,
) -> Vec<(f64, f64)> {
    let point = |row: &TimeStepRow| {
        let error = error(row.errors(quantity)?);
        (error > 0.0).then_some((1.0 / row.steps_per_contact, error))
    };
    result.rows.iter().filter_map(point).collect()
}

/// Crosses on the errors of steps that are unstable.
fn unstable(result: &TimeSteps) -> Series {
    let rows = result.rows.iter().filter(|row| row.status == Status::Unstable);
    let points = rows.flat_map(|row| {
        let errors = SteppedQuantity::ALL.into_iter().filter_map(|quantity| row.errors(quantity));
        errors.map(|errors| (1.0 / row.steps_per_contact, errors.worst.error))
    });
    let mark = Some(Mark { shape: Shape::Cross, colour: INK });
    let name = "a spring is not resolved".to_owned();
    Series { name, points: points.collect(), line: None, mark }
}

fn look(quantity: SteppedQuantity) -> (&'static str, &'static str, Shape) {
    match quantity {
        SteppedQuantity::TangentialRestitution => ("ε_t", VERMILION, Shape::Disc),
        SteppedQuantity::NormalRestitution => ("ε_n", BLUE, Shape::Square),
        SteppedQuantity::Energy => ("energy", GREEN, Shape::Ring),
    }
}

fn chart(result: &TimeSteps, series: Vec<Series>) -> Svg {
    let points = || series.iter().flat_map(|series| &series.points);
    let range = |of: fn(&(f64, f64)) -> f64| {
        let ends = points().map(of).fold((f64::INFINITY, 0.0), |(low, high), value| {
            (f64::min(low, value), f64::max(high, value))
        });
        widened(ends)
    };
    let axis = |name, range| ChartAxis { name, range, scale: Scale::Logarithmic };
    let x = axis("time step over contact time, dt/t_c", range(|point| point.0));
    let y = axis("error", range(|point| point.1));
    let impacts = match result.contacts.len() {
        1 => "1 impact".to_owned(),
        count => format!("{count} impacts"),
    };
    let title = format!(
        "Errors in time steps: {impacts}, {} start phases, scheme {}",
        result.phases,
        result.scheme.name()
    );
    chart::draw(&LineChart { title: &title, x, y, series })
}

/// The ends of an axis, with room for whole marks. Where there is nothing to draw, any range does.
fn widened((low, high): (f64, f64)) -> (f64, f64) {
    if low < high {
        let room = (high / low).powf(0.03);
        (low / room, high * room)
    } else if low == high {
        (0.5 * low, 2.0 * high)
    } else {
        (0.001, 1.0)
    }
}
