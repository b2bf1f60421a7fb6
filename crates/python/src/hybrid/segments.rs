//! Dense output that is kept.

use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyDictMethods};
use stickslip_solver::dynamic::DynamicDense;

use crate::failure::bad_input;
use crate::parallel::in_pieces;

/// The dense output of successive steps, in the order of the run.
#[derive(Default)]
pub struct Segments {
    starts: Vec<f64>,
    sizes: Vec<f64>,
    modes: Vec<usize>,
    coefficients: Vec<f64>,
}

impl Segments {
    pub fn push(&mut self, mode: usize, dense: &DynamicDense<'_>) {
        self.starts.push(dense.start());
        self.sizes.push(dense.size());
        self.modes.push(mode);
        self.coefficients.extend_from_slice(dense.coefficients());
    }

    /// Keeps this step only.
    pub fn replace(&mut self, mode: usize, dense: &DynamicDense<'_>) {
        self.starts.clear();
        self.sizes.clear();
        self.modes.clear();
        self.coefficients.clear();
        self.push(mode, dense);
    }

    pub fn is_empty(&self) -> bool {
        self.starts.is_empty()
    }

    /// The mode of the last step and its dense output, with `dimension` components.
    pub fn last(&self, dimension: usize) -> Option<(usize, DynamicDense<'_>)> {
        let view = View {
            starts: &self.starts,
            sizes: &self.sizes,
            coefficients: &self.coefficients,
            dimension,
        };
        let index = self.starts.len().checked_sub(1)?;
        Some((self.modes[index], view.segment(index)?))
    }

    /// Puts the columns into `columns`.
    pub fn columns(self, columns: &Bound<'_, PyDict>) -> PyResult<()> {
        let py = columns.py();
        columns.set_item("starts", self.starts.into_pyarray(py))?;
        columns.set_item("sizes", self.sizes.into_pyarray(py))?;
        columns.set_item("segment_modes", self.modes.into_pyarray(py))?;
        columns.set_item("coefficients", self.coefficients.into_pyarray(py))
    }
}

/// Segments as Python keeps them.
struct View<'a> {
    starts: &'a [f64],
    sizes: &'a [f64],
    coefficients: &'a [f64],
    dimension: usize,
}

impl<'a> View<'a> {
    fn segment(&self, index: usize) -> Option<DynamicDense<'a>> {
        let length = self.coefficients.len() / self.starts.len();
        let coefficients = &self.coefficients[index * length..(index + 1) * length];
        let (start, size) = (self.starts[index], self.sizes[index]);
        DynamicDense::from_coefficients(start, size, self.dimension, coefficients)
    }

    /// The index of the segment in which `time` lies. At the start of a segment it is that one.
    fn index(&self, time: f64) -> Option<usize> {
        let forwards = self.sizes.first().is_some_and(|&size| size > 0.0);
        let begun = |&start: &f64| if forwards { start <= time } else { start >= time };
        self.starts.partition_point(begun).checked_sub(1)
    }
}

/// The states at `times`, one after another; NaN outside the run, which ends at `end.0` in the
/// state `end.1`.
#[pyfunction]
#[expect(clippy::float_cmp, reason = "only at the very end the state is known exactly")]
pub fn evaluate_dense<'py>(
    py: Python<'py>,
    segments: (PyReadonlyArray1<'py, f64>, PyReadonlyArray1<'py, f64>, PyReadonlyArray1<'py, f64>),
    end: (f64, PyReadonlyArray1<'py, f64>),
    times: PyReadonlyArray1<'py, f64>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let (starts, sizes, coefficients) = segments;
    let ((end, last), times) = (end, times.as_slice()?);
    let last = last.as_slice()?;
    let view = View {
        starts: starts.as_slice()?,
        sizes: sizes.as_slice()?,
        coefficients: coefficients.as_slice()?,
        dimension: last.len(),
    };
    if view.starts.len() != view.sizes.len() {
        return Err(bad_input("as many starts as sizes are expected"));
    }
    let mut states = vec![f64::NAN; times.len() * last.len()];
    let forwards = view.sizes.first().is_none_or(|&size| size > 0.0);
    in_pieces(py, times.len(), None, |piece| {
        let part = &mut states[piece.start * last.len()..piece.end * last.len()];
        for (&time, row) in times[piece].iter().zip(part.chunks_exact_mut(last.len().max(1))) {
            if time == end {
                row.copy_from_slice(last);
            } else if let Some(index) = view.index(time)
                && (if forwards { time < end } else { time > end })
            {
                let segment = view.segment(index).ok_or_else(|| bad_input("unfit coefficients"))?;
                segment.write(fraction(&segment, time), row);
            }
        }
        Ok(())
    })?;
    Ok(states.into_pyarray(py))
}

/// The step fraction at `time`, which may lie beyond the end of the segment by rounding.
pub fn fraction(segment: &DynamicDense<'_>, time: f64) -> f64 {
    ((time - segment.start()) / segment.size()).clamp(0.0, 1.0)
}
