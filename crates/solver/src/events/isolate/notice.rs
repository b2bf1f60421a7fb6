//! What isolation notices besides crossings.

/// A local extremum whose distance from zero is within the error of the dense output, and its value
/// by a step of the method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Touch {
    pub(crate) theta: f64,
    pub(crate) margin: f64,
}

/// What isolation notices about a guard besides its crossings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Notice {
    /// It touches zero, or nearly.
    Touch(Touch),
    /// It changes its sign at a pole, at this step fraction.
    Pole(f64),
}
