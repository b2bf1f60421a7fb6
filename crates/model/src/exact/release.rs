//! The end of a stick phase: where the spring reaches its limit again.
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

use std::f64::consts::{FRAC_PI_2, PI};

use super::precise::refined_exit;
use super::root::{Jet, bracketed};
use super::slide::pull;
use super::swing::{Swing, half_swing_sign};
use super::trajectory::{Half, LARGEST_U, MIDDLE_ROOT, Moment, Point, speed_at};

/// The ratio of dD/dt to dq/dt below which an exit is improved: at it rounding of the angle √κ·τ,
/// a few 1e-16, moves the exit by about 1e-14.
const SLOW: f64 = 0.05;

/// Where a stick phase ends.
#[derive(Clone, Copy, Debug)]
pub struct Release {
    /// When.
    pub moment: Moment,
    /// Number of the half swing, the phase starting on number 0: an even one ends on the side on
    /// which the phase started.
    pub half_swing: u32,
    /// The normal motion there.
    pub point: Point,
    /// Velocity w, in the orientation of the phase.
    pub velocity: f64,
    /// Sign changes of the velocity during the phase.
    pub reversals: usize,
}

impl Release {
    /// The end of `swing`. It comes before the end of contact, where the limit is 0.
    ///
    /// `crest` is the root coordinate of the two zeros of κL + L̈, if there are any.
    pub fn of(swing: &Swing, crest: Option<f64>) -> Self {
        let (moment, half_swing) = match crest {
            Some(crest) => slow_release(swing, crest),
            None => fast_release(swing),
        };
        let (_, velocity) = swing.motion(swing.start.time_until(moment));
        // w vanishes at the peak of each half swing. The peak of the first comes after the start
        // if w > 0 there; the peak of the last comes before the end if q falls there.
        let peaks =
            half_swing as usize + usize::from(half_swing_sign(half_swing) * velocity <= 0.0);
        let before_start = usize::from(swing.velocity.0 <= 0.0);
        Self {
            moment,
            half_swing,
            point: Point::at(moment),
            velocity,
            reversals: peaks.saturating_sub(before_start),
        }
    }
}

/// κ ≥ 1.568…: on each half swing R rises to one top and falls, on the first it only falls.
fn fast_release(swing: &Swing) -> (Moment, u32) {
    let calm = Calm::of(swing);
    let (mut from, mut k) = calm.skip(swing, swing.moment_at_angle(0.0), 1);
    loop {
        let peak = swing.moment_at_angle((f64::from(k) - 0.5) * PI);
        if peak == Moment::END {
            // q > 0 = L at the end of contact: R rises to infinity.
            return (exit(swing, k, from, Moment::END, None), k);
        }
        let gap = swing.gap(k, peak, Point::at(peak));
        if gap.value < 0.0 {
            // The zero of D's Taylor polynomial back from the peak.
            let (excess, slope) = (-gap.value, gap.rate.abs());
            let bent = (slope * slope + 2.0 * gap.acceleration.max(0.0) * excess).sqrt();
            let guess = peak.before(2.0 * excess / (slope + bent));
            return (exit(swing, k, from, peak, Some(guess)), k);
        }
        let zero = swing.moment_at_angle(f64::from(k) * PI);
        let (low, high) = if gap.turning() > 0.0 { (peak, zero) } else { (from, peak) };
        if high == Moment::END {
            return (exit(swing, k, low, high, None), k);
        }
        let top = top(swing, k, low, high);
        if exceeds_limit(swing, k, top) {
            return (exit(swing, k, low, top, None), k);
        }
        (from, k) = calm.skip(swing, zero, k + 1);
    }
}

/// The time during which L > A ≥ |y|: the spring cannot reach its limit, however often it swings.
struct Calm {
    /// √x at its end.
    u: f64,
    /// The start and the end, if there are any.
    ends: Option<(Moment, Moment)>,
}

impl Calm {
    fn of(swing: &Swing) -> Self {
        // The moments of L = A are known to 1e-8 only: take them for a slightly larger A.
        let u = (swing.kappa * swing.amplitude * (1.0 + 1e-7)).cbrt();
        let ends = (u < LARGEST_U).then(|| {
            let end = Moment::near_compression(Half::Decompression, u);
            (Moment { half: Half::Compression, ..end }, end)
        });
        Self { u, ends }
    }

