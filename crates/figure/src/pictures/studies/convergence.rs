//! The pictures of the study of convergence.

use stickslip_solver::EmbeddedPair;
use stickslip_solver::method::Order;
use stickslip_studies::convergence::{
    Control, Convergence, ErrorRow, ErrorSeries, Errors, Formulation, SeriesScheme, Spread,
    SwitchHandling, fitted,
};

use super::Picture;
use crate::canvas::shape::Stroke;
use crate::canvas::style::METHODS;
use crate::canvas::svg::Svg;
use crate::pictures::chart::{self, ChartAxis, LineChart, Mark, Shape};

/// An error that is drawn.
struct DrawnError {
    name: &'static str,
    error: fn(&Errors) -> Spread,
    /// Whether all collisions have this error.
    complete: fn(&Errors) -> bool,
    order: fn(&ErrorSeries) -> Option<Order>,
}

const VELOCITY: DrawnError = DrawnError {
    name: "error of the final velocity w, root mean square",
    error: |errors| errors.velocity,
    complete: |errors| errors.failed == 0,
    order: |series| series.velocity,
};

const SWITCH_TIME: DrawnError = DrawnError {
    name: "error of switch times, root mean square",
    error: |errors| errors.switch_time,
    complete: Errors::comparable,
    order: |series| series.switch_time,
};

/// Draws the pictures of a study: errors against steps, against tolerances, and against work.
pub fn draw(study: &Convergence) -> Vec<Picture> {
    let steps = |error: &DrawnError| {
        let axis = "step, in s (regularised) or scaled time (plain time)";
        errors(study, "Errors in fixed steps, and fitted orders", axis, Control::Step, error)
    };
    let tolerances = |error: &DrawnError| {
        let (title, axis) =
            ("Errors at tolerances, and fitted exponents", "tolerance, relative and absolute");
        errors(study, title, axis, Control::Tolerance, error)
    };
    let fitted = "Lines are thick where the order in the legend was fitted.";
    let same = "Where steps run over switches, both methods have the same errors.";
    vec![
        Picture::new(
            "convergence_steps_velocity",
            &format!("Error of the final velocity against the step. {fitted} {same}"),
            steps(&VELOCITY),
        ),
        Picture::new(
            "convergence_steps_switches",
            &format!("Error of switch times against the step. {fitted} {same}"),
            steps(&SWITCH_TIME),
        ),
        Picture::new(
            "convergence_tolerances_velocity",
            &format!("Error of the final velocity against the tolerance. {fitted}"),
            tolerances(&VELOCITY),
        ),
        Picture::new(
            "convergence_tolerances_switches",
            &format!("Error of switch times against the tolerance. {fitted}"),
            tolerances(&SWITCH_TIME),
        ),
        Picture::new(
            "convergence_work",
            "Error of the final velocity against evaluations of the right-hand side: adaptive \
             steps with switches located, and fixed steps that run over switches.",
            work(study),
        ),
    ]
}

fn errors(
    study: &Convergence,
    title: &str,
    axis: &str,
    control: Control,
    drawn: &DrawnError,
) -> Svg {
    let mut lines = Vec::new();
    for series in study.series.iter().filter(|series| series.scheme.control == control) {
        let points = points(series, |row| row.value, drawn);
        let order = (drawn.order)(series);
        if let Some(order) = &order {
            let range = fitted(order);
            let fitted = points.iter().copied().filter(|(value, _)| range.contains(value));
            let line = Some(Stroke { width: 3.6, ..stroke(series.scheme) });
            let points = fitted.collect();
            lines.push(chart::Series { name: String::new(), points, line, mark: None });
        }
        let order = order.map_or("no fit".to_owned(), |order| {
            format!("{:.3} ± {:.3}", order.order, order.standard_error)
        });
        lines.push(marked_line(series.scheme, &order, points));
    }
    chart(title, axis, drawn, lines)
}

fn work(study: &Convergence) -> Svg {
    let shown = |scheme: &SeriesScheme| {
        scheme.control == Control::Tolerance
            || (scheme.switches, scheme.coordinates)
                == (SwitchHandling::AtStepEnds, Formulation::PlainTime)
    };
    let lines = study.series.iter().filter(|series| shown(&series.scheme)).map(|series| {
        let points = points(series, |row| study.work(&row.errors), &VELOCITY);
        let control = match series.scheme.control {
            Control::Step => "fixed steps",
            Control::Tolerance => "adaptive",
        };
        marked_line(series.scheme, control, points)
    });
    let axis = "evaluations of the right-hand side a collision";
    chart("Work and precision", axis, &VELOCITY, lines.collect())
}

/// The points of a series at which all collisions have an error.
fn points(
    series: &ErrorSeries,
    x: impl Fn(&ErrorRow) -> f64,
    drawn: &DrawnError,
) -> Vec<(f64, f64)> {
    let rows = series.rows.iter().filter(|row| (drawn.complete)(&row.errors));
    rows.map(|row| (x(row), (drawn.error)(&row.errors).root_mean_square))
        .filter(|(_, error)| *error > 0.0)
        .collect()
}

/// A line with marks, and its name in the legend.
fn marked_line(scheme: SeriesScheme, remark: &str, points: Vec<(f64, f64)>) -> chart::Series {
    let stroke = stroke(scheme);
    let shape = match (scheme.switches, scheme.coordinates) {
        (SwitchHandling::Located, Formulation::Regularized) => Shape::Disc,
        (SwitchHandling::Located, Formulation::PlainTime) => Shape::Ring,
        (SwitchHandling::AtStepEnds, Formulation::Regularized) => Shape::Square,
        (SwitchHandling::AtStepEnds, Formulation::PlainTime) => Shape::Cross,
    };
    let [pair, variables, switches] = scheme.names();
    let name = format!("{pair}, {variables}, {switches}: {remark}");
    let mark = Some(Mark { shape, colour: stroke.colour });
    chart::Series { name, points, line: Some(stroke), mark }
}

/// The stroke of a pair.
fn stroke(scheme: SeriesScheme) -> Stroke {
    match scheme.pair {
        EmbeddedPair::Dopri5 => METHODS[0],
        EmbeddedPair::Dop853 => METHODS[1],
    }
}

fn chart(title: &str, axis: &str, drawn: &DrawnError, series: Vec<chart::Series>) -> Svg {
    let points = || series.iter().flat_map(|series| &series.points);
    let range = |of: fn(&(f64, f64)) -> f64| {
        let values = points().map(of);
        values.fold((f64::INFINITY, 0.0), |(low, high), value| {
            (f64::min(low, value), f64::max(high, value))
        })
    };
    let (x, y) = (range(|point| point.0), range(|point| point.1));
    let (x, y) = (ChartAxis::around(axis, x), ChartAxis::around(drawn.name, y));
    chart::draw(&LineChart { title, x, y, series })
}
