//! Why a family has no run or no atlas.

use std::fmt;

use pyo3::prelude::*;
use stickslip_tracer::{TraceError, hybrid::FamilyError, regions::SubdivisionError};

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

/// The exception for an atlas or a stack that failed.
pub fn of_trace(py: Python<'_>, error: &TraceError<UserError>) -> PyErr {
    match error {
        TraceError::Option(_)
        | TraceError::Window { .. }
        | TraceError::Values
        | TraceError::Width(_)
        | TraceError::Subdivision(
            SubdivisionError::Window { .. }
            | SubdivisionError::Tolerance { .. }
            | SubdivisionError::Distances { .. }
            | SubdivisionError::Labels { .. },
        ) => bad_input(error),
        TraceError::Run { source, .. } => bad_input(source),
        TraceError::Layer { value, source } => with_value(py, of_trace(py, source), *value),
        _ => failed(error),
    }
}

/// The same exception, with a note of the third parameter.
pub fn with_value(py: Python<'_>, error: PyErr, value: f64) -> PyErr {
    let note = format!("with the third parameter {value:?}");
    // Without the note it is the same exception.
    let _ = error.value(py).call_method1("add_note", (note,));
    error
}
