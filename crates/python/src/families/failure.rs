//! Why a family has no run or no atlas.

use std::fmt;

use pyo3::PyErr;
use stickslip_tracer::{AtlasError, FamilyError, SubdivisionError, TraceError};

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
