//! The pieces of a half swing on which the spring gains on its limit. A stick phase can only end
//! there.
//!
//! On a half swing q = ±y > 0. The ratio R = q/L rises where W = L q̇ − L̇ q is positive and falls
//! where it is negative, and
//!
//! dW/dt = −q P with P = κL + L̈.
//!
//! P is positive at the end of contact, and changes its sign at known [turns](Trajectory::turns).
//! Therefore W is monotone on known pieces, and R is monotone between the zeros of W. Whether R
//! reaches 1 is decided by its values at the ends of these pieces; where it does, the root is the
//! only one in a known bracket.
//!
//! A phase after slip starts with R = 1 and W = 0, where P is positive. As long as it is, R falls
//! from there: on the first half swing the spring cannot reach its limit again on the side where
//! the phase started. Every other half swing starts with q = 0 and W > 0. There P may be negative
//! at first: W then rises before it falls, which changes nothing.

use std::f64::consts::PI;

use stickslip_contact::numerics::root::Jet;

use super::moment::{At, Moment, Motion};
use super::normal::Trajectory;
use super::normal::{along_root, root_between};
use super::swing::{Gap, Swing, half_swing_sign};

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
    /// After the top R falls and rises once more.
    again: Option<Again>,
    /// On which side of the turns the only top is.
    side: Side,
}

/// The side of the turns on which the only top of R on a half swing is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Side {
    /// Before the first turn, where W is negative.
    Before,
    /// After the second turn, as W is positive at the first one.
    After,
    /// No turn that would decide is on the half swing, which ends at this moment.
    Either(Moment),
}

/// The place where R starts to rise on a half swing.
enum Low {
    /// The moment at which the spring passes 0.
    Zero(Moment),
    /// On the first half swing, somewhere between the two turns.
    Between(Moment, Moment),
}

/// The second time that R rises on a half swing.
struct Again {
    /// R has its minimum between these places.
    bottom: [Moment; 2],
    /// R has its second top between these places; if there are none, it rises to infinity at the
    /// end of contact.
    top: Option<[Moment; 2]>,
}

impl Flanks {
    /// The pieces of half swing `k`, if there are any.
    pub fn of<T: Trajectory>(swing: &Swing<T>, k: u32) -> Option<Self> {
        match (swing.turns, k) {
            (None, 0) => None,
            (None, _) => Self::with_one_top(swing, k),
            (Some(turns), 0) => Self::after_slip(swing, turns),
            (Some(turns), _) => Self::with_turns(swing, turns, k),
        }
    }

    /// Without turns, R rises to one top and falls.
    fn with_one_top<T: Trajectory>(swing: &Swing<T>, half_swing: u32) -> Option<Self> {
        let angle = |quarters: f64| swing.moment_at_angle(0.5 * PI * quarters);
        let past = 2.0 * f64::from(half_swing);
        let (start, peak, zero) = (angle(past - 2.0), angle(past - 1.0), angle(past));
        if start == Moment::END {
            return None;
        }
        let rises = || swing.gap(half_swing, &swing.path.at(peak)).turning() > 0.0;
        let turn = if peak == Moment::END || rises() { [peak, zero] } else { [start, peak] };
        let turn = (turn[1] != Moment::END).then_some(turn);
        let (low, side) = (Low::Zero(start), Side::Either(zero));
        Some(Self { half_swing, low, turn, again: None, side })
    }

    /// The first half swing after slip, with turns. W falls from 0 until the first turn, rises
    /// until the second, and falls again. R can only come back to 1 if W is positive at the second
    /// turn.
    fn after_slip<T: Trajectory>(swing: &Swing<T>, [rise, fall]: [Moment; 2]) -> Option<Self> {
        let zero = swing.moment_at_angle(0.0);
        let may_rise = !rise.is_before(swing.start.moment) && fall.is_before(zero);
        if !(may_rise && turning_at(swing, 0, fall) > 0.0) {
            return None;
        }
        let turn = (zero != Moment::END).then_some([fall, zero]);
        // There never is a top before the turns, so that its name is free.
        let (low, side) = (Low::Between(rise, fall), Side::Before);
        Some(Self { half_swing: 0, low, turn, again: None, side })
    }

    /// A later half swing, with turns. W is positive at its start, smallest at the first turn,
    /// largest at the second, and falls again. It is negative at the end of the half swing, or
    /// positive at the end of contact, where R → ∞.
    fn with_turns<T: Trajectory>(
        swing: &Swing<T>,
        [rise, fall]: [Moment; 2],
        half_swing: u32,
    ) -> Option<Self> {
        let start = swing.moment_at_angle(f64::from(half_swing - 1) * PI);
        if start == Moment::END {
            return None;
        }
        let zero = swing.moment_at_angle(f64::from(half_swing) * PI);
        let last = (zero != Moment::END).then_some(zero);
        let within = |turn: Moment| start.is_before(turn) && turn.is_before(zero);
        let low = Low::Zero(start);
        if !(within(rise) && turning_at(swing, half_swing, rise) < 0.0) {
            // W is positive up to the second turn, or, if the half swing ends before that, has the
            // zero somewhere on it.
            let turn = last.map(|zero| [if within(fall) { fall } else { start }, zero]);
            let side = if within(rise) { Side::After } else { Side::Either(zero) };
            return Some(Self { half_swing, low, turn, again: None, side });
        }
        let rises_again = !within(fall) || turning_at(swing, half_swing, fall) > 0.0;
        let again = match last {
            None => Some(Again { bottom: [rise, fall], top: None }),
            Some(zero) if within(fall) && rises_again => {
                Some(Again { bottom: [rise, fall], top: Some([fall, zero]) })
            }
            Some(_) => None,
        };
        Some(Self { half_swing, low, turn: Some([start, rise]), again, side: Side::Before })
    }

