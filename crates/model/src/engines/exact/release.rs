//! The end of a stick phase: where the spring reaches its limit again.
//!
//! On each half swing the ratio R of spring and limit rises only along one or two
//! [flanks](super::flank). The first flank on which R passes 1 ends the phase.

use std::f64::consts::{FRAC_PI_2, PI};

use super::flank::{Flanks, exceeds_limit, exit, top};
use super::swing::{Swing, half_swing_sign};
use super::trajectory::{Half, LARGEST_U, Moment, NormalMotion, speed_at};

/// The end of a stick phase.
#[derive(Clone, Copy, Debug)]
pub struct Release {
    /// The moment of the end.
    pub moment: Moment,
    /// Number of the half swing on which the phase ends. It starts on number 0; if the number is
    /// even, it ends on the side on which it started.
    pub half_swing: u32,
    /// The normal motion at the end.
    pub normal: NormalMotion,
    /// Velocity w at the end, in the orientation of the phase.
    pub velocity: f64,
    /// Sign changes of the velocity during the phase.
    pub reversals: usize,
}

impl Release {
    /// The end of `swing`, which is before the end of contact, where the limit is 0.
    ///
    /// `crest` is the root coordinate of the two zeros of κL + L̈, if there are any.
    pub fn of(swing: &Swing, crest: Option<f64>) -> Self {
        let (moment, half_swing) = match crest {
            Some(crest) => slow_release(swing, crest),
            None => fast_release(swing),
        };
        let (_, velocity) = swing.motion(swing.start.time_until(moment));
        // w vanishes at the peak of each half swing. The first peak is after the start if w > 0 at
        // the start; the last peak is before the end if q falls at the end.
        let peaks =
            half_swing as usize + usize::from(half_swing_sign(half_swing) * velocity <= 0.0);
        let before_start = usize::from(swing.velocity.0 <= 0.0);
        Self {
            moment,
            half_swing,
            normal: NormalMotion::at(moment),
            velocity,
            reversals: peaks.saturating_sub(before_start),
        }
    }
}

/// The end of a phase for κ ≥ 1.568…: on the first half swing R only falls, on each later one it
/// rises to one top and falls.
fn fast_release(swing: &Swing) -> (Moment, u32) {
    let calm = Calm::of(swing);
    let (mut from, mut k) = calm.skip(swing, swing.moment_at_angle(0.0), 1);
    loop {
        let peak = swing.moment_at_angle((f64::from(k) - 0.5) * PI);
        if peak == Moment::END {
            // At the end of contact q > 0 = L: R rises to infinity.
            return (exit(swing, k, from, Moment::END, None), k);
        }
        let gap = swing.gap(k, peak, NormalMotion::at(peak));
        if gap.value < 0.0 {
            // A zero of D before the peak, by the Taylor polynomial of D at the peak.
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

/// The time during which L > A ≥ |y|: the spring cannot reach its limit, whatever the number of
/// swings.
struct Calm {
    /// √x at its start and end.
    u: f64,
    /// Its start and end, if there is such a time.
    ends: Option<(Moment, Moment)>,
}

impl Calm {
    fn of(swing: &Swing) -> Self {
        // The moments at which L = A are known to 1e-8 only: a slightly larger A is on the safe
        // side.
        let u = (swing.kappa * swing.amplitude * (1.0 + 1e-7)).cbrt();
        let ends = (u < LARGEST_U).then(|| {
            let end = Moment::near_compression(Half::Decompression, u);
            (Moment { half: Half::Compression, ..end }, end)
        });
        Self { u, ends }
    }

    /// The first half swing on which the spring can reach its limit, with a moment on it before
    /// that. The spring has not reached its limit before `zero`, where half swing `k` starts.
    ///
    /// After a calm it is the half swing on which the calm ends, if R still rises at that end, and
    /// otherwise the next one.
    fn skip(&self, swing: &Swing, zero: Moment, k: u32) -> (Moment, u32) {
        let Some((start, end)) = self.ends else { return (zero, k) };
        if zero.is_before(start) || !zero.is_before(end) {
            return (zero, k);
        }
        let angle = swing.omega * swing.start.time_until(end) - swing.first_zero + FRAC_PI_2;
        // The last half swing whose peak is before the end of the calm.
        let last = whole(angle / PI);
        let (sin, cos) = (angle - f64::from(last) * PI).sin_cos();
        // The condition W > 0 with q = A cos and L = A.
        let limit_falls = swing.bend * self.u * speed_at(self.u);
        if last >= k && cos > 0.0 && limit_falls * cos > swing.omega * swing.amplitude * sin {
            return (end, last);
        }
        let next = swing.moment_at_angle(f64::from(last) * PI);
        (if end.is_before(next) { next } else { end }, last + 1)
    }
}

/// The end of a phase for κ < 1.568…: the contact is shorter than 1.3 half swings, but κL + L̈
/// changes its sign.
fn slow_release(swing: &Swing, crest: f64) -> (Moment, u32) {
    let on = |k| Some((Flanks::of(swing, Some(crest), k)?.exit(swing, false)?.0, k));
    on(0).or_else(|| on(1)).unwrap_or((Moment::END, 1))
}

/// The whole part of `x`, and 0 if `x` is negative.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a contact has fewer than 2³² half swings up to the largest stiffness"
)]
fn whole(x: f64) -> u32 {
    x as u32
}
