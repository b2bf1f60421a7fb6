//! A Runge–Kutta pair as data.

/// Room for the stages of the largest method, its dense output included.
pub const MAX_STAGES: usize = 16;

/// Step fractions, beside 0 and 1, at which a step knows the state without further work.
///
/// They are nodes of Dormand–Prince 8(5,3) whose stages are of order 4: their errors are of fifth
/// order in h.
pub const INTERIOR_NODES: [f64; 4] = [1.0 / 4.0, 1.0 / 3.0, 3.0 / 5.0, 6.0 / 7.0];

/// Coefficients of an embedded explicit Runge–Kutta pair with a continuous extension.
///
/// Row `i` of `a` holds the weights of stage `i`; rows from `stages` on belong to the dense output,
/// the first of them being the derivative at the end of the step (so its row repeats `b`).
#[derive(Debug)]
pub struct Tableau {
    /// Nodes c.
    pub c: [f64; MAX_STAGES],
    /// Stage weights.
    pub a: [[f64; MAX_STAGES]; MAX_STAGES],
    /// Weights of the solution that is propagated.
    pub b: [f64; MAX_STAGES],
    /// Weights of the error estimate that controls the step.
    pub error: [f64; MAX_STAGES],
    /// Weights of a second, coarser estimate that steadies the first; all zero where there is
    /// none.
    pub coarse_error: [f64; MAX_STAGES],
    /// Rows of the dense output beyond its cubic Hermite part, in units of h.
    pub dense: [[f64; MAX_STAGES]; 4],
}

/// An embedded pair: its coefficients and what they are good for.
pub trait Method: Copy {
    /// The name under which the pair is known.
    const NAME: &'static str;
    /// Order of the solution that is propagated.
    const ORDER: usize;
    /// Order on which the step-size control counts, one more than the error estimate's.
    const CONTROL_ORDER: usize;
    /// Stages of a step.
    const STAGES: usize;
    /// Stages once the dense output is included, the derivative at the step's end among them.
    const DENSE_STAGES: usize;
    /// Degree of the dense output.
    const DENSE_DEGREE: usize;
    /// Whether the error estimate uses the derivative at the end of the step.
    const ERROR_USES_END: bool;
    /// Stages that sit at [`INTERIOR_NODES`]; `None` takes these states from the dense output.
    const INTERIOR_STAGES: Option<[usize; 4]>;
    /// The part of the next-to-last term of a quick guard expansion that counts as its error.
    const QUICK_ERROR: f64;
    /// Proportional-integral exponent β of the step-size control.
    const CONTROL_BETA: f64;
    /// Least and largest factor by which a step may change.
    const STEP_FACTORS: (f64, f64);
    /// The coefficients.
    const TABLEAU: Tableau;
}
