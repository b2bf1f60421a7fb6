//! Fits of contact laws to measured impacts.

use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use serde_json::to_string;
use stickslip_plane::Range;
use stickslip_plane::progress::Report;
use stickslip_practice::fit::{
    self, FitError, FitSettings, FittedBodies, Free, MeasuredColumn, Values,
};
use stickslip_practice::inputs::{self, Code};

use crate::arrays::{expect_equal, numbers};
use crate::background::watched;
use crate::engines::LawChoice;
use crate::failure::{bad_input, failed, of_collision};
use crate::impacts::BodyPair;

/// What is fitted, the ranges, ε_n, the level, and whether errors are relative.
#[derive(FromPyObject)]
struct Question(Vec<String>, Vec<(String, f64, f64)>, Option<f64>, f64, bool);

/// The law, α, and κ, μ and the damping of bodies that are not known.
#[derive(FromPyObject)]
struct Scaled(LawChoice, f64, (f64, f64, f64));

/// A fit.
#[pyclass(frozen, module = "stickslip._native")]
pub struct Fit(fit::Fit);

#[pymethods]
impl Fit {
    /// Fits the data in columns, in which NaN is a missing value.
    #[staticmethod]
    #[pyo3(signature = (columns, bodies, scaled, speed, question, threads, progress=None))]
    #[expect(clippy::too_many_arguments, reason = "they are those of Python")]
    fn make(
        py: Python<'_>,
        columns: Vec<(String, PyReadonlyArray1<'_, f64>)>,
        bodies: Option<PyRef<'_, BodyPair>>,
        scaled: Scaled,
        speed: Option<f64>,
        question: Question,
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
        let columns = columns.iter().map(|(name, values)| {
            let values = numbers(values)?.into_iter();
            let values = values.map(|value| (!value.is_nan()).then_some(value)).collect();
            Ok(MeasuredColumn { name: name.clone(), values })
        });
        let columns: Vec<MeasuredColumn> = columns.collect::<PyResult<_>>()?;
        expect_equal(columns.iter().map(|column| column.values.len()))?;
        let rows: Vec<usize> = (0..columns.first().map_or(0, |it| it.values.len())).collect();
        let bodies = bodies.map_or_else(|| scaled.bodies(), |pair| Ok(pair.fitted()))?;
        let data = fit::data(&columns, &rows, speed, bodies.are_scaled()).map_err(bad_input)?;
        let settings = question.settings(FitSettings::new(bodies, data))?;
        let work = move |report: Report<'_>| fit::run(&settings, report);
        let found = watched(py, threads, progress.as_ref(), work)?;
        found.map(Self).map_err(exception)
    }

    /// The JSON that the program prints.
    fn json(&self) -> PyResult<String> {
        to_string(&self.0).map_err(failed)
    }

    /// The lines with which a particle code computes the contacts of the best fit.
    fn input(&self, bodies: PyRef<'_, BodyPair>, code: &str) -> PyResult<String> {
        let Some(code) = Code::find(code) else {
            let names = Code::ALL.map(Code::name).join(", ");
            return Err(bad_input(format!("code = {code:?}; expected one of {names}")));
        };
        let pair = self.0.best_pair(&bodies.fitted()).map_err(exception)?;
        let pair = pair.ok_or_else(|| bad_input("bodies: the fit has none; expected its own"))?;
        inputs::lines(code, &pair).map_err(bad_input)
    }

    /// Data, fit and boundaries over the angle, as an SVG document, if there is an angle.
    fn picture(&self) -> Option<String> {
        stickslip_figure::pictures::fit::draw(&self.0).map(|picture| picture.document())
    }
}

impl Question {
    fn settings(self, settings: FitSettings) -> PyResult<FitSettings> {
        let Self(free, ranges, eps_n, level, relative_errors) = self;
        let find = |name: &str| {
            Free::find(name).ok_or_else(|| {
                let names = Free::ALL.map(Free::name);
                bad_input(format!("free = {name:?}; expected \"k_t\" or one of {names:?}"))
            })
        };
        let free = free.iter().map(|name| find(name)).collect::<PyResult<_>>()?;
        let mut settings = FitSettings { free, eps_n, level, relative_errors, ..settings };
        for (name, low, high) in ranges {
            *settings.ranges.of_mut(find(&name)?) = Range { low, high };
        }
        Ok(settings)
    }
}

impl Scaled {
    fn bodies(&self) -> PyResult<FittedBodies> {
        let Self(law, alpha, (kappa, mu, damping)) = self;
        let (law, tangential_damping) = law.law()?;
        let values = Values { kappa: *kappa, mu: *mu, tangential_damping, damping: *damping };
        stickslip_model::Contact::new(*kappa, 1.0, *damping)
            .and_then(|contact| contact.with_law(law, tangential_damping))
            .and_then(|_| FittedBodies::scaled(law, *alpha, &values))
            .map_err(bad_input)
    }
}

fn exception(error: FitError) -> PyErr {
    match error {
        FitError::Contact(failure) => of_collision(failure),
        FitError::Boundaries(_)
        | FitError::NoPlaces
        | FitError::Minimum { .. }
        | FitError::Zero { .. }
        | FitError::Simplex { .. } => failed(error),
        error => bad_input(error),
    }
}
