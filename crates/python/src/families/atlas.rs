//! Atlases of families: what is found, and its file.

use std::ops::Range;

use numpy::{IntoPyArray, PyReadonlyArray1, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use serde_json::Value;
use stickslip_figure::pictures::family::draw_runs;
use stickslip_plane::sealed;
use stickslip_solver::margin::{Margin, Place};
use stickslip_tracer::{
    Atlas, AtlasOptions, Names, Point, RunNames,
    document::{FamilyAtlasDocument, SCHEMA},
    hybrid::Itinerary,
    regions::Location,
    tracing::{End, Followed, SpecialPoint},
};

use crate::arrays::{expect_equal, numbers};
use crate::failure::{bad_input, failed};
use crate::parallel::Threads;

/// A label: fires, begins, accumulates, unfinished or fails, and the guards that fire; or no_start,
/// and the condition that does not hold.
pub type Label = (&'static str, Vec<usize>);

/// The boundaries and the regions of a family.
#[pyclass(frozen, module = "stickslip._native")]
pub struct FamilyAtlas {
    pub atlas: Atlas<Itinerary, Margin>,
    pub options: AtlasOptions,
    pub names: RunNames,
}

/// What a file says about a family: its name, the names of the two parameters, and those of guards.
#[derive(FromPyObject)]
pub struct Description(String, [String; 2], Vec<String>);

impl From<Description> for RunNames {
    fn from(Description(family, axes, guards): Description) -> Self {
        Self { family, axes, guards }
    }
}

/// Requires a family to have the same parameters and guards as another one of its stack.
pub fn expect_like(own: &RunNames, first: &RunNames) -> PyResult<()> {
    let RunNames { axes, guards, .. } = own;
    let RunNames { axes: others, guards: theirs, .. } = first;
    if (axes, guards) == (others, theirs) {
        return Ok(());
    }
    Err(bad_input(format!(
        "the family is of {axes:?} with guards {guards:?}; expected {others:?} with guards \
         {theirs:?}, as in the first one"
    )))
}

/// Requires an atlas to be of this family.
pub fn expect(own: &RunNames, expected: &RunNames) -> PyResult<()> {
    if own == expected {
        return Ok(());
    }
    let RunNames { family, axes, guards } = own;
    let RunNames { family: other, axes: others, guards: theirs } = expected;
    Err(bad_input(format!(
        "the atlas is of the family {family:?} of {axes:?} with guards {guards:?}; expected one \
         of {other:?} of {others:?} with guards {theirs:?}"
    )))
}

#[pymethods]
impl FamilyAtlas {
    /// The atlas in the text of a file.
    #[staticmethod]
    fn read(py: Python<'_>, text: &str) -> PyResult<Self> {
        py.detach(|| {
            let value: Value = serde_json::from_str(text).map_err(|error| error.to_string())?;
            if value["schema"] != SCHEMA {
                return Err(format!("schema is {}; expected {SCHEMA:?}", value["schema"]));
            }
            sealed::check(text.as_bytes()).map_err(|damaged| damaged.to_string())?;
            let document: FamilyAtlasDocument<Itinerary, Margin> =
                serde_json::from_str(text).map_err(|error| error.to_string())?;
            let (names, options) = (document.names(), document.options);
            let atlas = document.atlas().map_err(|error| error.to_string())?;
            Ok(Self { atlas, options, names })
        })
        .map_err(bad_input)
    }

    /// The document of the atlas as JSON.
    fn json(&self, py: Python<'_>) -> PyResult<String> {
        let document = || FamilyAtlasDocument::of_runs(&self.atlas, &self.options, &self.names);
        py.detach(|| sealed::to_string(&document())).map_err(failed)
    }

    /// Whether the trace came to its end.
    #[getter]
    fn finished(&self) -> bool {
        self.atlas.is_finished()
    }

    /// What speaks against the atlas.
    #[getter]
    fn objection(&self) -> Option<String> {
        self.atlas.doubts(&self.names).map(|doubts| doubts.objection())
    }

    /// What is inconsistent, and what is unresolved, in words.
    #[getter]
    fn doubts(&self) -> (Vec<String>, Vec<String>) {
        let findings = self.atlas.verification.standing(&self.atlas.plane).map(ToString::to_string);
        let vertices = self.atlas.plane.vertices();
        let unresolved =
            self.atlas.unresolved.iter().map(|what| self.names.unresolved(what, vertices));
        (findings.collect(), unresolved.collect())
    }

    /// Whether each region is in doubt, and the part of the area in the others.
    #[getter]
    fn sure(&self) -> (Vec<bool>, f64) {
        let regions = 0..self.atlas.plane.regions().len();
        let doubtful = regions.map(|region| self.atlas.is_doubtful(region));
        (doubtful.collect(), self.atlas.sure_area())
    }

    /// The kind of each vertex.
    #[getter]
    fn vertex_kinds(&self) -> Vec<&'static str> {
        let kinds = self.atlas.plane.vertices().iter().map(|vertex| match vertex.kind {
            kind if kind.is_on_window() => kind.name(),
            _ => "other",
        });
        let mut kinds: Vec<_> = kinds.collect();
        for (vertex, name) in self.atlas.plane.special_points() {
            kinds[vertex] = match name {
                SpecialPoint::Crossing => "crossing",
                SpecialPoint::DoubleGraze => "double-graze",
                SpecialPoint::Cusp => "cusp",
                SpecialPoint::GrazeAtEnd => "graze-at-end",
                SpecialPoint::SimultaneousEvents => "simultaneous-events",
                SpecialPoint::Tangency => "tangency",
                SpecialPoint::Other => "other",
            };
        }
        kinds
    }

    /// Points of a curve that are as close together as a picture needs, x and y in turn.
    fn polyline<'py>(&self, py: Python<'py>, curve: usize) -> PyResult<Bound<'py, PyAny>> {
        let curves = self.atlas.plane.curves();
        let curve = curves.get(curve).ok_or_else(|| bad_input(format!("curve {curve}")))?;
        let points = curve.polyline(&self.atlas.plane.window().extent());
        let flat: Vec<f64> = points.iter().flat_map(|point| [point.x, point.y]).collect();
        Ok(flat.into_pyarray(py).into_any())
    }

    /// The picture as SVG.
    fn picture(&self, py: Python<'_>) -> String {
        py.detach(|| draw_runs(&self.atlas, &self.names).document())
    }

    /// The region of each point and its distance from the nearest curve in y: −1 on a curve within
    /// its error, −2 outside the window; NaN where no curve has the same x.
    fn locate<'py>(
        &self,
        py: Python<'py>,
        x: PyReadonlyArray1<'py, f64>,
        y: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyTuple>> {
        let points = points(&x, &y)?;
        let place = |point: &Point| {
            let region = match self.atlas.plane.locate(point) {
                Location::Region(region) => i64::try_from(region).unwrap_or(i64::MAX),
                Location::OnBoundary { .. } => -1,
                Location::Outside => -2,
            };
            (region, self.atlas.plane.vertical_distance(point).unwrap_or(f64::NAN))
        };
        let places = |part: Range<usize>| points[part].iter().map(place).collect::<Vec<_>>();
        let mut regions = Vec::with_capacity(points.len());
        let mut distances = Vec::with_capacity(points.len());
        Threads::new(1, points.len())?.each(py, points.len(), places, |part| {
            for (region, distance) in part {
                regions.push(region);
                distances.push(distance);
            }
            Ok(())
        })?;
        (regions.into_pyarray(py), distances.into_pyarray(py)).into_pyobject(py)
    }
}

