//! The independent variable of a run, and switches that accumulate in it.

/// The independent variable with what rounding has cut off, so that many short steps add up.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clock {
    pub(crate) s: f64,
    rest: f64,
    /// Duration of the phase so far, accurate relative to itself.
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
        // Two-sum: exact whichever is larger.
        let added = sum - self.s;
        self.rest = (self.s - (sum - added)) + (step - added);
        self.s = sum;
    }

    /// The run has come to `end`, wherever rounding puts the sum of its steps.
    pub(crate) fn arrive(&mut self, end: f64) {
        (self.s, self.rest) = (end, 0.0);
    }

    pub(crate) fn until(&self, end: f64) -> f64 {
        (end - self.s) - self.rest
    }
}

/// Watches for switches that accumulate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Zeno {
    pub(crate) start: f64,
    phase: f64,
    shrinking: usize,
}

impl Zeno {
    /// Phases in a row that must have shrunk.
    const PHASES: usize = 12;

    pub(crate) fn new(s: f64) -> Self {
        Self { start: s, phase: f64::INFINITY, shrinking: 0 }
    }

    /// Takes note of a switch at `s` that ends a phase of length `phase`; the accumulation point,
    /// if there is one within `tolerance`.
    pub(crate) fn after_switch(&mut self, s: f64, phase: f64, tolerance: f64) -> Option<f64> {
        // A phase that does not move the time at all has no length.
        let phase = if phase <= f64::EPSILON * (s - self.start) { 0.0 } else { phase };
        let ratio = if phase == 0.0 { 0.0 } else { phase / self.phase };
        self.shrinking = if ratio < 1.0 { self.shrinking + 1 } else { 0 };
        self.phase = phase;
        let left = phase * ratio / (1.0 - ratio);
        (self.shrinking >= Self::PHASES && left <= tolerance * (s - self.start)).then_some(s + left)
    }
}
