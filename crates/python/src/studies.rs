//! Studies: stiff springs, convergence, contact laws, and the paper checked.

use std::fmt::Display;
use std::path::PathBuf;

use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use stickslip_figure::pictures::studies::{self as pictures, Picture};
use stickslip_model::Contact;
use stickslip_plane::Range;
use stickslip_plane::progress::{Progress, Report};
use stickslip_reproduction::figures::Reproduction;
use stickslip_reproduction::statements::Spring;
use stickslip_studies::{Cell, Study, StudyError, contact_laws, convergence, stiff_springs};

use crate::background::watched;
use crate::failure::{bad_input, failed};

/// The limit of stiff springs.
#[pyfunction]
#[pyo3(signature = (kappa, psi, threads, progress=None))]
pub fn asymptote(
    py: Python<'_>,
    kappa: (f64, f64),
    psi: Vec<f64>,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'_, PyDict>> {
    let kappa = Range { low: kappa.0, high: kappa.1 };
    let settings = stiff_springs::StiffSpringSettings { kappa, psi };
    settings.validate().map_err(bad_input)?;
    run(py, threads, progress.as_ref(), move |report| {
        let measured = stiff_springs::run(&settings, report)?;
        Ok::<_, StudyError>((measured.study(), pictures::stiff_springs::draw(&measured)))
    })
}

/// How accurate the integrators are, on collisions (κ, ψ, damping), or on the usual ones with this
/// damping.
#[pyfunction]
#[pyo3(signature = (contacts, damping, threads, progress=None))]
pub fn converge(
    py: Python<'_>,
    contacts: Option<Vec<[f64; 3]>>,
    damping: f64,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'_, PyDict>> {
    let settings = match contacts {
        None => convergence::ConvergenceSettings::usual(damping).map_err(bad_input)?,
        Some(contacts) => {
            let contacts = contacts.into_iter().map(|[kappa, psi, a]| Contact::new(kappa, psi, a));
            let contacts = contacts.collect::<Result<_, _>>().map_err(bad_input)?;
            convergence::ConvergenceSettings { contacts }
        }
    };
    settings.validate().map_err(bad_input)?;
    run(py, threads, progress.as_ref(), move |report| {
        let measured = convergence::run(&settings, report)?;
        Ok::<_, StudyError>((measured.study(), pictures::convergence::draw(&measured)))
    })
}

/// What the contact laws of particle codes do, on maps of so many cells in each direction.
#[pyfunction(name = "contact_laws")]
#[pyo3(signature = (damping, tangential_damping, cells, threads, progress=None))]
pub fn compare_laws(
    py: Python<'_>,
    damping: f64,
    tangential_damping: f64,
    cells: usize,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'_, PyDict>> {
    let usual = contact_laws::ContactLawSettings::default();
    let settings = contact_laws::ContactLawSettings { damping, tangential_damping, cells, ..usual };
    settings.validate().map_err(bad_input)?;
    run(py, threads, progress.as_ref(), move |report| {
        let computed = contact_laws::run(&settings, report).map_err(|it| it.to_string())?;
        let pictures = pictures::contact_laws::draw(&computed).map_err(|it| it.to_string())?;
        Ok::<_, String>((computed.study(), pictures))
    })
}

/// The titles of the parts of the reproduction.
#[pyfunction]
pub fn reproduction_parts() -> Vec<&'static str> {
    Reproduction::parts().iter().map(|part| part.title).collect()
}

/// One part of the reproduction, with maps of so many cells in each direction.
#[pyfunction]
#[pyo3(signature = (part, cells, threads, progress=None))]
pub fn reproduce(
    py: Python<'_>,
    part: usize,
    cells: usize,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'_, PyDict>> {
    let parts = Reproduction::parts();
    let chosen = parts
        .get(part)
        .ok_or_else(|| bad_input(format!("part {part}; expected 0 to {}", parts.len() - 1)))?;
    let reproduction = Reproduction::new(cells, Spring::Reset);
    let work = move |report: Report<'_>| {
        report(Progress::Begin { steps: 1 });
        let made = chosen.run(&reproduction);
        report(Progress::Advance { steps: 1 });
        made
    };
    let section = watched(py, threads, progress.as_ref(), work)?.map_err(failed)?;
    let study = dictionary(py, &section.study, &section.pictures)?;
    let objections: Vec<_> = section.objections.iter().map(ToString::to_string).collect();
    study.set_item("objections", objections)?;
    Ok(study)
}

/// Writes the page of the whole reproduction, with its files, into a directory: what speaks against
/// it.
#[pyfunction]
#[pyo3(signature = (directory, cells, threads, progress=None))]
pub fn reproduce_all(
    py: Python<'_>,
    directory: PathBuf,
    cells: usize,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Option<String>> {
    let work = move |report: Report<'_>| {
        let tell = |index: usize, count: usize, title: &'static str| {
            let done = usize::from(index > 0);
            report(Progress::Begin { steps: if index == 0 { count } else { 0 } });
            report(Progress::Advance { steps: done });
            report(Progress::Now { what: title });
        };
        let written = stickslip_cli::write_everything(&directory, cells, Spring::Reset, &tell);
        report(Progress::Advance { steps: 1 });
        written
    };
    match watched(py, threads, progress.as_ref(), work)? {
        Ok(()) => Ok(None),
        Err(stickslip_cli::Failure::Objection(objection)) => Ok(Some(objection)),
        Err(error) => Err(PyOSError::new_err(error.to_string())),
    }
}

/// What `make` makes, on so many threads, as a dictionary.
pub fn run<'py, E: Display + Send + 'static>(
    py: Python<'py>,
    threads: usize,
    progress: Option<&Py<PyAny>>,
    make: impl FnOnce(Report<'_>) -> Result<(Study, Vec<Picture>), E> + Send + 'static,
) -> PyResult<Bound<'py, PyDict>> {
    let (study, pictures) = watched(py, threads, progress, make)?.map_err(failed)?;
    dictionary(py, &study, &pictures)
}

/// A study as a dictionary; `json` is text.
fn dictionary<'py>(
    py: Python<'py>,
    study: &Study,
    pictures: &[Picture],
) -> PyResult<Bound<'py, PyDict>> {
    let tables = PyList::empty(py);
    for table in &study.tables {
        let rows = PyList::empty(py);
        for row in &table.rows {
            let cells = PyList::empty(py);
            for cell in row {
                match cell {
                    Cell::Number(value) => cells.append(value)?,
                    Cell::Count(count) => cells.append(count)?,
                    Cell::Text(_) => cells.append(cell.text())?,
                }
            }
            rows.append(cells)?;
        }
        let columns: Vec<_> = table.columns.iter().map(|one| (one.name, one.meaning)).collect();
        tables.append((table.name, &table.title, columns, rows))?;
    }
    let pictures = pictures.iter();
    let pictures: Vec<_> =
        pictures.map(|one| (&one.name, &one.caption, one.svg.document())).collect();
    let dictionary = PyDict::new(py);
    dictionary.set_item("name", study.name)?;
    dictionary.set_item("title", study.title)?;
    dictionary.set_item("findings", &study.findings)?;
    dictionary.set_item("json", study.json.to_string())?;
    dictionary.set_item("tables", tables)?;
    dictionary.set_item("pictures", pictures)?;
    Ok(dictionary)
}
