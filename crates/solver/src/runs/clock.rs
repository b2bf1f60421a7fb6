//! The independent variable of a run, and switches that accumulate in it.

use crate::options::Options;

/// The last step may be longer than it should by this part of itself.
const SLIGHTLY: f64 = 1e-3;
/// Rounding is asked only about phases that are shorter than this part of the run.
const BRIEF: f64 = 1e-6;

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

    /// The size of a step that should be `h`, and whether it is the last one before `end`. What
    /// would remain behind it within rounding belongs to it.
    pub(crate) fn step_towards(&self, end: f64, h: f64) -> (f64, bool) {
        let left = self.until(end);
        let rounding = || 4.0 * f64::EPSILON * self.s.abs().max(end.abs());
        let remains = left > h + h || left - h > rounding().min(SLIGHTLY * h);
        if remains { (h, false) } else { (left, true) }
    }

    /// The time that remains until `end`.
    pub(crate) fn until(&self, end: f64) -> f64 {
        (end - self.s) - self.rest
    }
}

/// Detects switches that accumulate, in time or at one instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Zeno {
    start: f64,
    /// The last gaps of positive length between switches, as a ring.
    gaps: [f64; 2 * Self::HALF],
    count: usize,
    /// How many of the last phases in a row hide how far the guards went in them.
    hidden: usize,
    /// The place of the last switch, and how many switches came there.
    instant: (f64, usize),
}

impl Zeno {
    /// The number of gaps in either half of those that are compared.
    const HALF: usize = 6;

    pub(crate) fn new(s: f64) -> Self {
        Self { start: s, gaps: [0.0; 2 * Self::HALF], count: 0, hidden: 0, instant: (s, 0) }
    }

    /// Counts a switch at `s`. Returns how many came there.
    pub(crate) fn count_at(&mut self, s: f64) -> usize {
        self.instant = if s == self.instant.0 { (s, self.instant.1 + 1) } else { (s, 1) };
        self.instant.1
    }

    /// How many more switches are allowed at the instant of the last one.
    pub(crate) fn left_at_instant(&self, options: &Options) -> usize {
        options.max_at_one_instant - self.instant.1.min(options.max_at_one_instant)
    }

    /// Whether a phase is short compared with the run up to `s`.
    pub(crate) fn is_brief(&self, phase: f64, s: f64) -> bool {
        phase <= BRIEF * (s - self.start)
    }

    /// Records a switch at `s` that ends a phase of length `phase`, in which rounding may hide how
    /// far the guard went. Returns the place where the switches accumulate, if they do, with its
    /// error.
    pub(crate) fn after_switch(
        &mut self,
        s: f64,
        (phase, hides): (f64, bool),
        options: &Options,
    ) -> Option<Accumulation> {
        if phase <= 0.0 || options.zeno == 0.0 {
            return None;
        }
        self.hidden = if hides { self.hidden + 1 } else { 0 };
        self.gaps[self.count % self.gaps.len()] = phase;
        self.count += 1;
        if self.hidden >= self.gaps.len() {
            // What rounding hides goes on as it did before.
            return Some(Accumulation { s, error: self.gaps.iter().sum() });
        }
        let (left, error) = self.left()?;
        let soon = left <= options.zeno * (s - self.start);
        soon.then_some(Accumulation { s: s + left, error: error + f64::EPSILON * s.abs() })
    }

    /// The place where brief phases accumulate that have become shorter and shorter until rounding
    /// hid them: the last switch was one of a chain at one instant `s`.
    pub(crate) fn behind_chain(&self, s: f64) -> Option<Accumulation> {
        let last = self.gaps[(self.count + self.gaps.len() - 1) % self.gaps.len()];
        let (left, error) = self.left().filter(|_| self.is_brief(last, s))?;
        Some(Accumulation { s: s + left, error: error + left })
    }

    /// The time that is left until the gaps end, extrapolated geometrically, with its error.
    fn left(&self) -> Option<(f64, f64)> {
        if self.count < self.gaps.len() {
            return None;
        }
        let sum = |first: usize, count: usize| -> f64 {
            (0..count).map(|i| self.gaps[(self.count + first + i) % self.gaps.len()]).sum()
        };
        let (half, quarter) = (Self::HALF, Self::HALF / 2);
        let (before, last) = (sum(0, half), sum(half, half));
        // Gaps that only follow a long rest are not shorter and shorter.
        let lately = sum(half + quarter, quarter) / sum(half, quarter);
        let ratios = [last / before, lately * lately];
        let [one, other] = ratios.map(|ratio| last * ratio / (1.0 - ratio));
        let ratio = ratios[0].max(ratios[1]);
        // Two extrapolations differ by as much as the ratio changes from gap to gap.
        (ratio < 1.0).then_some((last * ratio / (1.0 - ratio), (one - other).abs()))
    }
}

/// Where switches accumulate, extrapolated geometrically.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Accumulation {
    pub(crate) s: f64,
    pub(crate) error: f64,
}
