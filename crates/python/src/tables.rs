//! Tables of the restitution.

use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use stickslip_plane::Range;
use stickslip_plane::progress::SILENT;
use stickslip_practice::tables::{self, Document, SCHEMA, Settings, Table, TableError};

use crate::arrays::{expect_equal, numbers};
use crate::failure::{bad_input, failed, of_atlas};
use crate::parallel::Threads;

/// ε_t over a window of (κ, ψ), to be looked up.
#[pyclass(frozen, module = "stickslip._native")]
pub struct RestitutionTable(Table);

#[pymethods]
impl RestitutionTable {
    /// Makes and verifies the table of a window.
    #[staticmethod]
    fn make(
        py: Python<'_>,
        kappa: (f64, f64),
        psi: (f64, f64),
        damping: f64,
        bound: f64,
        regions: bool,
        threads: usize,
    ) -> PyResult<Self> {
        let range = |(low, high)| Range { low, high };
        let settings = Settings { kappa: range(kappa), psi: range(psi), damping, bound, regions };
        let pool = Threads::pool(threads)?;
        let made = py.detach(|| pool.install(|| tables::run(&settings, SILENT)));
        made.map(Self).map_err(|error| match error {
            TableError::Settings(_) | TableError::Parameter(_) => bad_input(error),
            TableError::Atlas(error) => of_atlas(&error),
            error => failed(error),
        })
    }

    /// The table in the text of a file that `table` has written.
    #[staticmethod]
    fn read(py: Python<'_>, text: &str) -> PyResult<Self> {
        py.detach(|| {
            let document: Document = serde_json::from_str(text)
                .map_err(|error| format!("expected a file of schema {SCHEMA:?}: {error}"))?;
            Table::try_from(document).map(Self).map_err(|error| error.to_string())
        })
        .map_err(bad_input)
    }

    /// The document of the table as JSON.
    fn json(&self) -> PyResult<String> {
        serde_json::to_string(&Document::from(&self.0)).map_err(failed)
    }

    /// The table as a header for C.
    fn c_header(&self, prefix: &str) -> PyResult<String> {
        self.0.c_header(prefix).map_err(bad_input)
    }

    /// κ, ψ, damping, the bound, ε_n, and the largest error with the number of points compared.
    #[getter]
    #[expect(clippy::type_complexity, reason = "Python takes it apart")]
    fn facts(&self) -> ((f64, f64), (f64, f64), f64, f64, f64, (f64, u64)) {
        let Table { kappa, psi, damping, bound, eps_n, verification, .. } = &self.0;
        let checked = (verification.largest_error, verification.points);
        ((kappa[0], kappa[1]), (psi[0], psi[1]), *damping, *bound, *eps_n, checked)
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
        kappa: PyReadonlyArray1<'py, f64>,
        psi: PyReadonlyArray1<'py, f64>,
        threads: usize,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        expect_equal([kappa.len()?, psi.len()?])?;
        let (kappa, psi) = (numbers(&kappa)?, numbers(&psi)?);
        let mut found = Vec::with_capacity(kappa.len());
        let work = |part: std::ops::Range<usize>| -> Vec<f64> {
            let points = kappa[part.clone()].iter().zip(&psi[part]);
            points.map(|(&kappa, &psi)| self.0.eps_t(kappa, psi)).collect()
        };
        Threads::new(threads, kappa.len())?.each(py, kappa.len(), work, |part| {
            found.extend(part);
            Ok(())
        })?;
        Ok(found.into_pyarray(py))
    }

    /// The region at points; −1 where there is none.
    fn region<'py>(
        &self,
        py: Python<'py>,
        kappa: PyReadonlyArray1<'py, f64>,
        psi: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<i64>>> {
        expect_equal([kappa.len()?, psi.len()?])?;
        let (kappa, psi) = (numbers(&kappa)?, numbers(&psi)?);
        let region = |(&kappa, &psi): (&f64, &f64)| {
            self.0.region(kappa, psi).and_then(|it| i64::try_from(it).ok()).unwrap_or(-1)
        };
        let found: Vec<i64> = py.detach(|| kappa.iter().zip(psi.iter()).map(region).collect());
        Ok(found.into_pyarray(py))
    }
}
