//! The pictures of the study of a system of one's own.

use stickslip_solver::EmbeddedPair;
use stickslip_studies::own_system::{ComparedRun, SystemConvergence};

use super::Picture;
use crate::canvas::style::METHODS;
use crate::canvas::svg::Svg;
use crate::pictures::chart::{self, ChartAxis, LineChart, Mark, Series, Shape};

/// Draws the pictures of a study: errors against work, and against tolerances.
pub fn draw(study: &SystemConvergence) -> Vec<Picture> {
    let axis = "tolerance of a step, relative and absolute";
    vec![
        Picture::new(
            "convergence_work",
            "Errors against evaluations of the right-hand side.",
            chart(study, "Work and precision", "right-hand sides", |row| row.work.field as f64),
        ),
        Picture::new(
            "convergence_tolerances",
            "Errors against the tolerance.",
            chart(study, "Errors at tolerances", axis, |row| row.tolerance),
        ),
    ]
}

/// The errors over a value of each row.
fn chart(
    study: &SystemConvergence,
    title: &str,
    axis: &str,
    x: impl Fn(&ComparedRun) -> f64,
) -> Svg {
    let mut series = Vec::new();
    for (method, stroke) in [EmbeddedPair::Dopri5, EmbeddedPair::Dop853].into_iter().zip(METHODS) {
        let mut add = |what: &str, shape, error: fn(&ComparedRun) -> f64| {
            let points = study.of(method).map(|row| (x(row), error(row)));
            series.push(Series {
                name: format!("{}, {what}", method.name()),
                points: points.filter(|(_, error)| *error > 0.0).collect(),
                line: Some(stroke),
                mark: Some(Mark { shape, colour: stroke.colour }),
            });
        };
        add("state at the end", Shape::Disc, |row| row.state);
        add("times of events and of the end", Shape::Ring, |row| row.time);
    }
    let points = || series.iter().flat_map(|series| &series.points);
    let axis_of = |name, of: fn(&(f64, f64)) -> f64| {
        let values = points().map(of);
        let ends = values.fold((f64::INFINITY, 0.0), |(low, high), value| {
            (f64::min(low, value), f64::max(high, value))
        });
        ChartAxis::around(name, ends)
    };
    let (x, y) = (axis_of(axis, |it| it.0), axis_of("error", |it| it.1));
    let title = format!("{}: {title}", study.settings.name);
    chart::draw(&LineChart { title: &title, x, y, series })
}
