//! Periodic orbits of systems of formulas, as the JSON of their documents.

use std::sync::Arc;

use pyo3::prelude::*;
use serde_json::json;
use stickslip_figure::pictures::branch::{
    BranchCurve, BranchPoint, BranchStretch, SpecialMark, draw,
};
use stickslip_figure::pictures::family::draw_named;
use stickslip_orbits::document::{
    BranchRecord, Document, OrbitRecord, OrbitRegions, SpecialRecord,
};
use stickslip_orbits::{
    Attractor, Branch, BranchOptions, Column, Guess, Orbit, OrbitAtlas, OrbitBoundary, OrbitError,
    OrbitNames, Orbits, RegionOptions, Section, SectionPoint, SpecialOrbit,
};
use stickslip_plane::sealed;
use stickslip_tracer::Point;

use crate::background::abandonable;
use crate::failure::{bad_input, failed};
use crate::formulas::FormulaSystem;

/// The mode, the time and the state at the start, where they are not those of the system.
type Start = (Option<usize>, Option<f64>, Option<Vec<f64>>);

/// Times and states.
type Points = Vec<(f64, Vec<f64>)>;

/// A value of a parameter, its points, and why there are none.
type DiagramColumn = (f64, Points, Option<String>);

/// The periodic orbits of a system.
#[pyclass(frozen, module = "stickslip._native")]
pub struct OrbitSystem(Arc<Orbits>);

#[pymethods]
impl OrbitSystem {
    #[new]
    fn new(system: &FormulaSystem) -> PyResult<Self> {
        Orbits::new(&system.system).map(|it| Self(Arc::new(it))).map_err(bad_input)
    }

    fn find(
        &self,
        py: Python<'_>,
        parameters: Vec<f64>,
        start: Start,
        itinerary: Vec<String>,
        durations: Option<Vec<f64>>,
    ) -> PyResult<String> {
        let found = self.on_thread(py, None, move |orbits| {
            let itinerary: Vec<&str> = itinerary.iter().map(String::as_str).collect();
            let (itinerary, durations) = (&itinerary[..], durations.as_deref());
            orbits.find(&parameters, &Guess { itinerary, durations, ..guess(&start) })
        })?;
        self.written(found)
    }

