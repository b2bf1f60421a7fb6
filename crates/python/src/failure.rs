//! Errors of the libraries as Python's exceptions.

use pyo3::create_exception;
use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use stickslip_model::exact::ExactError;
use stickslip_model::{CollisionError, CollisionFailure, InvalidValue};
use stickslip_plane::atlas::AtlasError;

create_exception!(
    stickslip,
    ComputationError,
    PyRuntimeError,
    "A collision, an atlas or a study has no result, though its parameters are in range."
);

/// The exception for bad input.
pub fn bad_input(error: impl ToString) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// The exception for a computation that failed.
pub fn failed(error: impl ToString) -> PyErr {
    ComputationError::new_err(error.to_string())
}

/// The reason why a contact has no result.
#[derive(Clone)]
pub struct Failure(pub CollisionError);

impl Failure {
    /// Whether a parameter is out of range, and nothing was computed.
    fn is_bad_input(&self) -> bool {
        matches!(
            self.0,
            CollisionError::Parameter(_)
                | CollisionError::Domain(_)
                | CollisionError::Exact(ExactError::Domain(_))
        )
    }

    /// The reason in words.
    pub fn message(&self) -> String {
        self.0.to_string()
    }

    /// The exception, whose message begins with the `place`.
    pub fn exception(&self, place: &str) -> PyErr {
        let message = format!("{place}{}", self.message());
        if self.is_bad_input() { bad_input(message) } else { failed(message) }
    }
}

impl From<CollisionError> for Failure {
    fn from(error: CollisionError) -> Self {
        Self(error)
    }
}

impl From<InvalidValue> for Failure {
    fn from(error: InvalidValue) -> Self {
        Self(error.into())
    }
}

/// The exception for a collision that cannot be computed.
pub fn of_collision(failure: CollisionFailure) -> PyErr {
    let CollisionFailure { kappa, psi, damping, source } = failure;
    let place = format!("kappa = {kappa:?}, psi = {psi:?}, damping = {damping:?}: ");
    Failure::from(source).exception(&place)
}

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> Self {
        failure.exception("")
    }
}

/// `error` with what was found before it as its attribute `partial`, if it is Ctrl-C.
pub fn keeping<'py>(
    py: Python<'py>,
    error: PyErr,
    partial: impl FnOnce() -> PyResult<Bound<'py, PyAny>>,
) -> PyErr {
    if error.is_instance_of::<PyKeyboardInterrupt>(py) {
        // Without its attribute it is still Ctrl-C.
        let _ = partial().and_then(|partial| error.value(py).setattr("partial", partial));
    }
    error
}

/// The exception for a window without atlas.
pub fn of_atlas(error: &AtlasError) -> PyErr {
    match error {
        AtlasError::Parameter(_)
        | AtlasError::Unverifiable(_)
        | AtlasError::Tolerance { .. }
        | AtlasError::Dampings { .. } => bad_input(error),
        AtlasError::Layer { source, .. } => of_atlas(source),
        _ => failed(error),
    }
}
