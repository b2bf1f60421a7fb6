//! Why a family has no run or no atlas.

use std::fmt;

use pyo3::prelude::*;
use stickslip_tracer::{AtlasError, FamilyError, StackError, SubdivisionError, TraceError};

use crate::failure::{bad_input, failed};

/// Why a run of a user's family does not exist.
#[derive(Clone, Debug, PartialEq)]
pub enum UserError {
    /// It cannot begin.
    Family(FamilyError),
    /// A function of Python has failed, and its exception is kept.
    Function,
}

impl fmt::Display for UserError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Family(error) => error.fmt(formatter),
            Self::Function => formatter.write_str("a function has failed"),
        }
    }
}

impl std::error::Error for UserError {}

/// The exception for a trace that failed.
pub fn of_trace(error: &TraceError<UserError>) -> PyErr {
    match error {
        TraceError::Option(_) | TraceError::Window { .. } => bad_input(error),
        TraceError::Run { source, .. } => bad_input(source),
        TraceError::TooManyCurves { .. } | TraceError::NotANumber { .. } => failed(error),
    }
}

/// The exception for an atlas that failed.
pub fn of_atlas(error: &AtlasError<UserError>) -> PyErr {
    match error {
        AtlasError::Trace(error) => of_trace(error),
        AtlasError::Verify(_)
        | AtlasError::Subdivision(
            SubdivisionError::Window { .. } | SubdivisionError::Tolerance { .. },
        ) => bad_input(error),
        AtlasError::Subdivision(_) => failed(error),
    }
}

/// The exception for a stack that failed.
pub fn of_stack(py: Python<'_>, error: &StackError<UserError>) -> PyErr {
    match error {
        StackError::Values | StackError::Width(_) => bad_input(error),
        StackError::Atlas { value, source } => with_value(py, of_atlas(source), *value),
    }
}

/// The same exception, with a note of the third parameter.
pub fn with_value(py: Python<'_>, error: PyErr, value: f64) -> PyErr {
    let note = format!("with the third parameter {value:?}");
    // Without the note it is the same exception.
    let _ = error.value(py).call_method1("add_note", (note,));
    error
}