    /// The first top of R.
    pub fn top<T: Trajectory>(&self, swing: &Swing<T>) -> Option<Moment> {
        self.turn.map(|[low, high]| top(swing, self.half_swing, low, high, None))
    }

    /// Whether R rises twice.
    pub fn rises_again(&self) -> bool {
        self.again.is_some()
    }

    /// Whether the only top of R can be named as the top before the turns, and as the top after
    /// them. Where nothing decides, both names apply.
    pub fn called(&self) -> [bool; 2] {
        [self.side != Side::After, self.side != Side::Before]
    }

    /// Whether the only top of R is named as the top after the turns. Where nothing else decides,
    /// the place where the turns meet divides the two.
    pub fn is_after<T: Trajectory>(&self, swing: &Swing<T>) -> bool {
        let split = swing.path.split();
        match (self.side, &self.low) {
            (Side::After, _) => true,
            (Side::Either(zero), Low::Zero(start)) => {
                start.is_before(split)
                    && split.is_before(zero)
                    && turning_at(swing, self.half_swing, split) > 0.0
            }
            _ => false,
        }
    }

    /// The second top of R.
    pub fn second_top<T: Trajectory>(&self, swing: &Swing<T>) -> Option<Moment> {
        let [low, high] = self.again.as_ref()?.top?;
        Some(top(swing, self.half_swing, low, high, None))
    }

    /// The moment at which D falls through 0, and whether that is after the top. If there are two
    /// such moments, `after_top` says which one is wanted.
    pub fn exit<T: Trajectory>(&self, swing: &Swing<T>, after_top: bool) -> Option<(Moment, bool)> {
        let k = self.half_swing;
        let after = || {
            let &Again { bottom: [rise, fall], top: turn } = self.again.as_ref()?;
            let below = |&low: &Moment| !exceeds_limit(swing, k, low);
            let low = Some(rise).filter(below);
            let low = low.or_else(|| Some(bottom(swing, k, rise, fall)).filter(below))?;
            let high = turn.map(|[low, high]| top(swing, k, low, high, None));
            let high = high.map_or(Some(Moment::END), |top| passed(swing, k, top))?;
            Some((exit(swing, k, low, high, None), true))
        };
        let before = || {
            let low = match self.low {
                Low::Between(rise, fall) if exceeds_limit(swing, k, fall) => {
                    return Some((first_exit(swing, rise, fall), false));
                }
                Low::Zero(low) | Low::Between(_, low) => low,
            };
            let high = self.top(swing).map_or(Some(Moment::END), |top| passed(swing, k, top))?;
            Some((exit(swing, k, low, high, None), false))
        };
        if after_top { after().or_else(before) } else { before().or_else(after) }
    }
}

/// The spring and its limit on half swing `k` at the first turn, if it is there.
pub fn at_first_turn<T: Trajectory>(swing: &Swing<T>, k: u32) -> Option<Gap> {
    gap_within(swing, k, swing.turns?[0])
}

/// The spring and its limit on half swing `k` where the turns meet, if that is there.
pub fn at_split<T: Trajectory>(swing: &Swing<T>, k: u32) -> Option<Gap> {
    gap_within(swing, k, swing.path.split())
}

/// The spring and its limit at `moment`, if it is on half swing `k`, which begins with y = 0.
fn gap_within<T: Trajectory>(swing: &Swing<T>, k: u32, moment: Moment) -> Option<Gap> {
    let before = k.checked_sub(1)?;
    let [start, zero] = [before, k].map(|k| swing.moment_at_angle(f64::from(k) * PI));
    let within = start.is_before(moment) && moment.is_before(zero);
    within.then(|| swing.gap(k, &swing.path.at(moment)))
}

/// W on half swing `k` at `moment`.
fn turning_at<T: Trajectory>(swing: &Swing<T>, k: u32, moment: Moment) -> f64 {
    swing.gap(k, &swing.path.at(moment)).turning()
}

/// The top of R, between `low`, where W > 0, and `high`, where W < 0.
pub fn top<T: Trajectory>(
    swing: &Swing<T>,
    k: u32,
    low: Moment,
    high: Moment,
    guess: Option<Moment>,
) -> Moment {
    root_between(swing.path, low, high, guess, |at| turning(swing, k, at))
}

