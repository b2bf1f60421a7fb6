//! Why a system cannot run.

use thiserror::Error;

/// Why a system cannot run with some parameters.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum InvalidParameters {
    /// There are more or fewer than the system has.
    #[error("there are {found} parameters; expected {expected}: {names}")]
    Count {
        /// How many there are.
        found: usize,
        /// How many the system has.
        expected: usize,
        /// Their names.
        names: String,
    },
    /// A parameter is not a number.
    #[error("{name} = {value}; expected a finite number")]
    NotFinite {
        /// The name of the parameter.
        name: String,
        /// Its value.
        value: f64,
    },
    /// In a plane of parameters, runs would start in several modes.
    #[error("the first mode depends on {name}; expected a parameter that leaves it as it is")]
    FirstMode {
        /// The name of the parameter.
        name: String,
    },
    /// What parameters make is not a number.
    #[error("{what} is {value}; expected {expected}")]
    Value {
        /// What is computed from them.
        what: String,
        /// Its value.
        value: f64,
        /// What it must be.
        expected: &'static str,
    },
}
