//! The end of a stick phase: where the spring reaches its limit again.
//!
//! On each half swing the ratio R of spring and limit rises only along one or two
//! [flanks](super::flank). The first flank on which R passes 1 ends the phase.

use std::f64::consts::{FRAC_PI_2, PI};

use super::flank::{Flanks, exit, passed, top};
use super::moment::{At, Moment, Motion};
use super::normal::Trajectory;
use super::swing::{AT_IMPACT, Swing, half_swing_sign};

/// The end of a stick phase.
#[derive(Clone, Copy, Debug)]
pub struct Release<M> {
    /// The moment of the end, with the normal motion.
    pub end: At<M>,
    /// Number of the half swing on which the phase ends. It is even if the phase ends on the side
    /// on which it started.
    pub half_swing: u32,
    /// Velocity w at the end, in the orientation of the phase.
    pub velocity: f64,
    /// Sign changes of the velocity during the phase.
    pub reversals: usize,
}

impl<M: Motion> Release<M> {
    /// The end of `swing`, which is before the end of contact, where the limit is 0.
    pub fn of<T: Trajectory<Motion = M>>(swing: &Swing<T>) -> Self {
        let (moment, half_swing) = match swing.turns {
            Some(_) => release_with_turns(swing),
            None => release_without_turns(swing),
        };
        let end = swing.path.at(moment);
        let (_, velocity) = swing.motion(swing.elapsed(&end));
        // w vanishes at the peak of each half swing. The first peak is after the start if w > 0 at
        // the start; the last peak is before the end if q falls at the end.
        let swung = (half_swing - swing.first) as usize;
        let peaks = swung + usize::from(half_swing_sign(half_swing) * velocity <= 0.0);
        let before_start = usize::from(swing.velocity.0 <= 0.0);
        Self { end, half_swing, velocity, reversals: peaks.saturating_sub(before_start) }
    }
}

/// The end of a phase without turns: on the first half swing after slip R only falls, on each other
/// one it rises to one top and falls.
fn release_without_turns<T: Trajectory>(swing: &Swing<T>) -> (Moment, u32) {
    let Swing { path, spring, .. } = swing;
    let calm = Calm::of(swing);
    let first = swing.first.max(1);
    let start = swing.moment_at_angle(f64::from(first - 1) * PI);
    let (mut from, mut k) = calm.skip(swing, start, first);
    let mut at_from = path.at(from);
    loop {
        if from == Moment::END {
            // The spring passes 0 so late that no moment is left after it.
            return (from, k);
        }
        let peak = swing.moment_near_angle((f64::from(k) - 0.5) * PI, ROUGH);
        if peak == Moment::END {
            // At the end of contact q > 0 = L: R rises to infinity.
            return (exit(swing, k, from, Moment::END, None), k);
        }
        let at_peak = path.at(peak);
        let gap = swing.gap(k, &at_peak);
        if gap.value < 0.0 {
            if k == AT_IMPACT && swing.first == AT_IMPACT {
                let guess = path.exit_after_impact(spring, swing.velocity.0);
                return (exit(swing, k, from, peak, guess), k);
            }
            // A zero of D before the peak, by the Taylor polynomial of D at the peak.
            let (excess, slope) = (-gap.value, gap.rate.abs());
            let bent = (slope * slope + 2.0 * gap.acceleration.max(0.0) * excess).sqrt();
            let guess = path.before(&at_peak, 2.0 * excess / (slope + bent), f64::INFINITY);
            return (exit(swing, k, from, peak, Some(guess)), k);
        }
        let zero = swing.moment_at_angle(f64::from(k) * PI);
        let at_zero = path.at(zero);
        // L has one maximum only: between two places where L > A it cannot reach A.
        let calm_at = |at: &At<T::Motion>| at.motion.limit(spring) > swing.amplitude * MORE;
        let rises = gap.turning() > 0.0;
        let (low, high) = if rises { (&at_peak, &at_zero) } else { (&at_from, &at_peak) };
        if !(calm_at(low) && calm_at(high)) {
            let (low, high) = (low.moment, high.moment);
            if high == Moment::END {
                return (exit(swing, k, low, high, None), k);
            }
            // Newton's step for W from the peak.
            let until = gap.turning() / (gap.q * at_peak.motion.pull(spring));
            let guess = if rises {
                path.after(&at_peak, until, f64::INFINITY)
            } else {
                path.before(&at_peak, -until, f64::INFINITY)
            };
            let top = top(swing, k, low, high, Some(guess));
            if let Some(high) = passed(swing, k, top) {
                return (exit(swing, k, low, high, None), k);
            }
        }
        (from, k) = calm.skip(swing, zero, k + 1);
        at_from = if from == zero { at_zero } else { path.at(from) };
    }
}

/// More than one by more than rounding.
const MORE: f64 = 1.0 + 1e-12;

/// The error, as an angle, of a peak: its signs only have to distinguish the two parts of a half
/// swing.
const ROUGH: f64 = 0.1;

/// The time during which L > A ≥ |y|: the spring cannot reach its limit, whatever the number of
/// swings.
struct Calm {
    /// Its start and end, if there is such a time.
    ends: Option<[Moment; 2]>,
}

impl Calm {
    fn of<T: Trajectory>(swing: &Swing<T>) -> Self {
        Self { ends: swing.path.above(swing.spring.kappa * swing.amplitude, swing.spring.omega) }
    }

    /// The first half swing on which the spring can reach its limit, with a moment on it before
    /// that. The spring has not reached its limit before `zero`, where half swing `k` starts.
    ///
    /// After a calm it is the half swing on which the calm ends, if R still rises at that end, and
    /// otherwise the next one.
    fn skip<T: Trajectory>(&self, swing: &Swing<T>, zero: Moment, k: u32) -> (Moment, u32) {
        let Some([start, end]) = self.ends else { return (zero, k) };
        if zero.is_before(start) || !zero.is_before(end) {
            return (zero, k);
        }
        let at_end = swing.path.at(end);
        let omega = swing.spring.omega;
        let angle = omega * swing.elapsed(&at_end) - swing.first_zero + FRAC_PI_2;
        // The last half swing whose peak is before the end of the calm.
        let last = whole(angle / PI);
        let (sin, cos) = (angle - f64::from(last) * PI).sin_cos();
        // The condition W > 0 with q = A cos and L = A.
        let limit_falls = -at_end.motion.limit_rate(&swing.spring);
        if last >= k && cos > 0.0 && limit_falls * cos > omega * swing.amplitude * sin {
            return (end, last);
        }
        let next = swing.moment_at_angle(f64::from(last) * PI);
        (if end.is_before(next) { next } else { end }, last + 1)
    }
}

/// The end of a phase with turns. The spring is so soft that there are few half swings.
fn release_with_turns<T: Trajectory>(swing: &Swing<T>) -> (Moment, u32) {
    let mut k = swing.first;
    loop {
        if let Some((moment, _)) = Flanks::of(swing, k).and_then(|flanks| flanks.exit(swing, false))
        {
            return (moment, k);
        }
        if swing.moment_at_angle(f64::from(k) * PI) == Moment::END {
            return (Moment::END, k.max(1));
        }
        k += 1;
    }
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
