//! The pieces of a half swing on which the spring gains on its limit: only there a stick phase can
//! end.
//!
//! On a half swing, on which q = ±y > 0, the ratio R = q/L rises or falls with the sign of
//! W = L q̇ − L̇ q, and
//!
//! dW/dt = −q (κL + L̈).
//!
//! The bracket is positive for κ ≥ 1.568…; otherwise it is negative between the two crests of
//! [`Slide`](super::slide::Slide) and positive outside. So W is monotone on known pieces and R
//! between the zeros of W: whether R reaches 1 is decided by its values at the ends of such
//! pieces, and where it does, the root is the only one in a known bracket.
//!
//! The phase starts with R = 1 and W = 0. As long as the bracket is positive R falls from there:
//! the side the phase comes from cannot be met again on the first half swing.

use std::f64::consts::PI;

use super::limit::pull;
use super::refined_exit::refined_exit;
use super::swing::{Swing, half_swing_sign};
use super::trajectory::{Half, MIDDLE_ROOT, Moment, NormalMotion};
use crate::numerics::root::{Jet, bracketed};

/// The ratio of dD/dt to dq/dt below which an exit is improved: at it rounding of the angle √κ·τ,
/// a few 1e-16, moves the exit by about 1e-14.
const SLOW: f64 = 0.05;

/// Where R rises on one half swing of a stick phase.
pub struct Flanks {
    half_swing: u32,
    /// Here R starts to rise, below 1 unless that is the start of the phase.
    low: Low,
    /// It turns round between these places, or rises to infinity at the end of contact.
    turn: Option<[Moment; 2]>,
    /// After that it falls, turns round once more between these places, and rises to infinity at
    /// the end of contact.
    again: Option<[Moment; 2]>,
}

/// Where R starts to rise on a half swing.
enum Low {
    /// Where the spring passes 0.
    Zero(Moment),
    /// On the first half swing, somewhere between the two zeros of κL + L̈.
    Between(Moment, Moment),
}

impl Flanks {
    /// Those of half swing `k`, if there are any; `crest` is the root coordinate of the two zeros
    /// of κL + L̈, if there are any.
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
        let rises = || swing.gap(half_swing, peak, NormalMotion::at(peak)).turning() > 0.0;
        let turn = if peak == Moment::END || rises() { [peak, zero] } else { [start, peak] };
        let turn = (turn[1] != Moment::END).then_some(turn);
        Some(Self { half_swing, low: Low::Zero(start), turn, again: None })
    }

    /// κ < 1.568…, first half swing: W falls from 0 up to the first crest, rises up to the second,
    /// then falls. R can come back to 1 only if W has become positive by the second.
    fn first(swing: &Swing, crest: f64) -> Option<Self> {
        let [rise, fall] = crests(crest);
        let zero = swing.moment_at_angle(0.0);
        let may_rise = !rise.is_before(swing.start) && fall.is_before(zero);
        if !(may_rise && swing.gap(0, fall, NormalMotion::at(fall)).turning() > 0.0) {
            return None;
        }
        let turn = (zero != Moment::END).then_some([fall, zero]);
        Some(Self { half_swing: 0, low: Low::Between(rise, fall), turn, again: None })
    }

    /// κ < 1.568…, second half swing, which lasts to the end of contact: there W → 0 from above and
    /// R → ∞. Only before the first crest R can have a top.
    fn second(swing: &Swing, crest: f64) -> Option<Self> {
        let [rise, fall] = crests(crest);
        let zero = swing.moment_at_angle(0.0);
        if zero == Moment::END {
            return None;
        }
        let turns =
            zero.is_before(rise) && swing.gap(1, rise, NormalMotion::at(rise)).turning() < 0.0;
        Some(Self {
            half_swing: 1,
            low: Low::Zero(zero),
            turn: turns.then_some([zero, rise]),
            again: turns.then_some([rise, fall]),
        })
    }

    /// Where R turns round.
    pub fn top(&self, swing: &Swing) -> Option<Moment> {
        self.turn.map(|[low, high]| top(swing, self.half_swing, low, high))
    }

    /// Where D falls through 0, and whether that is after the top. Where it may be before or after,
    /// `after_top` decides.
    pub fn exit(&self, swing: &Swing, after_top: bool) -> Option<(Moment, bool)> {
        let k = self.half_swing;
        let after = || {
            let [rise, fall] = self.again?;
            let below = |&low: &Moment| !exceeds_limit(swing, k, low);
            let low = Some(rise).filter(below);
            let low = low.or_else(|| Some(bottom(swing, k, rise, fall)).filter(below))?;
            Some((exit(swing, k, low, Moment::END, None), true))
        };
        let before = || {
            let low = match self.low {
                Low::Between(rise, fall) if exceeds_limit(swing, k, fall) => {
                    return Some((first_exit(swing, rise, fall), false));
                }
                Low::Zero(low) | Low::Between(_, low) => low,
            };
            let high = self.top(swing);
            let reached = high.is_none_or(|top| exceeds_limit(swing, k, top));
            reached.then(|| (exit(swing, k, low, high.unwrap_or(Moment::END), None), false))
        };
        if after_top { after().or_else(before) } else { before().or_else(after) }
    }
}

