//! The pieces of a half swing on which the spring gains on its limit, R = q/L rises: only there a stick phase can end.

use std::f64::consts::PI;

use super::release::{bottom, exceeds_limit, exit, first_exit, top};
use super::swing::Swing;
use super::trajectory::{Half, Moment, Point};

/// Where R rises on one half swing of a stick phase.
pub struct Flanks {
    half_swing: u32,
    /// Here R starts to rise, below 1 unless that is the start of the phase.
    low: Low,
    /// Where it turns round; without it, R rises to infinity at the end of contact.
    top: Option<Moment>,
    /// Where, after a top, it rises once more, to infinity at the end of contact.
    again: Option<Moment>,
}

/// Where R starts to rise on a half swing.
enum Low {
    /// Where the spring passes 0.
    Zero(Moment),
    /// On the first half swing, somewhere between the two zeros of κL + L̈.
    Between(Moment, Moment),
}

impl Flanks {
    /// Those of half swing `k`, if there are any; `crest` is the root coordinate of the two zeros of κL + L̈, if there are any.
    pub fn of(swing: &Swing, crest: Option<f64>, k: u32) -> Option<Self> {
        match (crest, k) {
            (None, 0) => None,
            (None, _) => Self::fast(swing, k),
            (Some(crest), 0) => Self::first(swing, crest),
            (Some(crest), 1) => Self::second(swing, crest),
            (Some(_), _) => None,
        }
    }

    /// κ ≥ 1.568…: R rises to one top and falls.
    fn fast(swing: &Swing, half_swing: u32) -> Option<Self> {
        let angle = |quarters: f64| swing.moment_at_angle(0.5 * PI * quarters);
        let past = 2.0 * f64::from(half_swing);
        let (start, peak, zero) = (angle(past - 2.0), angle(past - 1.0), angle(past));
        if start == Moment::END {
            return None;
        }
        let rises = || swing.gap(half_swing, peak, Point::at(peak)).turning() > 0.0;
        let (low, high) = if peak == Moment::END || rises() { (peak, zero) } else { (start, peak) };
        let top = (high != Moment::END).then(|| top(swing, half_swing, low, high));
        Some(Self { half_swing, low: Low::Zero(start), top, again: None })
    }

    /// κ < 1.568…, first half swing.
    fn first(swing: &Swing, crest: f64) -> Option<Self> {
        let [rise, fall] = crests(crest);
        let zero = swing.moment_at_angle(0.0);
        let may_rise = !rise.is_before(swing.start) && fall.is_before(zero);
        if !(may_rise && swing.gap(0, fall, Point::at(fall)).turning() > 0.0) {
            return None;
        }
        let top = (zero != Moment::END).then(|| top(swing, 0, fall, zero));
        Some(Self { half_swing: 0, low: Low::Between(rise, fall), top, again: None })
    }

    /// κ < 1.568…, second half swing, which lasts to the end of contact.
    fn second(swing: &Swing, crest: f64) -> Option<Self> {
        let [rise, fall] = crests(crest);
        let zero = swing.moment_at_angle(0.0);
        if zero == Moment::END {
            return None;
        }
        let turns = zero.is_before(rise) && swing.gap(1, rise, Point::at(rise)).turning() < 0.0;
        Some(Self {
            half_swing: 1,
            low: Low::Zero(zero),
            top: turns.then(|| top(swing, 1, zero, rise)),
            again: turns.then(|| bottom(swing, 1, rise, fall)),
        })
    }

    /// Where R turns round.
    pub fn top(&self) -> Option<Moment> {
        self.top
    }

    /// Where D falls through 0, and whether that is after the top. Where it may be before or after, `after_top` decides.
    pub fn exit(&self, swing: &Swing, after_top: bool) -> Option<(Moment, bool)> {
        let k = self.half_swing;
        let after = || {
            let low = self.again.filter(|&low| !exceeds_limit(swing, k, low))?;
            Some((exit(swing, k, low, Moment::END, None), true))
        };
        let before = || {
            let high = self.top.unwrap_or(Moment::END);
            if self.top.is_some() && !exceeds_limit(swing, k, high) {
                return None;
            }
            let moment = match self.low {
                Low::Between(rise, fall) if exceeds_limit(swing, k, fall) => {
                    first_exit(swing, rise, fall)
                }
                Low::Zero(low) | Low::Between(_, low) => exit(swing, k, low, high, None),
            };
            Some((moment, false))
        };
        if after_top { after().or_else(before) } else { before().or_else(after) }
    }
}

/// The zeros of κL + L̈ in the two halves of the contact.
fn crests(root: f64) -> [Moment; 2] {
    [Half::Compression, Half::Decompression].map(|half| Moment { half, root })
}
