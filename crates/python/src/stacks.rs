//! Atlases over the damping.

use pyo3::prelude::*;
use stickslip_figure::pictures;
use stickslip_plane::Range;
use stickslip_plane::atlas::Frame;
use stickslip_plane::progress::Report;
use stickslip_plane::sealed;
use stickslip_plane::stack::stack as stacked;

use crate::background::watched;
use crate::failure::{failed, of_atlas};

/// The stack of a window as JSON, its picture as SVG, and what speaks against it.
#[pyfunction]
#[pyo3(signature = (kappa, psi, dampings, tolerance, threads, progress=None))]
pub fn stack(
    py: Python<'_>,
    kappa: (f64, f64),
    psi: (f64, f64),
    dampings: Vec<f64>,
    tolerance: Option<f64>,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<(String, String, Option<String>)> {
    let range = |(low, high): (f64, f64)| Range { low, high };
    let frame = Frame::new(range(kappa), range(psi), 0.0);
    let tolerance = tolerance.unwrap_or_else(|| frame.tolerances().usual);
    let work = move |report: Report<'_>| stacked(frame, &dampings, tolerance, report);
    let made = watched(py, threads, progress.as_ref(), work)?.map_err(|error| of_atlas(&error))?;
    let json = sealed::to_string(&made.document()).map_err(failed)?;
    Ok((json, pictures::stack::draw(&made).document(), made.objection()))
}
