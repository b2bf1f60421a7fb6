//! Results that are beyond the range of doubles.

/// A result is beyond the range of doubles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{name} is not a finite number")]
pub struct NotFinite {
    /// The name of the result.
    pub name: &'static str,
}

impl NotFinite {
    /// Checks that all results, given with their names, are finite numbers.
    ///
    /// # Errors
    /// [`NotFinite`] names the first that is not.
    pub fn among(values: impl IntoIterator<Item = (&'static str, f64)>) -> Result<(), Self> {
        match values.into_iter().find(|(_, value)| !value.is_finite()) {
            Some((name, _)) => Err(Self { name }),
            None => Ok(()),
        }
    }
}