impl FamilyAtlas {
    pub fn new(atlas: Atlas<Itinerary, Margin>, options: AtlasOptions, names: RunNames) -> Self {
        Self { atlas, options, names }
    }

    /// The labels of points of the window that the regions tell, and the indices of those that they
    /// do not.
    pub fn told(&self, points: &[Point]) -> (Vec<Option<Label>>, Vec<usize>) {
        let plane = &self.atlas.plane;
        let mut open = Vec::new();
        let labels = points.iter().enumerate().map(|(index, point)| {
            if !plane.window().contains(point) {
                return None;
            }
            // A curve may lie on the edge of the window.
            let (low, high) = (point - plane.window().low, plane.window().high - point);
            let inside = low.inf(&high).min() > plane.tolerance();
            let found = self.atlas.label(point).filter(|_| inside).map(label);
            if found.is_none() {
                open.push(index);
            }
            found
        });
        (labels.collect(), open)
    }
}

/// The name of the place of a margin.
pub fn place(margin: &Margin) -> &'static str {
    match margin.place {
        Place::Start { .. } => "start",
        Place::Minimum { .. } => "minimum",
        Place::Maximum { .. } => "maximum",
        Place::Exit(_) => "exit",
        Place::Branch(_) => "branch",
        Place::End => "end",
        Place::Condition => "condition",
    }
}

