//! The independent variable of a run, and switches that accumulate in it.
//!
//! Phases that become shorter and shorter accumulate; so do phases in which rounding hides how far
//! a guard goes. A ball above a floor at −1, for example, bounces for ever with heights of the last
//! digit. Twelve such phases in a row are an accumulation, each shorter than 1e-4 of the run; six
//! are, if the phases before became shorter and shorter. So are six transitions of one guard at one
//! instant behind such phases, and twelve behind any short phase. What is hidden gives no data: the
//! place is extrapolated from the phases that rounding shows.

use crate::options::Options;

/// The last step may be longer than it should by this part of itself.
const SLIGHTLY: f64 = 1e-3;
/// Only phases that are shorter than this part of the run are checked for rounding.
const BRIEF: f64 = 1e-4;

/// The independent variable as a sum with compensation, so that many short steps add up.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clock {
    pub(crate) s: f64,
    /// The part of the sum that rounding has cut off from `s`.
    rest: f64,
    /// The duration of the phase so far, with a relative error of rounding.
    pub(crate) phase: f64,
    start: f64,
}

impl Clock {
    pub(crate) fn new(s: f64) -> Self {
        Self { s, rest: 0.0, phase: 0.0, start: s }
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

    /// By how much rounding may have moved the time at which something happens: the rounding of the
    /// time, and of the state since the start of the run. The state carries the rounding of all its
    /// steps into the next phase. A clock knows its time exactly, so a guard that vanishes with it
    /// may lie a few roundings of the whole run beside it.
    pub(crate) fn drift(&self) -> f64 {
        f64::EPSILON * (4.0 * (self.s - self.start) + self.s.abs())
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
        let remains = left > h + h || left - h > self.rounding(end).min(SLIGHTLY * h);
        if remains { (h, false) } else { (left, true) }
    }

    /// The rounding of times between here and `end`, which is near.
    pub(crate) fn rounding(&self, end: f64) -> f64 {
        4.0 * f64::EPSILON * self.s.abs().max(end.abs())
    }

    /// Whether nothing but rounding remains until `end`.
    pub(crate) fn is_at(&self, end: f64) -> bool {
        end.is_finite() && self.until(end) <= self.rounding(end)
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
    /// The last phases, as a ring, except phases that hide how far the guards went.
    gaps: [f64; 2 * Self::HALF],
    count: usize,
    /// The place where the last of them ended.
    shown: f64,
    /// How many phases since then hide how far the guards went in them, and how long they are.
    hidden: (usize, f64),
    /// The place of the last switch, and how many switches came there.
    instant: (f64, usize),
    /// The guard of the last switch, and how many switches at that place it has had in a row.
    alone: (usize, usize),
}

impl Zeno {
    /// The number of gaps in either half of those that are compared.
    const HALF: usize = 6;
    /// The number of gaps that are compared where there are fewer.
    const FEW: usize = 4;

    pub(crate) fn new(s: f64) -> Self {
        Self {
            start: s,
            gaps: [0.0; 2 * Self::HALF],
            count: 0,
            shown: s,
            hidden: (0, 0.0),
            instant: (s, 0),
            alone: (0, 0),
        }
    }

    /// Counts a switch of `guard` at `s`. Returns how many came there.
    pub(crate) fn count_at(&mut self, s: f64, guard: usize) -> usize {
        let here = s == self.instant.0;
        self.instant = (s, if here { self.instant.1 + 1 } else { 1 });
        let again = here && guard == self.alone.0;
        self.alone = (guard, if again { self.alone.1 + 1 } else { 1 });
        self.instant.1
    }

    /// How many switches at the place of the last one its guard has had in a row.
    pub(crate) fn alone(&self) -> usize {
        self.alone.1
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
        if hides {
            self.hidden = (self.hidden.0 + 1, self.hidden.1 + phase);
            let goes_on = (self.hidden.0 >= Self::HALF).then(|| self.behind_hidden(s)).flatten();
            // Without a rule, what rounding hides goes on as it did before.
            let stays = Accumulation { s, error: self.hidden.1 };
            return goes_on.or((self.hidden.0 >= self.gaps.len()).then_some(stays));
        }
        (self.shown, self.hidden) = (s, (0, 0.0));
        self.gaps[self.count % self.gaps.len()] = phase;
        self.count += 1;
        let (left, error) = self.left(self.gaps.len())?;
        let soon = left <= options.zeno * (s - self.start);
        soon.then_some(Accumulation { s: s + left, error: error + f64::EPSILON * s.abs() })
    }

    /// The place where switches accumulate whose phases have become shorter and shorter until
    /// rounding hid them, where the last switch was one of a chain at one instant `s`.
    pub(crate) fn behind_chain(&self, s: f64) -> Option<Accumulation> {
        let goes_on = (self.alone.1 >= Self::HALF).then(|| self.behind_hidden(s)).flatten();
        let last = self.last();
        let stays = self.alone.1 >= self.gaps.len() && self.count > 0 && self.is_brief(last, s);
        goes_on.or(stays.then_some(Accumulation { s, error: last }))
    }

    /// The last phase that rounding shows.
    fn last(&self) -> f64 {
        self.gaps[(self.count + self.gaps.len() - 1) % self.gaps.len()]
    }

    /// The place where brief phases accumulate that rounding does not show any more at `s`.
    fn behind_hidden(&self, s: f64) -> Option<Accumulation> {
        // The first phase was another one.
        let few = if self.count > Self::FEW { Self::FEW } else { 2 };
        let count = if self.count >= self.gaps.len() { self.gaps.len() } else { few };
        let (left, error) = self.left(count).filter(|_| self.is_brief(self.last(), s))?;
        let found = s.max(self.shown + left);
        Some(Accumulation { s: found, error: error + left + (found - self.shown - left) })
    }

    /// The time that is left until the gaps end, extrapolated geometrically from the last
    /// `count`, with its error.
    fn left(&self, count: usize) -> Option<(f64, f64)> {
        if self.count < count || self.count <= 2 {
            return None;
        }
        let (begin, length) = (self.count + self.gaps.len() - count, self.gaps.len());
        let sum = |first: usize, count: usize| -> f64 {
            (0..count).map(|i| self.gaps[(begin + first + i) % length]).sum()
        };
        let half = count / 2;
        let quarter = half.div_ceil(2);
        let (before, last) = (sum(0, half), sum(half, half));
        // Gaps that only follow a long rest are not shorter and shorter.
        let lately = sum(half + quarter, quarter) / sum(half, quarter);
        let ratios = [last / before, lately * lately];
        let [one, other] = ratios.map(|ratio| last * ratio / (1.0 - ratio));
        let ratio = ratios[0].max(ratios[1]);
        // The difference between two extrapolations shows how much the ratio changes from gap to
        // gap.
        (ratio < 1.0).then_some((last * ratio / (1.0 - ratio), (one - other).abs()))
    }
}

/// Where switches accumulate, extrapolated geometrically.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Accumulation {
    pub(crate) s: f64,
    pub(crate) error: f64,
}