/// The minimum of R, between `low`, where W < 0, and `high`, where W > 0.
fn bottom<T: Trajectory>(swing: &Swing<T>, k: u32, low: Moment, high: Moment) -> Moment {
    root_between(swing.path, low, high, None, |at| {
        let Jet { value, slope, curvature } = turning(swing, k, at);
        Jet { value: -value, slope: -slope, curvature: -curvature }
    })
}

/// W as a function of the root coordinate.
fn turning<T: Trajectory>(swing: &Swing<T>, k: u32, at: &At<T::Motion>) -> Jet {
    let gap = swing.gap(k, at);
    let pull = at.motion.pull(&swing.spring);
    along_root(swing.path, at, gap.turning(), -gap.q * pull, 0.0)
}

/// A moment at which R > 1 on the flank of half swing `k` that ends at its top, if there is one.
///
/// Just before the end of contact, where q and L vanish together, rounding hides their difference;
/// a top that is there is not known well either. R rises to it: what is above 1 a little earlier
/// stays so.
pub fn passed<T: Trajectory>(swing: &Swing<T>, k: u32, top: Moment) -> Option<Moment> {
    let at_top = swing.path.at(top);
    if swing.path.time_left(&at_top) * swing.spring.omega < hidden_angle(swing) {
        let earlier = before_end(swing);
        if exceeds_limit(swing, k, earlier) {
            return Some(earlier);
        }
    }
    (swing.gap(k, &at_top).value < 0.0).then_some(top)
}

/// The angle of the swing before the end of contact in which rounding may hide what vanishes there.
/// The angle itself is known to 1e-16 of its whole.
fn hidden_angle<T: Trajectory>(swing: &Swing<T>) -> f64 {
    4e-8 * (1.0 + swing.spring.omega * swing.path.contact_time()).sqrt()
}

/// The moment at which the hidden angle begins.
fn before_end<T: Trajectory>(swing: &Swing<T>) -> Moment {
    let duration = hidden_angle(swing) / swing.spring.omega;
    swing.path.before(&swing.path.at(Moment::END), duration, 0.0)
}

/// Whether R > 1 at `moment`.
pub fn exceeds_limit<T: Trajectory>(swing: &Swing<T>, k: u32, moment: Moment) -> bool {
    swing.gap(k, &swing.path.at(moment)).value < 0.0
}

/// The only zero of D on half swing `k` between `low`, where D > 0, and `high`, where D < 0.
pub fn exit<T: Trajectory>(
    swing: &Swing<T>,
    k: u32,
    mut low: Moment,
    mut high: Moment,
    mut guess: Option<Moment>,
) -> Moment {
    if high == Moment::END {
        let (y, _) = swing.motion(swing.path.time_left(&swing.start));
        // The exit of a spring that stands still at its last elongation.
        guess = swing.path.last_time_at(swing.spring.kappa * y.abs());
        if y.abs() < hidden_angle(swing) * swing.amplitude {
            // q vanishes at the end of contact as well, or nearly.
            let earlier = before_end(swing);
            let passed = exceeds_limit(swing, k, earlier);
            (low, high, guess) = if passed { (low, earlier, None) } else { (earlier, high, None) };
        }
    }
    let moment = root_between(swing.path, low, high, guess, |at| {
        let gap = swing.gap(k, at);
        along_root(swing.path, at, gap.value, gap.rate, gap.acceleration)
    });
    settled(swing, k, moment)
}

/// The zero `moment` of D, improved if D falls through 0 slowly. That is the case beside a graze,
/// where rounding in D has moved the zero.
fn settled<T: Trajectory>(swing: &Swing<T>, k: u32, moment: Moment) -> Moment {
    if !T::REFINES {
        return moment;
    }
    let gap = swing.gap(k, &swing.path.at(moment));
    if gap.rate.abs() < SLOW * gap.q_rate.abs() {
        swing.path.refined_exit(&swing.phase(), half_swing_sign(k), moment, gap.rate)
    } else {
        moment
    }
}

/// The zero of D on the first half swing between `rise`, where D ≥ 0, and `fall`, where D < 0.
///
/// D has a double zero at the start of the phase. Therefore the root of D/τ² is solved for. Its
/// value and its derivatives are all multiplied by τ, which changes no step towards the root.
fn first_exit<T: Trajectory>(swing: &Swing<T>, rise: Moment, fall: Moment) -> Moment {
    // D̈ falls through 0 at `rise`. If D̈ were linear, the phase would be three times as long as
    // the time until then.
    let path = swing.path;
    let guess = path.after(&swing.start, 3.0 * swing.elapsed(&path.at(rise)), f64::INFINITY);
    let moment = root_between(path, rise, fall, Some(guess), |at| {
        let gap = swing.gap(0, at);
        let tau = swing.elapsed(at);
        let scaled = gap.value / tau;
        let rate = (gap.rate - 2.0 * scaled) / tau;
        let acceleration = (gap.acceleration - (4.0 * gap.rate - 6.0 * scaled) / tau) / tau;
        along_root(path, at, scaled, rate, acceleration)
    });
    if swing.is_onset(0, &path.at(moment)) { moment } else { settled(swing, 0, moment) }
}