    /// The first half swing on which the spring can reach its limit, and a moment on it before
    /// that, if it has not by `zero`, where half swing `k` starts.
    ///
    /// After a calm that is the half swing on which the calm ends, if R still rises then, or
    /// else the next.
    fn skip(&self, swing: &Swing, zero: Moment, k: u32) -> (Moment, u32) {
        let Some((start, end)) = self.ends else { return (zero, k) };
        if zero.is_before(start) || !zero.is_before(end) {
            return (zero, k);
        }
        let angle = swing.omega * swing.start.time_until(end) - swing.first_zero + FRAC_PI_2;
        // The last half swing whose peak is past.
        let last = whole(angle / PI);
        let (sin, cos) = (angle - f64::from(last) * PI).sin_cos();
        // W > 0 for q = A cos and L = A.
        let limit_falls = swing.bend * self.u * speed_at(self.u);
        if last >= k && cos > 0.0 && limit_falls * cos > swing.omega * swing.amplitude * sin {
            return (end, last);
        }
        let next = swing.moment_at_angle(f64::from(last) * PI);
        (if end.is_before(next) { next } else { end }, last + 1)
    }
}

/// κ < 1.568…: the contact is shorter than 1.3 half swings, but κL + L̈ changes sign.
fn slow_release(swing: &Swing, crest: f64) -> (Moment, u32) {
    let rise = Moment { half: Half::Compression, root: crest };
    let fall = Moment { half: Half::Decompression, root: crest };
    let zero = swing.moment_at_angle(0.0);
    // On the first half swing W falls from 0 until `rise`, rises until `fall`, then falls; R can
    // come back to 1 only if W has become positive by `fall`.
    if !rise.is_before(swing.start) && fall.is_before(zero) {
        let gap = swing.gap(0, fall, Point::at(fall));
        if gap.turning() > 0.0 {
            if gap.value < 0.0 {
                return (first_exit(swing, rise, fall), 0);
            }
            if zero == Moment::END {
                return (exit(swing, 0, fall, zero, None), 0);
            }
            let top = top(swing, 0, fall, zero);
            if exceeds_limit(swing, 0, top) {
                return (exit(swing, 0, fall, top, None), 0);
            }
        }
    }
    // The second half swing lasts to the end of contact, where W → 0 from above and R → ∞. Only
    // before `rise` can R have a top.
    if zero.is_before(rise) && swing.gap(1, rise, Point::at(rise)).turning() < 0.0 {
        let top = top(swing, 1, zero, rise);
        return if exceeds_limit(swing, 1, top) {
            (exit(swing, 1, zero, top, None), 1)
        } else {
            (exit(swing, 1, rise, Moment::END, None), 1)
        };
    }
    (exit(swing, 1, zero, Moment::END, None), 1)
}

/// The top of R between `low`, where W > 0, and `high`, where W < 0.
pub fn top(swing: &Swing, k: u32, low: Moment, high: Moment) -> Moment {
    root_between(low, high, None, |moment, point| turning(swing, k, moment, point))
}

/// The lowest place of R between `low`, where W < 0, and `high`, where W > 0.
pub fn bottom(swing: &Swing, k: u32, low: Moment, high: Moment) -> Moment {
    root_between(low, high, None, |moment, point| {
        let Jet { value, slope, curvature } = turning(swing, k, moment, point);
        Jet { value: -value, slope: -slope, curvature: -curvature }
    })
}

/// W along the root coordinate.
fn turning(swing: &Swing, k: u32, moment: Moment, point: Point) -> Jet {
    let gap = swing.gap(k, moment, point);
    along_root(moment, gap.turning(), -gap.q * pull(swing.bend, point.u), 0.0)
}

/// Whether R > 1 at `moment`.
pub fn exceeds_limit(swing: &Swing, k: u32, moment: Moment) -> bool {
    swing.gap(k, moment, Point::at(moment)).value < 0.0
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
    let gap = swing.gap(k, moment, Point::at(moment));
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
pub fn first_exit(swing: &Swing, rise: Moment, fall: Moment) -> Moment {
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
    f: impl Fn(Moment, Point) -> Jet,
) -> Moment {
    if low.half != high.half {
        let middle = Moment { half: Half::Decompression, root: MIDDLE_ROOT };
        if f(middle, Point::at(middle)).value < 0.0 {
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
        f(moment, Point::at(moment))
    });
    Moment { half, root }
}

/// The whole part of `x`, 0 if negative.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a contact has fewer than 2³² half swings up to the largest stiffness accepted"
)]
fn whole(x: f64) -> u32 {
    x as u32
}
