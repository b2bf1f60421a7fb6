//! Options of a run.

use stickslip_number::InvalidValue;

/// How the step size is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepSize {
    /// The embedded error estimate chooses the size, so that each step's error is below
    /// `atol + rtol·|y|`.
    Adaptive,
    /// All steps have this size, except shorter ones at switches and at the end. This is for
    /// convergence studies.
    Fixed(f64),
}

/// Options of a run. [`Options::validate`] checks them when the run starts. Later versions may have
/// more of them, so write `..Options::default()`.
///
/// ```
/// use stickslip_solver::Options;
///
/// let options = Options { max_step: 0.1, ..Options::with_tolerance(1e-9) };
/// assert!(options.validate().is_ok());
/// assert!(Options { rtol: f64::NAN, ..options }.validate().is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Relative tolerance of a step, from 1e-15 to 1e-1.
    pub rtol: f64,
    /// Absolute tolerance of a step, finite and above 0.
    pub atol: f64,
    /// How the step size is chosen.
    pub step_size: StepSize,
    /// The size of the first step. `None` lets the run estimate it.
    pub first_step: Option<f64>,
    /// The longest step allowed.
    pub max_step: f64,
    /// The run stops after this many accepted or rejected steps.
    pub max_steps: usize,
    /// The run stops after this many switches.
    pub max_switches: usize,
    /// The run fails after this many successive transitions at one instant, at least 1.
    pub max_at_one_instant: usize,
    /// The bound for a Zeno accumulation, or 0 if switches are never said to accumulate.
    ///
    /// If the last six gaps between switches are together shorter than the six before, the time
    /// that the sequence still takes is extrapolated geometrically. The switches accumulate if it
    /// falls below this part of the time that has passed. Gaps without length do not count, nor do
    /// switches that change nothing.
    pub zeno: f64,
    /// The shortest time on which a guard of a black box changes, or `None` if guards change on the
    /// scale of the solution. On longer steps such guards are expanded in pieces of this length.
    /// Guards of a [readable system](crate::ReadableSystem) need no scale.
    pub guard_scale: Option<f64>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            rtol: 1e-10,
            atol: 1e-12,
            step_size: StepSize::Adaptive,
            first_step: None,
            max_step: f64::INFINITY,
            max_steps: 10_000_000,
            max_switches: 10_000_000,
            max_at_one_instant: 1000,
            zeno: 1e-13,
            guard_scale: None,
        }
    }
}

impl Options {
    /// The default options with `tolerance` for both the relative and the absolute tolerance.
    #[must_use]
    pub fn with_tolerance(tolerance: f64) -> Self {
        Self { rtol: tolerance, atol: tolerance, ..Self::default() }
    }

    /// The shortest time on which a guard of a black box may change, infinite if it is not known.
    pub(crate) fn scale_of_guards(&self) -> f64 {
        self.guard_scale.unwrap_or(f64::INFINITY)
    }

    /// Checks every field.
    ///
    /// # Errors
    /// [`InvalidValue`] names the first field that is out of its range.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        let positive = |value: f64| value > 0.0 && value.is_finite();
        InvalidValue::check("rtol", self.rtol, "1e-15 to 0.1", (1e-15..=0.1).contains(&self.rtol))?;
        InvalidValue::check("atol", self.atol, "a finite number above 0", positive(self.atol))?;
        InvalidValue::check("max_step", self.max_step, "a number above 0", self.max_step > 0.0)?;
        InvalidValue::check("zeno", self.zeno, "0 to 0.1", (0.0..=0.1).contains(&self.zeno))?;
        let instant = self.max_at_one_instant;
        InvalidValue::check("max_at_one_instant", instant, "at least 1", instant > 0)?;
        if let Some(scale) = self.guard_scale {
            InvalidValue::check("guard_scale", scale, "a finite number above 0", positive(scale))?;
        }
        if let Some(h) = self.first_step {
            InvalidValue::check("first_step", h, "a finite number above 0", positive(h))?;
        }
        if let StepSize::Fixed(h) = self.step_size {
            InvalidValue::check("fixed step", h, "a finite number above 0", positive(h))?;
        }
        Ok(())
    }
}
