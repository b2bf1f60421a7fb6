//! Periodic orbits of systems of formulas, as the JSON of their documents.

use pyo3::prelude::*;
use stickslip_figure::pictures::branch::{BranchCurve, BranchPoint, SpecialPoint, Stretch, draw};
use stickslip_orbits::document::{
    BranchDocument, CurveDocument, OrbitDocument, OrbitRecord, SpecialRecord,
};
use stickslip_orbits::{BranchOptions, Guess, Orbit, OrbitError, Orbits};

use crate::failure::{bad_input, failed};
use crate::formulas::FormulaSystem;

/// The mode, the time and the state at the start, where they are not those of the system.
type Start = (Option<usize>, Option<f64>, Option<Vec<f64>>);

/// The periodic orbits of a system.
#[pyclass(frozen, module = "stickslip._native")]
pub struct OrbitSystem(Orbits);

#[pymethods]
impl OrbitSystem {
    #[new]
    fn new(system: &FormulaSystem) -> PyResult<Self> {
        Orbits::new(&system.system).map(Self).map_err(bad_input)
    }

    fn find(
        &self,
        py: Python<'_>,
        parameters: Vec<f64>,
        start: Start,
        itinerary: Vec<String>,
        durations: Option<Vec<f64>>,
    ) -> PyResult<String> {
        let (mode, time, state) = start;
        let itinerary: Vec<&str> = itinerary.iter().map(String::as_str).collect();
        let (state, durations) = (state.as_deref(), durations.as_deref());
        let guess = Guess { mode, time, state, itinerary: &itinerary, durations };
        self.written(py.detach(|| self.0.find(&parameters, &guess)))
    }

    fn settled(
        &self,
        py: Python<'_>,
        parameters: Vec<f64>,
        start: Start,
        time: f64,
    ) -> PyResult<String> {
        let (mode, at, state) = start;
        let guess = Guess { mode, time: at, state: state.as_deref(), ..Guess::default() };
        self.written(py.detach(|| self.0.settled(&parameters, &guess, time)))
    }

    fn continued(&self, py: Python<'_>, orbit: &str, parameters: Vec<f64>) -> PyResult<String> {
        let orbit = self.read(orbit)?;
        self.written(py.detach(|| self.0.continued(&orbit, &parameters)))
    }

    fn doubled(
        &self,
        py: Python<'_>,
        orbit: &str,
        parameter: usize,
        aside: f64,
    ) -> PyResult<String> {
        let orbit = self.read(orbit)?;
        self.written(py.detach(|| self.0.doubled(&orbit, parameter, aside)))
    }

    fn branch(
        &self,
        py: Python<'_>,
        orbit: &str,
        parameter: usize,
        range: (f64, f64),
        longest_step: f64,
        most_points: usize,
    ) -> PyResult<String> {
        let (low, high) = range;
        let orbit = self.read(orbit)?;
        let usual = BranchOptions::default();
        let first_step = usual.first_step.min(longest_step);
        let options = BranchOptions { first_step, longest_step, most_points, ..usual };
        let found = py.detach(|| self.0.branch(&orbit, parameter, [low, high], &options));
        let document = BranchDocument::new(&self.0, "", &found.map_err(exception)?);
        serde_json::to_string(&document).map_err(failed)
    }

    fn curve(
        &self,
        py: Python<'_>,
        special: &str,
        parameters: [usize; 2],
        window: [[f64; 2]; 2],
        longest_step: f64,
    ) -> PyResult<String> {
        let record: SpecialRecord = serde_json::from_str(special).map_err(bad_input)?;
        let special = record.special(&self.0).map_err(bad_input)?;
        let usual = BranchOptions::default();
        let first_step = usual.first_step.min(longest_step);
        let options = BranchOptions { first_step, longest_step, ..usual };
        let found = py.detach(|| self.0.curve(&special, parameters, window, &options));
        let document = CurveDocument::new(&self.0, "", &found.map_err(exception)?);
        serde_json::to_string(&document).map_err(failed)
    }

    /// Times and states along an orbit.
    fn course(&self, orbit: &str, parts: usize) -> PyResult<Vec<(f64, Vec<f64>)>> {
        self.0.course(&self.read(orbit)?, parts).map_err(exception)
    }
}

impl OrbitSystem {
    /// An orbit from its record, solved for again.
    fn read(&self, orbit: &str) -> PyResult<Orbit> {
        let record: OrbitRecord = serde_json::from_str(orbit).map_err(bad_input)?;
        record.orbit(&self.0).map_err(exception)
    }

    fn written(&self, found: Result<Orbit, OrbitError>) -> PyResult<String> {
        let document = OrbitDocument::new(&self.0, "", &found.map_err(exception)?);
        serde_json::to_string(&document).map_err(failed)
    }
}

fn exception(error: OrbitError) -> PyErr {
    match error {
        OrbitError::Value(error) => bad_input(error),
        error => failed(error),
    }
}

/// The picture of a branch as SVG. Points are a parameter, what is drawn over it, whether the
/// system follows the orbit, and whether it is stable.
#[pyfunction]
pub fn branch_picture(
    title: &str,
    axes: (String, String),
    points: Vec<(f64, f64, bool, bool)>,
    specials: Vec<(String, f64, f64, usize)>,
) -> String {
    let points = points.into_iter().map(|(x, y, followed, stable)| {
        let stretch = match (followed, stable) {
            (false, _) => Stretch::Virtual,
            (true, true) => Stretch::Stable,
            (true, false) => Stretch::Unstable,
        };
        BranchPoint { at: [x, y], stretch }
    });
    let specials = specials.iter().map(|(name, x, y, behind)| SpecialPoint {
        name,
        at: [*x, *y],
        behind: *behind,
    });
    let (points, specials) = (points.collect(), specials.collect());
    draw(&BranchCurve { title, axes: [&axes.0, &axes.1], points, specials }).document()
}
