//! Tables of the restitution.

use std::ops;

use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use stickslip_plane::progress::Report;
use stickslip_plane::{Range, sealed};
use stickslip_practice::tables::{
    self, SCHEMA, TableDocument, TableError, TableSettings, TableVerification, TableWindow,
};

use crate::arrays::{Pairs, numbers};
use crate::background::watched;
use crate::engines::LawChoice;
use crate::failure::{bad_input, failed, of_atlas};
use crate::impacts::BodyPair;
use crate::parallel::Threads;

/// ε_t and ε_n over a window, to be looked up.
#[pyclass(frozen, module = "stickslip._native")]
pub struct RestitutionTable(tables::RestitutionTable);

#[pymethods]
impl RestitutionTable {
    /// Makes and verifies the table of a window of κ and ψ at one damping.
    #[staticmethod]
    #[pyo3(signature = (kappa, psi, collisions, bound, regions, threads, progress=None))]
    #[expect(clippy::too_many_arguments, reason = "they are those of Python")]
    fn make(
        py: Python<'_>,
        kappa: (f64, f64),
        psi: (f64, f64),
        collisions: (f64, LawChoice),
        bound: f64,
        regions: bool,
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
        let (damping, law) = collisions;
        let (law, tangential_damping) = law.law()?;
        let (kappa, psi) = (range(kappa), range(psi));
        let window = TableWindow::Scaled { kappa, psi, damping, law, tangential_damping };
        Self::of(py, TableSettings { window, bound, regions }, threads, progress.as_ref())
    }

    /// Makes and verifies the table of a window of velocities of two bodies.
    #[staticmethod]
    #[pyo3(signature = (pair, normal, tangential, bound, regions, threads, progress=None))]
    #[expect(clippy::too_many_arguments, reason = "they are those of Python")]
    fn make_of_velocities(
        py: Python<'_>,
        pair: PyRef<'_, BodyPair>,
        normal: (f64, f64),
        tangential: (f64, f64),
        bound: f64,
        regions: bool,
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
        let window = TableWindow::Velocities {
            pair: pair.reduced(),
            normal_m_per_s: range(normal),
            tangential_m_per_s: range(tangential),
        };
        Self::of(py, TableSettings { window, bound, regions }, threads, progress.as_ref())
    }

    /// The table in the text of a file that `table` has written.
    #[staticmethod]
    fn read(py: Python<'_>, text: &str) -> PyResult<Self> {
        py.detach(|| {
            sealed::check(text.as_bytes()).map_err(|damaged| damaged.to_string())?;
            let document: TableDocument = serde_json::from_str(text)
                .map_err(|error| format!("expected a file of schema {SCHEMA:?}: {error}"))?;
            tables::RestitutionTable::try_from(document)
                .map(Self)
                .map_err(|error| error.to_string())
        })
        .map_err(bad_input)
    }

    /// The document of the table as JSON.
    fn json(&self) -> PyResult<String> {
        sealed::to_string(&TableDocument::from(&self.0)).map_err(failed)
    }

    /// The table as a header for C.
    fn c_header(&self, prefix: &str) -> PyResult<String> {
        self.0.c_header(prefix).map_err(bad_input)
    }

    /// The ends of both axes, the bound, the largest error of ε_t, that of ε_n, and the number of
    /// points compared.
    #[getter]
    #[expect(clippy::type_complexity, reason = "Python takes it apart")]
    fn facts(&self) -> ((f64, f64), (f64, f64), f64, (f64, f64, u64)) {
        let [x, y] = self.0.window.sides().map(|side| (side.low, side.high));
        let TableVerification { points, largest_error, largest_error_of_eps_n, .. } =
            self.0.verification;
        (x, y, self.0.bound, (largest_error, largest_error_of_eps_n, points))
    }

    /// The damping and ε_n of a table over κ and ψ; `None` of one over velocities.
    #[getter]
    fn scaled(&self) -> Option<(f64, f64)> {
        match self.0.window {
            TableWindow::Scaled { damping, .. } => Some((damping, self.0.constant_eps_n?)),
            TableWindow::Velocities { .. } => None,
        }
    }

    /// The itineraries of the regions.
    #[getter]
    fn itineraries(&self) -> Vec<String> {
        self.0.regions.clone()
    }

    /// The numbers of slabs and strips, and the size of the arrays in bytes.
    #[getter]
    fn size(&self) -> (usize, usize, usize) {
        let [slabs, strips] = self.0.pieces();
        (slabs, strips, self.0.bytes())
    }

    /// ε_t at points; NaN outside the table.
    fn eps_t<'py>(
        &self,
        py: Python<'py>,
        x: PyReadonlyArray1<'py, f64>,
        y: PyReadonlyArray1<'py, f64>,
        threads: usize,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let points = Pairs::new(x, y)?;
        let threads = Threads::new(threads, points.count())?;
        points.map(py, &threads, |x, y| self.0.eps_t(x, y))
    }

    /// ε_n along the first axis; NaN outside the table.
    fn eps_n<'py>(
        &self,
        py: Python<'py>,
        x: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let x = numbers(&x)?;
        let values =
            |part: ops::Range<usize>| x[part].iter().map(|&x| self.0.eps_n(x)).collect::<Vec<_>>();
        let mut found = Vec::with_capacity(x.len());
        Threads::new(1, x.len())?.each(py, x.len(), values, |part| {
            found.extend(part);
            Ok(())
        })?;
        Ok(found.into_pyarray(py))
    }

    /// The region at points; −1 where there is none.
    fn region<'py>(
        &self,
        py: Python<'py>,
        x: PyReadonlyArray1<'py, f64>,
        y: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<i64>>> {
        let points = Pairs::new(x, y)?;
        let region = |x, y| self.0.region(x, y).and_then(|it| i64::try_from(it).ok());
        let threads = Threads::new(1, points.count())?;
        points.map(py, &threads, |x, y| region(x, y).unwrap_or(-1))
    }
}

impl RestitutionTable {
    /// Makes and verifies the table that settings ask for.
    fn of(
        py: Python<'_>,
        settings: TableSettings,
        threads: usize,
        progress: Option<&Py<PyAny>>,
    ) -> PyResult<Self> {
        let work = move |report: Report<'_>| tables::run(&settings, report);
        let made = watched(py, threads, progress, work)?;
        made.map(Self).map_err(|error| match error {
            TableError::Settings(_) => bad_input(error),
            TableError::Atlas(error) => of_atlas(&error),
            error => failed(error),
        })
    }
}

fn range((low, high): (f64, f64)) -> Range {
    Range { low, high }
}