/// Points whose coordinates are in two arrays of one length.
pub fn points(
    x: &PyReadonlyArray1<'_, f64>,
    y: &PyReadonlyArray1<'_, f64>,
) -> PyResult<Vec<Point>> {
    expect_equal([x.len(), y.len()])?;
    let (x, y) = (numbers(x)?, numbers(y)?);
    Ok(x.into_iter().zip(y).map(|(x, y)| Point::new(x, y)).collect())
}

/// A label as Python gets it.
pub fn label(label: &Itinerary) -> Label {
    match label {
        Itinerary::Fires(guards) => ("fires", guards.clone()),
        Itinerary::Begins(guards) => ("begins", guards.clone()),
        Itinerary::Accumulates => ("accumulates", Vec::new()),
        Itinerary::Unfinished => ("unfinished", Vec::new()),
        Itinerary::Fails => ("fails", Vec::new()),
        Itinerary::NoStart(failed) => ("no_start", vec![*failed]),
    }
}

/// One boundary as columns.
pub fn followed<'py>(
    py: Python<'py>,
    found: &Followed<Itinerary, Margin>,
) -> PyResult<Bound<'py, PyDict>> {
    let flat = |points: Vec<Point>| -> Vec<f64> {
        points.iter().flat_map(|point| [point.x, point.y]).collect()
    };
    let points = flat(found.nodes.iter().map(|node| node.point).collect());
    let tangents = flat(found.nodes.iter().map(|node| node.tangent).collect());
    let end = |end: &End<Margin>| match end {
        End::Closed => "closed",
        End::Known(_) => "vertex",
        End::Vertex(special) => match special.kind {
            kind if kind.is_on_window() => kind.name(),
            _ if special.solved => "vertex",
            _ => "stalled",
        },
        End::Limit => "limit",
    };
    let ends = found.ends.as_ref().map(|ends| (end(&ends[0]), end(&ends[1])));
    let zeros = found.zeros.iter().map(|zero| {
        let point = zero.point.map(|point| (point.x, point.y));
        (zero.monitor, zero.node, point)
    });
    let exits: Vec<usize> = found.margin.exits.iter().map(|exit| exit.guard).collect();
    let columns = PyDict::new(py);
    columns.set_item("margin", (exits, found.margin.guard, place(&found.margin)))?;
    columns.set_item("sides", (label(&found.sides[0]), label(&found.sides[1])))?;
    columns.set_item("points", points.into_pyarray(py))?;
    columns.set_item("tangents", tangents.into_pyarray(py))?;
    columns.set_item("ends", ends)?;
    let values = found.values.iter().map(|values| values.clone().into_pyarray(py));
    columns.set_item("values", values.collect::<Vec<_>>())?;
    columns.set_item("zeros", zeros.collect::<Vec<_>>())?;
    Ok(columns)
}
