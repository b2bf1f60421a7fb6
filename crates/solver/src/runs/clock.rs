//! The independent variable of a run, and switches that accumulate in it.

/// The independent variable as a sum with compensation, so that many short steps add up.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clock {
    pub(crate) s: f64,
    /// The part of the sum that rounding has cut off from `s`.
    rest: f64,
    /// The duration of the phase so far, with a relative error of rounding.
    pub(crate) phase: f64,
}

impl Clock {
    pub(crate) fn new(s: f64) -> Self {
        Self { s, rest: 0.0, phase: 0.0 }
    }

    pub(crate) fn advance(&mut self, h: f64) {
        self.phase += h;
        let step = h + self.rest;
        let sum = self.s + step;
        // Two-sum, which is exact whichever summand is larger.
        let added = sum - self.s;
        self.rest = (self.s - (sum - added)) + (step - added);
        self.s = sum;
    }

    /// Sets the clock to `end`, where the run has arrived, so that rounding of the sum does not
    /// matter.
    pub(crate) fn arrive(&mut self, end: f64) {
        (self.s, self.rest) = (end, 0.0);
    }

    /// The time that remains until `end`.
    pub(crate) fn until(&self, end: f64) -> f64 {
        (end - self.s) - self.rest
    }
}

/// Detects switches that accumulate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Zeno {
    pub(crate) start: f64,
    phase: f64,
    shrinking: usize,
}

impl Zeno {
    /// The number of successive phases that must have become shorter.
    const PHASES: usize = 12;

    pub(crate) fn new(s: f64) -> Self {
        Self { start: s, phase: f64::INFINITY, shrinking: 0 }
    }

    /// Records a switch at `s` that ends a phase of length `phase`. Returns the accumulation point
    /// if the switches accumulate and the remaining time is within `tolerance`.
    pub(crate) fn after_switch(&mut self, s: f64, phase: f64, tolerance: f64) -> Option<f64> {
        // A phase that does not move the time has length 0.
        let phase = if phase <= f64::EPSILON * (s - self.start) { 0.0 } else { phase };
        let ratio = if phase == 0.0 { 0.0 } else { phase / self.phase };
        self.shrinking = if ratio < 1.0 { self.shrinking + 1 } else { 0 };
        self.phase = phase;
        let left = phase * ratio / (1.0 - ratio);
        (self.shrinking >= Self::PHASES && left <= tolerance * (s - self.start)).then_some(s + left)
    }
}