    fn settled(
        &self,
        py: Python<'_>,
        parameters: Vec<f64>,
        start: Start,
        time: f64,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<String> {
        let work = move |orbits: &Orbits| orbits.settled(&parameters, &guess(&start), time);
        self.written(self.on_thread(py, progress, work)?)
    }

    fn continued(&self, py: Python<'_>, orbit: &str, parameters: Vec<f64>) -> PyResult<String> {
        let orbit = self.read(orbit)?;
        self.written(self.on_thread(py, None, move |orbits| orbits.continued(&orbit, &parameters))?)
    }

    fn switched(
        &self,
        py: Python<'_>,
        special: &str,
        beside: &str,
        parameter: usize,
        aside: f64,
    ) -> PyResult<String> {
        let (special, beside) = (self.read_special(special)?, self.read(beside)?);
        let work = move |orbits: &Orbits| orbits.switched(&special, &beside, parameter, aside);
        self.written(self.on_thread(py, None, work)?)
    }

    #[expect(clippy::too_many_arguments, reason = "they are those of Python")]
    fn branch(
        &self,
        py: Python<'_>,
        orbit: &str,
        parameter: usize,
        range: (f64, f64),
        longest_step: f64,
        most_points: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<String> {
        let orbit = self.read(orbit)?;
        let options = steps(longest_step, most_points);
        let work = move |orbits: &Orbits| orbits.branch(&orbit, parameter, range.into(), &options);
        self.written_branch(self.on_thread(py, progress, work)?)
    }

    /// The branch in the text of a file.
    fn read_branch(&self, py: Python<'_>, text: &str) -> PyResult<String> {
        sealed::check(text.as_bytes()).map_err(bad_input)?;
        let document: Document<BranchRecord> = serde_json::from_str(text).map_err(bad_input)?;
        self.written_branch(self.on_thread(py, None, move |orbits| document.branch(orbits))?)
    }

    fn resumed(
        &self,
        py: Python<'_>,
        branch: &str,
        range: (f64, f64),
        longest_step: f64,
        most_points: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<String> {
        let document: Document<BranchRecord> = serde_json::from_str(branch).map_err(bad_input)?;
        let options = steps(longest_step, most_points);
        let found = self.on_thread(py, progress, move |orbits| {
            orbits.resumed(&document.branch(orbits)?, range.into(), &options)
        })?;
        self.written_branch(found)
    }

    fn curve(
        &self,
        py: Python<'_>,
        special: &str,
        parameters: [usize; 2],
        window: [[f64; 2]; 2],
        longest_step: f64,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<String> {
        let special = self.read_special(special)?;
        let options = steps(longest_step, BranchOptions::default().most_points);
        let work = move |orbits: &Orbits| orbits.curve(&special, parameters, window, &options);
        let found = self.on_thread(py, progress, work)?;
        let document = Document::of_curve(&self.0, "", &found.map_err(exception)?);
        serde_json::to_string(&document).map_err(failed)
    }

    /// The regions of an orbit over two parameters.
    fn regions(
        &self,
        py: Python<'_>,
        orbit: &str,
        parameters: [usize; 2],
        window: [[f64; 2]; 2],
        cells: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<OrbitMap> {
        let orbit = self.read(orbit)?;
        let options = RegionOptions { cells, ..RegionOptions::default() };
        let centre = orbit.clone();
        let work = move |orbits: &Orbits| orbits.regions(&centre, parameters, window, &options);
        let atlas = self.on_thread(py, progress, work)?.map_err(exception)?;
        let document = Document::of_regions(&self.0, "", (&orbit, parameters), &atlas, &options);
        OrbitMap::new(document)
    }

    /// Times and states where a run meets a rule.
    fn section(
        &self,
        py: Python<'_>,
        parameters: Vec<f64>,
        start: Start,
        rule: String,
        span: (f64, f64),
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Points> {
        let found = self.on_thread(py, progress, move |orbits| {
            let section = Section { rule: &rule, skip: span.0, time: span.1 };
            orbits.section(&parameters, &guess(&start), &section)
        })?;
        Ok(pairs(found.map_err(exception)?))
    }

    /// The same over values of a parameter, upwards and downwards: values, points and troubles.
    #[expect(clippy::too_many_arguments, reason = "they are those of Python")]
    fn diagram(
        &self,
        py: Python<'_>,
        parameters: Vec<f64>,
        start: Start,
        over: (usize, Vec<f64>),
        rule: String,
        span: (f64, f64),
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Vec<Vec<DiagramColumn>>> {
        let found = self.on_thread(py, progress, move |orbits| {
            let section = Section { rule: &rule, skip: span.0, time: span.1 };
            orbits.diagram(&parameters, &guess(&start), (over.0, &over.1[..]), &section)
        })?;
        let columns = |columns: Vec<Column>| {
            columns.into_iter().map(|it| (it.value, pairs(it.points), it.trouble)).collect()
        };
        Ok(found.map_err(exception)?.into_iter().map(columns).collect())
    }

    /// The exponents, their spread, and the number of events.
    fn exponents(
        &self,
        py: Python<'_>,
        parameters: Vec<f64>,
        start: Start,
        span: (f64, f64),
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(Vec<f64>, f64, usize)> {
        let (skip, time) = span;
        let work = move |orbits: &Orbits| orbits.exponents(&parameters, &guess(&start), skip, time);
        let found = self.on_thread(py, progress, work)?;
        found.map(|it| (it.values, it.spread, it.events)).map_err(exception)
    }

    /// The attractors as JSON, and the number of that of each run, or -1.
    #[expect(clippy::too_many_arguments, reason = "they are those of Python")]
    fn basins(
        &self,
        py: Python<'_>,
        parameters: Vec<f64>,
        start: Start,
        components: [usize; 2],
        values: (Vec<f64>, Vec<f64>),
        time: f64,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(Vec<String>, Vec<i64>)> {
        let found = self.on_thread(py, progress, move |orbits| {
            let values = [&values.0[..], &values.1];
            orbits.basins(&parameters, &guess(&start), components, values, time)
        })?;
        let found = found.map_err(bad_input)?;
        let system = self.0.system();
        let mode = |mode: usize| system.modes[mode].name.clone();
        let attractors = found.attractors.iter().map(|it| {
            let written = match it {
                Attractor::Orbit(orbit) => json!({ "orbit": OrbitRecord::new(system, orbit) }),
                Attractor::Rest { mode: at, state } => json!({ "mode": mode(*at), "state": state }),
                Attractor::End { mode: at, rule } => {
                    let name = system.modes[*at].rules[*rule].name(*rule);
                    json!({ "mode": mode(*at), "rule": name })
                }
            };
            serde_json::to_string(&written).map_err(failed)
        });
        let number = |label: Option<usize>| label.and_then(|it| i64::try_from(it).ok());
        let labels = found.labels.iter().map(|label| number(*label).unwrap_or(-1));
        Ok((attractors.collect::<PyResult<_>>()?, labels.collect()))
    }

    /// Times and states along an orbit.
    fn course(&self, py: Python<'_>, orbit: &str, parts: usize) -> PyResult<Points> {
        let orbit = self.read(orbit)?;
        let found = self.on_thread(py, None, move |orbits| orbits.course(&orbit, parts))?;
        found.map_err(exception)
    }
}

impl OrbitSystem {
    /// What `work` makes on threads of its own, which Ctrl-C does not wait for. They end soon then.
    fn on_thread<T: Send + 'static>(
        &self,
        py: Python<'_>,
        progress: Option<Py<PyAny>>,
        work: impl FnOnce(&Orbits) -> T + Send + 'static,
    ) -> PyResult<T> {
        let orbits = Arc::clone(&self.0);
        abandonable(py, 0, progress.as_ref(), move |_, watch| {
            work(&orbits.watched(Arc::clone(watch)))
        })
    }

    /// An orbit from its record, solved for again.
    fn read(&self, orbit: &str) -> PyResult<Orbit> {
        let record: OrbitRecord = serde_json::from_str(orbit).map_err(bad_input)?;
        record.orbit(&self.0).map_err(exception)
    }

    /// A special orbit as it is written.
    fn read_special(&self, special: &str) -> PyResult<SpecialOrbit> {
        let record: SpecialRecord = serde_json::from_str(special).map_err(bad_input)?;
        record.special(&self.0).map_err(bad_input)
    }

    fn written_branch(&self, found: Result<Branch, OrbitError>) -> PyResult<String> {
        let document = Document::of_branch(&self.0, "", &found.map_err(exception)?);
        sealed::to_string(&document).map_err(failed)
    }

    fn written(&self, found: Result<Orbit, OrbitError>) -> PyResult<String> {
        let document = Document::of_orbit(&self.0, "", &found.map_err(exception)?);
        serde_json::to_string(&document).map_err(failed)
    }
}

/// The regions of an orbit.
#[pyclass(frozen, module = "stickslip._native")]
pub struct OrbitMap {
    atlas: OrbitAtlas,
    names: OrbitNames,
    text: String,
}

impl OrbitMap {
    fn new(document: Document<OrbitRegions>) -> PyResult<Self> {
        let text = sealed::to_string(&document).map_err(failed)?;
        let (atlas, names) = document.read().map_err(bad_input)?;
        Ok(Self { atlas, names, text })
    }

    /// The label of a region that is not in doubt.
    fn label(&self, region: usize) -> Option<Vec<usize>> {
        let sure =
            (!self.atlas.is_doubtful(region)).then(|| self.atlas.plane.regions().get(region));
        Some(sure??.label.as_ref()?.0.clone())
    }
}

/// The kind of a boundary, its segment and rule, the labels on both sides, and its points.
type BoundaryLine = (&'static str, Option<usize>, Option<String>, [Vec<usize>; 2], Vec<(f64, f64)>);

#[pymethods]
impl OrbitMap {
    /// The regions of a document.
    #[staticmethod]
    fn read(text: &str) -> PyResult<Self> {
        sealed::check(text.as_bytes()).map_err(bad_input)?;
        Self::new(serde_json::from_str(text).map_err(bad_input)?)
    }

    /// The orbits at a point, unless it is on a boundary, outside the window, or in doubt.
    fn at(&self, x: f64, y: f64) -> Option<Vec<usize>> {
        self.atlas.label(&Point::new(x, y)).map(|label| label.0.clone())
    }

    /// For each region its orbits, its area, a point of it, and the places of its boundaries.
    #[expect(clippy::type_complexity, reason = "rows of Python")]
    fn regions(&self) -> Vec<(Option<Vec<usize>>, f64, (f64, f64), Vec<usize>)> {
        let all = self.atlas.plane.regions().iter().enumerate();
        let row = all.map(|(place, it)| {
            let mut boundary: Vec<usize> = it.boundary.iter().map(|(curve, _)| *curve).collect();
            boundary.sort_unstable();
            boundary.dedup();
            (self.label(place), it.area, (it.sample.x, it.sample.y), boundary)
        });
        row.collect()
    }

    fn boundaries(&self) -> Vec<BoundaryLine> {
        let extent = self.atlas.plane.window().extent();
        let all = self.atlas.plane.curves().iter();
        let row = all.map(|it| {
            let OrbitBoundary { kind, segment, rule } = &it.margin;
            let sides = it.sides.each_ref().map(|label| label.0.clone());
            let points = it.polyline(&extent).into_iter().map(|point| (point.x, point.y));
            (kind.name(), *segment, rule.clone(), sides, points.collect())
        });
        row.collect()
    }

    /// The names of the parameters.
    #[getter]
    fn axes(&self) -> [String; 2] {
        self.names.axes.clone()
    }

    /// The error of boundaries.
    #[getter]
    fn tolerance(&self) -> f64 {
        self.atlas.plane.tolerance()
    }

    /// What speaks against the regions.
    #[getter]
    fn objection(&self) -> Option<String> {
        self.atlas.doubts(&self.names).map(|doubts| doubts.objection())
    }

    /// The document as JSON.
    #[getter]
    fn text(&self) -> String {
        self.text.clone()
    }

    fn svg(&self, title: &str) -> String {
        draw_named(&self.atlas, &self.names, title).document()
    }
}

/// How a branch is followed.
fn steps(longest_step: f64, most_points: usize) -> BranchOptions {
    let usual = BranchOptions::default();
    let first_step = usual.first_step.min(longest_step);
    BranchOptions { first_step, longest_step, most_points, ..usual }
}

fn guess(start: &Start) -> Guess<'_> {
    let (mode, time, ref state) = *start;
    Guess { mode, time, state: state.as_deref(), ..Guess::default() }
}

fn pairs(points: Vec<SectionPoint>) -> Points {
    points.into_iter().map(|it| (it.s, it.state)).collect()
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
            (false, _) => BranchStretch::Virtual,
            (true, true) => BranchStretch::Stable,
            (true, false) => BranchStretch::Unstable,
        };
        BranchPoint { at: [x, y], stretch }
    });
    let specials = specials.iter().map(|(name, x, y, behind)| SpecialMark {
        name,
        at: [*x, *y],
        behind: *behind,
    });
    let (points, specials) = (points.collect(), specials.collect());
    draw(&BranchCurve { title, axes: [&axes.0, &axes.1], points, specials }).document()
}
