//! The pieces of a half swing on which the spring gains on its limit. A stick phase can only end
//! there.
//!
//! On a half swing q = ±y > 0. The ratio R = q/L rises where W = L q̇ − L̇ q is positive and falls
//! where it is negative, and
//!
//! dW/dt = −q (κL + L̈).
//!
//! For κ ≥ 1.568… the bracket is positive. Otherwise it is negative between the two crests of
//! [`Slide`](super::slide::Slide) and positive outside. Therefore W is monotone on known pieces,
//! and R is monotone between the zeros of W. Whether R reaches 1 is decided by its values at the
//! ends of these pieces; where it does, the root is the only one in a known bracket.
//!
//! The phase starts with R = 1 and W = 0. As long as the bracket is positive, R falls from there:
//! on the first half swing the spring cannot reach its limit again on the side where the phase
//! started.

use std::f64::consts::PI;

use super::limit::pull;
use super::refined_exit::refined_exit;
use super::swing::{Swing, half_swing_sign};
use super::trajectory::{Half, MIDDLE_ROOT, Moment, NormalMotion};
use crate::numerics::root::{Jet, bracketed};

/// Ratio of dD/dt to dq/dt below which an exit is improved. At this ratio the rounding of the angle
/// √κ·τ, a few 1e-16, moves the exit by about 1e-14.
const SLOW: f64 = 0.05;

/// The pieces of one half swing of a stick phase on which R rises.
pub struct Flanks {
    half_swing: u32,
    /// The place where R starts to rise. There R is below 1 unless it is the start of the phase.
    low: Low,
    /// R has its top between these places; if there are none, it rises to infinity at the end of
    /// contact.
    turn: Option<[Moment; 2]>,
    /// After the top R falls, turns round once more between these places, and rises to infinity at
    /// the end of contact.
    again: Option<[Moment; 2]>,
}

/// The place where R starts to rise on a half swing.
enum Low {
    /// The moment at which the spring passes 0.
    Zero(Moment),
    /// On the first half swing, somewhere between the two zeros of κL + L̈.
    Between(Moment, Moment),
}

impl Flanks {
    /// The pieces of half swing `k`, if there are any. `crest` is the root coordinate of the two
    /// zeros of κL + L̈, if there are any.
    pub fn of(swing: &Swing, crest: Option<f64>, k: u32) -> Option<Self> {
        match (crest, k) {
            (None, 0) => None,
            (None, _) => Self::fast(swing, k),
            (Some(crest), 0) => Self::first(swing, crest),
            (Some(crest), 1) => Self::second(swing, crest),
            (Some(_), _) => None,
        }
    }

    /// For κ ≥ 1.568…, R rises to one top and falls.
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

    /// The first half swing for κ < 1.568…. W falls from 0 until the first crest, rises until the
    /// second, and falls again. R can only come back to 1 if W is positive at the second crest.
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

    /// The second half swing for κ < 1.568…. It lasts to the end of contact, where W → 0 from above
    /// and R → ∞. R can only have a top before the first crest.
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

    /// The top of R.
    pub fn top(&self, swing: &Swing) -> Option<Moment> {
        self.turn.map(|[low, high]| top(swing, self.half_swing, low, high))
    }

    /// The moment at which D falls through 0, and whether that is after the top. If there are two
    /// such moments, `after_top` says which one is wanted.
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

/// The top of R, between `low`, where W > 0, and `high`, where W < 0.
pub fn top(swing: &Swing, k: u32, low: Moment, high: Moment) -> Moment {
    root_between(low, high, None, |moment, normal| turning(swing, k, moment, normal))
}

/// The minimum of R, between `low`, where W < 0, and `high`, where W > 0.
fn bottom(swing: &Swing, k: u32, low: Moment, high: Moment) -> Moment {
    root_between(low, high, None, |moment, normal| {
        let Jet { value, slope, curvature } = turning(swing, k, moment, normal);
        Jet { value: -value, slope: -slope, curvature: -curvature }
    })
}

/// W as a function of the root coordinate.
fn turning(swing: &Swing, k: u32, moment: Moment, normal: NormalMotion) -> Jet {
    let gap = swing.gap(k, moment, normal);
    along_root(moment, gap.turning(), -gap.q * pull(swing.bend, normal.u), 0.0)
}

/// Whether R > 1 at `moment`.
pub fn exceeds_limit(swing: &Swing, k: u32, moment: Moment) -> bool {
    swing.gap(k, moment, NormalMotion::at(moment)).value < 0.0
}

/// The only zero of D on half swing `k` between `low`, where D > 0, and `high`, where D < 0.
pub fn exit(swing: &Swing, k: u32, low: Moment, high: Moment, guess: Option<Moment>) -> Moment {
    let guess = guess.or_else(|| (high == Moment::END).then(|| guess_before_end(swing)));
    let moment = root_between(low, high, guess, |moment, normal| {
        let gap = swing.gap(k, moment, normal);
        along_root(moment, gap.value, gap.rate, gap.acceleration)
    });
    settled(swing, k, moment)
}

/// The zero `moment` of D, improved if D falls through 0 slowly. That is the case beside a graze,
/// where rounding in D has moved the zero.
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
/// D has a double zero at the start of the phase. Therefore the root of D/τ² is solved for. Its
/// value and its derivatives are all multiplied by τ, which changes no step towards the root.
fn first_exit(swing: &Swing, rise: Moment, fall: Moment) -> Moment {
    // D̈ falls through 0 at `rise`. If D̈ were linear, the phase would be three times as long as the
    // time until then.
    let guess = swing.start.after(3.0 * swing.start.time_until(rise));
    let moment = root_between(rise, fall, Some(guess), |moment, normal| {
        let gap = swing.gap(0, moment, normal);
        let tau = swing.start.time_until(moment);
        let scaled = gap.value / tau;
        let rate = (gap.rate - 2.0 * scaled) / tau;
        let acceleration = (gap.acceleration - (4.0 * gap.rate - 6.0 * scaled) / tau) / tau;
        along_root(moment, scaled, rate, acceleration)
    });
    if swing.is_onset(0, moment) { moment } else { settled(swing, 0, moment) }
}

/// The exit of a spring that stands still at its last elongation, with the limit r³/κ.
fn guess_before_end(swing: &Swing) -> Moment {
    let (end, _) = swing.motion(swing.start.time_left());
    let root = (swing.kappa * end.abs()).cbrt().min(MIDDLE_ROOT);
    Moment { half: Half::Decompression, root }
}

/// The derivatives of a function in time as derivatives in the root coordinate.
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

/// The root between `low`, where f > 0, and `high`, where f < 0, which may be in different halves.
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
