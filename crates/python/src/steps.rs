//! Errors of the time steps of particle codes.

use pyo3::prelude::*;
use serde_json::to_string;
use stickslip_model::Reduction;
use stickslip_plane::progress::Report;
use stickslip_practice::time_steps::{self, Scheme, Stepping, TimeStepSettings, TimeStepsError};

use crate::arrays::{Parameters, Points};
use crate::background::watched;
use crate::engines::LawChoice;
use crate::failure::{bad_input, failed, of_collision};

/// Errors over impacts and start phases, for each step.
#[pyclass(frozen, module = "stickslip._native")]
pub struct TimeSteps(time_steps::TimeSteps);

#[pymethods]
impl TimeSteps {
    /// Measures the errors of impacts with a law; `steps` are numbers of steps in the undamped
    /// contact time, with so many start phases, `scheme` has the overlap beside it, and `reduction`
    /// is μ and α.
    #[staticmethod]
    #[pyo3(signature = (parameters, law, steps, scheme, reduction, threads, progress=None))]
    #[expect(clippy::too_many_arguments, reason = "they are those of Python")]
    fn measure(
        py: Python<'_>,
        parameters: Parameters<'_>,
        law: LawChoice,
        steps: (Vec<f64>, usize),
        scheme: (String, f64),
        reduction: (f64, f64),
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
        let ((scheme, overlap), names) = (scheme, Scheme::ALL.map(Scheme::name));
        let scheme = Scheme::find(&scheme)
            .ok_or_else(|| bad_input(format!("scheme = {scheme:?}; expected one of {names:?}")))?;
        let settings = TimeStepSettings {
            contacts: Points::new(&parameters, &law)?.contacts()?,
            steps_per_contact: steps.0,
            phases: steps.1,
            stepping: Stepping {
                scheme,
                overlap,
                reduction: Reduction { mu: reduction.0, alpha: reduction.1 },
            },
        };
        let work = move |report: Report<'_>| time_steps::run(&settings, report);
        let found = watched(py, threads, progress.as_ref(), work)?;
        found.map(Self).map_err(|error| match error {
            TimeStepsError::Settings(invalid) => bad_input(invalid),
            TimeStepsError::Contact(failure) => of_collision(failure),
            error => failed(error),
        })
    }

    /// The JSON that the program prints.
    fn json(&self) -> PyResult<String> {
        to_string(&self.0).map_err(failed)
    }

    /// The errors over the step, as an SVG document.
    fn picture(&self) -> String {
        stickslip_figure::pictures::time_steps::draw(&self.0).document()
    }
}
