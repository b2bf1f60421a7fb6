//! A Runge–Kutta pair as data.

/// Room for the stages of the largest method, including those of its dense output.
pub const MAX_STAGES: usize = 16;

/// Step fractions, besides 0 and 1, at which a step knows the state without further work.
///
/// They are nodes of Dormand–Prince 8(5,3). The stages there are of order 4, which means that their
/// errors are of fifth order in h.
pub const INTERIOR_NODES: [f64; 4] = [1.0 / 4.0, 1.0 / 3.0, 3.0 / 5.0, 6.0 / 7.0];

/// Coefficients of an embedded explicit Runge–Kutta pair with dense output.
///
/// Row `i` of `a` holds the weights of stage `i`. The rows from [`Method::STAGES`] on belong to the
/// dense output. The first of these is the derivative at the end of the step, so its row repeats
/// `b`.
#[derive(Debug)]
pub struct Tableau {
    /// The nodes c.
    pub c: [f64; MAX_STAGES],
    /// The weights of the stages.
    pub a: [[f64; MAX_STAGES]; MAX_STAGES],
    /// The weights of the solution that is propagated.
    pub b: [f64; MAX_STAGES],
    /// The weights of the error estimate that controls the step size.
    pub error: [f64; MAX_STAGES],
    /// The weights of a second, coarser estimate that makes the first one more reliable. All are
    /// zero if the pair has none.
    pub coarse_error: [f64; MAX_STAGES],
    /// The rows of the dense output beyond its cubic Hermite part, in units of h.
    pub dense: [[f64; MAX_STAGES]; 4],
}

/// An embedded pair: its coefficients and their properties. Other pairs than [`Dop853`] and
/// [`Dopri5`] can be added, explicit ones with up to [`MAX_STAGES`] stages and a dense output of
/// this form.
///
/// [`Dop853`]: crate::Dop853
/// [`Dopri5`]: crate::Dopri5
pub trait Method: Copy {
    /// The usual name of the pair.
    const NAME: &'static str;
    /// The order of the solution that is propagated.
    const ORDER: usize;
    /// The order that the step-size control assumes, one more than the order of the error estimate.
    const CONTROL_ORDER: usize;
    /// The number of stages of a step.
    const STAGES: usize;
    /// The number of stages with dense output, including the derivative at the end of the step.
    const DENSE_STAGES: usize;
    /// The degree of the dense output.
    const DENSE_DEGREE: usize;
    /// Whether the error estimate uses the derivative at the end of the step.
    const ERROR_USES_END: bool;
    /// The stages that lie at [`INTERIOR_NODES`]. `None` takes these states from the dense output.
    const INTERIOR_STAGES: Option<[usize; 4]>;
    /// The part of the next-to-last term that counts as error in the quick look at a guard.
    const QUICK_ERROR: f64;
    /// The exponent β of the proportional-integral step-size control.
    const CONTROL_BETA: f64;
    /// The smallest and the largest factor between the sizes of successive steps.
    const STEP_FACTORS: (f64, f64);
    /// The coefficients.
    const TABLEAU: Tableau;
}
