//! Atlases of the (κ, ψ) plane.

use numpy::{IntoPyArray, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use stickslip_model::{Contact, InvalidValue, Reduction};
use stickslip_plane::Range;
use stickslip_plane::atlas::{self, AtlasDocument, Frame, RatioRange, SCHEMA, Unlocated};
use stickslip_plane::gaining;
use stickslip_plane::progress::Report;
use stickslip_plane::sealed;
use stickslip_tracer::{AtlasOptions, Effort};

use crate::arrays::{expect_equal, numbers};
use crate::background::watched;
use crate::engines::LawChoice;
use crate::failure::{bad_input, failed, of_atlas};
use crate::parallel::Threads;

/// The boundaries and regions of a window, with their document.
#[pyclass(frozen, module = "stickslip._native")]
pub struct Atlas {
    atlas: atlas::CollisionAtlas,
    document: AtlasDocument,
}

#[pymethods]
impl Atlas {
    /// Traces the boundaries between two κ and two ψ; `ratio` is an interval of g_t/g_n with μ and
    /// α that `psi` was computed from. The collisions have this damping and this law.
    #[staticmethod]
    #[pyo3(signature = (kappa, psi, ratio, collisions, accuracy, threads, progress=None))]
    #[expect(clippy::too_many_arguments, reason = "they are those of Python")]
    fn trace(
        py: Python<'_>,
        kappa: (f64, f64),
        psi: (f64, f64),
        ratio: Option<((f64, f64), f64, f64)>,
        collisions: (f64, LawChoice),
        accuracy: (Option<f64>, String),
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
        let (tolerance, effort) = (accuracy.0, effort_of(&accuracy.1)?);
        let range = |(low, high): (f64, f64)| Range { low, high };
        let ratio = ratio.map(|(ratio, mu, alpha)| RatioRange {
            range: range(ratio),
            reduction: Reduction { mu, alpha },
        });
        let (damping, law) = collisions;
        let (law, tangential_damping) = law.law()?;
        let usual = Frame::new(range(kappa), range(psi), damping);
        let frame = Frame { ratio, law, tangential_damping, ..usual };
        let tolerance = tolerance.unwrap_or_else(|| frame.tolerances().usual);
        let work = move |report: Report<'_>| atlas::trace_with(frame, tolerance, effort, report);
        let verified = watched(py, threads, progress.as_ref(), work)?;
        let verified = verified.map_err(|error| of_atlas(&error))?;
        let document = AtlasDocument::new(&verified);
        Ok(Self { atlas: verified, document })
    }

    /// The atlas in the text of a file that `trace` has written.
    #[staticmethod]
    fn read(py: Python<'_>, text: &str) -> PyResult<Self> {
        py.detach(|| {
            let value: serde_json::Value = serde_json::from_str(text).map_err(|e| e.to_string())?;
            if value["schema"] != SCHEMA {
                let schema = &value["schema"];
                return Err(format!("schema is {schema}; expected {SCHEMA:?}"));
            }
            sealed::check(text.as_bytes()).map_err(|damaged| damaged.to_string())?;
            let document: AtlasDocument = serde_json::from_str(text).map_err(|e| e.to_string())?;
            let atlas = document.clone().try_into();
            let atlas = atlas.map_err(|e: atlas::AtlasDocumentError| e.to_string())?;
            Ok(Self { atlas, document })
        })
        .map_err(bad_input)
    }

    /// The document of the atlas as JSON.
    fn json(&self) -> PyResult<String> {
        sealed::to_string(&self.document).map_err(failed)
    }

    /// The atlas as GeoJSON.
    fn geojson(&self) -> PyResult<String> {
        let collection = atlas::document_geojson(&self.atlas, &self.document);
        serde_json::to_string(&collection).map_err(failed)
    }

    /// What speaks against the atlas.
    #[getter]
    fn objection(&self) -> Option<String> {
        self.document.verification.objection()
    }

    /// The picture as SVG.
    fn picture(&self, py: Python<'_>) -> String {
        py.detach(|| stickslip_figure::pictures::atlas::draw(&self.atlas).document())
    }

    /// The region and the distance from the nearest boundary in ψ of each point: −1 on a boundary
    /// within its error, −2 outside the window; NaN where no boundary has the same κ.
    fn locate<'py>(
        &self,
        py: Python<'py>,
        kappa: PyReadonlyArray1<'py, f64>,
        psi: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyTuple>> {
        expect_equal([kappa.len()?, psi.len()?])?;
        let (kappa, psi) = (numbers(&kappa)?, numbers(&psi)?);
        let mut regions = Vec::with_capacity(kappa.len());
        let mut distances = Vec::with_capacity(kappa.len());
        let work = |part: std::ops::Range<usize>| {
            part.map(|index| self.place(kappa[index], psi[index])).collect::<Result<Vec<_>, _>>()
        };
        Threads::new(1, kappa.len())?.each(py, kappa.len(), work, |part| {
            for (region, distance) in part.map_err(bad_input)? {
                regions.push(region);
                distances.push(distance);
            }
            Ok(())
        })?;
        (regions.into_pyarray(py), distances.into_pyarray(py)).into_pyobject(py)
    }
}

impl Atlas {
    fn place(&self, kappa: f64, psi: f64) -> Result<(i64, f64), InvalidValue> {
        Contact::new(kappa, psi, 0.0)?;
        let located = self.atlas.locate([kappa, psi]);
        let region = match located.region {
            Ok(region) => i64::try_from(region).unwrap_or(i64::MAX),
            Err(Unlocated::OnBoundary { .. } | Unlocated::OnEdge { .. }) => -1,
            Err(Unlocated::Outside { .. }) => -2,
        };
        Ok((region, located.distance.unwrap_or(f64::NAN)))
    }
}

/// The effort with a name.
pub fn effort_of(name: &str) -> PyResult<Effort> {
    let known = Effort::ALL.into_iter().find(|effort| effort.name() == name);
    let names = Effort::ALL.map(Effort::name).join(", ");
    known.ok_or_else(|| bad_input(format!("effort = {name:?}; expected one of {names}")))
}

/// The options of an atlas of a family with this effort, as JSON.
#[pyfunction]
pub fn atlas_options(effort: &str) -> PyResult<String> {
    let options = effort_of(effort)?.applied(AtlasOptions::default());
    serde_json::to_string(&options).map_err(failed)
}

/// The lines of a window on which |ε_t| is 1, as JSON, and what speaks against them.
#[pyfunction]
#[pyo3(signature = (kappa, psi, collisions, accuracy, threads, progress=None))]
pub fn gaining_lines(
    py: Python<'_>,
    kappa: (f64, f64),
    psi: (f64, f64),
    collisions: (f64, LawChoice),
    accuracy: (Option<f64>, String),
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<(String, Option<String>)> {
    let (tolerance, effort) = (accuracy.0, effort_of(&accuracy.1)?);
    let range = |(low, high): (f64, f64)| Range { low, high };
    let (damping, law) = collisions;
    let (law, tangential_damping) = law.law()?;
    let usual = Frame::new(range(kappa), range(psi), damping);
    let frame = Frame { law, tangential_damping, ..usual };
    let tolerance = tolerance.unwrap_or_else(|| frame.tolerances().usual);
    let work =
        move |report: Report<'_>| gaining::trace_with(frame, tolerance, effort, report.into());
    let found = watched(py, threads, progress.as_ref(), work)?.map_err(|error| of_atlas(&error))?;
    Ok((found.document().to_string(), found.objection()))
}