/// The zeros of κL + L̈ in the two halves of the contact.
fn crests(root: f64) -> [Moment; 2] {
    [Half::Compression, Half::Decompression].map(|half| Moment { half, root })
}

/// The top of R between `low`, where W > 0, and `high`, where W < 0.
pub fn top(swing: &Swing, k: u32, low: Moment, high: Moment) -> Moment {
    root_between(low, high, None, |moment, point| turning(swing, k, moment, point))
}

/// The lowest place of R between `low`, where W < 0, and `high`, where W > 0.
fn bottom(swing: &Swing, k: u32, low: Moment, high: Moment) -> Moment {
    root_between(low, high, None, |moment, point| {
        let Jet { value, slope, curvature } = turning(swing, k, moment, point);
        Jet { value: -value, slope: -slope, curvature: -curvature }
    })
}

/// W along the root coordinate.
fn turning(swing: &Swing, k: u32, moment: Moment, point: NormalMotion) -> Jet {
    let gap = swing.gap(k, moment, point);
    along_root(moment, gap.turning(), -gap.q * pull(swing.bend, point.u), 0.0)
}

/// Whether R > 1 at `moment`.
pub fn exceeds_limit(swing: &Swing, k: u32, moment: Moment) -> bool {
    swing.gap(k, moment, NormalMotion::at(moment)).value < 0.0
}

/// The one zero of D on half swing `k` between `low`, where D > 0, and `high`, where D < 0.
pub fn exit(swing: &Swing, k: u32, low: Moment, high: Moment, guess: Option<Moment>) -> Moment {
    let guess = guess.or_else(|| (high == Moment::END).then(|| guess_before_end(swing)));
    let moment = root_between(low, high, guess, |moment, point| {
        let gap = swing.gap(k, moment, point);
        along_root(moment, gap.value, gap.rate, gap.acceleration)
    });
    settled(swing, k, moment)
}

/// `moment`, a zero of D, improved where rounding in D has moved it: beside a graze, D falls
/// through 0 slowly.
fn settled(swing: &Swing, k: u32, moment: Moment) -> Moment {
    let gap = swing.gap(k, moment, NormalMotion::at(moment));
    if gap.rate.abs() < SLOW * gap.q_rate.abs() {
        refined_exit(swing, half_swing_sign(k), moment, gap.rate)
    } else {
        moment
    }
}

/// The zero of D on the first half swing between `rise`, where D ≥ 0, and `fall`, where D < 0.
///
/// D has a double zero at the start of the phase, so D/τ², here multiplied by a constant power
/// of τ, is solved instead.
fn first_exit(swing: &Swing, rise: Moment, fall: Moment) -> Moment {
    // D̈ falls through 0 at `rise`: were it straight, the phase would be three times as long.
    let guess = swing.start.after(3.0 * swing.start.time_until(rise));
    let moment = root_between(rise, fall, Some(guess), |moment, point| {
        let gap = swing.gap(0, moment, point);
        let tau = swing.start.time_until(moment);
        let scaled = gap.value / tau;
        let rate = (gap.rate - 2.0 * scaled) / tau;
        let acceleration = (gap.acceleration - (4.0 * gap.rate - 6.0 * scaled) / tau) / tau;
        along_root(moment, scaled, rate, acceleration)
    });
    if swing.is_onset(0, moment) { moment } else { settled(swing, 0, moment) }
}

/// The exit if the spring stood still at where it ends and the limit were r³/κ.
fn guess_before_end(swing: &Swing) -> Moment {
    let (end, _) = swing.motion(swing.start.time_left());
    let root = (swing.kappa * end.abs()).cbrt().min(MIDDLE_ROOT);
    Moment { half: Half::Decompression, root }
}

/// A function's derivatives in time as derivatives in the root coordinate.
fn along_root(moment: Moment, value: f64, rate: f64, acceleration: f64) -> Jet {
    let time_per_root = moment.time_per_root();
    // d²t/dr² = (dt/dr)/r
    let bend = if moment.half == Half::Compression { 2.0 } else { -2.0 };
    Jet {
        value,
        slope: rate * time_per_root,
        curvature: acceleration * time_per_root * time_per_root + rate * bend,
    }
}

/// The root between `low`, where f > 0, and `high`, where f < 0, in whichever half it lies.
fn root_between(
    mut low: Moment,
    mut high: Moment,
    guess: Option<Moment>,
    f: impl Fn(Moment, NormalMotion) -> Jet,
) -> Moment {
    if low.half != high.half {
        let middle = Moment { half: Half::Decompression, root: MIDDLE_ROOT };
        if f(middle, NormalMotion::at(middle)).value < 0.0 {
            high = Moment { half: Half::Compression, ..middle };
        } else {
            low = middle;
        }
    }
    let half = low.half;
    let guess = match guess {
        Some(moment) if moment.half == half => moment.root,
        _ => 0.5 * (low.root + high.root),
    };
    let root = bracketed(low.root, high.root, guess, |root| {
        let moment = Moment { half, root };
        f(moment, NormalMotion::at(moment))
    });
    Moment { half, root }
}
