//! Whether states and derivatives are finite.

use crate::error::RunError;

pub(crate) fn is_finite(y: &[f64]) -> bool {
    y.iter().all(|value| value.is_finite())
}

/// Checks the state `y` at `s`.
pub(crate) fn check_finite(s: f64, y: &[f64]) -> Result<(), RunError> {
    let component = y.iter().position(|value| !value.is_finite());
    component.map_or(Ok(()), |component| Err(RunError::State { s, component }))
}
