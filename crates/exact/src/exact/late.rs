//! Margins of the last half swing, where its top is close to the end of contact or beyond it.
//!
//! With damping, L falls to 0 at an even rate at the end of contact. A ratio |y|/L whose maximum is
//! there is not a smooth function of κ and ψ. The gap D = L − |y| is, and has one minimum, which
//! may lie beyond the end, to where the motion is continued. With the amplitude A of the spring,
//! the margin is (1 + D/A)² − 1 there; it is the same number as of the ratio if the top is at the
//! peak of |y|. With little damping L falls faster than the spring over many half swings. These
//! have no minimum of the gap; only the last half swing, on which the gap rises again, has this
//! margin.

use std::f64::consts::PI;

use super::moment::{At, Moment};
use super::normal::Trajectory;
use super::normal::{along_root, root_between};
use super::swing::{Gap, Swing, half_swing_sign};

/// A half swing, with damping, on which R has its last top after the peak of the spring and after
/// the turns.
pub struct LateHalfSwing {
    k: u32,
    /// The peak or the last turn, where R rises and the gap D falls.
    first: Moment,
    /// A moment at which D rises again: the end of the half swing or of the contact, or just
    /// beyond. There may be none as far as the motion is continued.
    high: Option<Moment>,
}

impl LateHalfSwing {
    /// Half swing `k`, if it is one of these.
    pub fn of<T: Trajectory>(swing: &Swing<T>, k: u32) -> Option<Self> {
        if T::STARTS_IN_SLIP || k == 0 {
            return None;
        }
        let peak = swing.moment_at_angle((f64::from(k) - 0.5) * PI);
        let first = swing.turns.map_or(peak, |[_, turn]| peak.or_later(turn));
        let zero = swing.moment_at_angle(f64::from(k) * PI);
        if peak == Moment::END || !first.is_before(zero) {
            return None;
        }
        let gap = swing.gap(k, &swing.path.at(first));
        if !(gap.turning() > 0.0 && gap.rate < 0.0) {
            return None;
        }
        let rises = |&moment: &Moment| swing.gap(k, &swing.path.at(moment)).rate > 0.0;
        // Where the limit falls faster than the spring up to the next peak, which is on the other
        // side, D has no minimum: it is least on a later half swing of the same side.
        let is_last = swing.moment_at_angle((f64::from(k) + 0.5) * PI) == Moment::END;
        let beyond = Moment { root: -swing.path.beyond_end(), ..Moment::END };
        let ends = [zero, Moment::END, beyond];
        let high = ends[..if is_last { 3 } else { 1 }].iter().copied().find(rises);
        (is_last || high.is_some()).then_some(Self { k, first, high })
    }

    /// (1 + D/A)² − 1 where the gap D is least.
    ///
    /// If the top of R is at the peak, this is 1/R² − 1. But where the top is close to the end of
    /// contact, R is not a smooth function of the parameters. D is, since L falls to 0 at an
    /// even rate.
    pub fn margin<T: Trajectory>(&self, swing: &Swing<T>) -> Option<f64> {
        let part = swing.gap(self.k, &self.least(swing)?).value / swing.amplitude;
        Some(part * (part + 2.0))
    }

    /// Where the gap D is least.
    pub fn least<T: Trajectory>(&self, swing: &Swing<T>) -> Option<At<T::Motion>> {
        let &Self { k, first, high } = self;
        let path = swing.path;
        let least = root_between(path, first, high?, None, |at| {
            let Gap { rate, acceleration, .. } = swing.gap(k, at);
            along_root(path, at, -rate, -acceleration, 0.0)
        });
        Some(path.at(least))
    }
}

/// What continues 1/R² − 1 at the top of half swing `k`, without damping, when the top has left
/// through the end of contact, so that R rises to infinity there.
///
/// Near the end, a time τ before it, L = τ^{3/2}/κ and q = |w| (τ − τ₀). The top is at τ = 3τ₀, and
/// 1/R² = (27/4) τ₀/(κw)² there. This is smooth through τ₀ = 0, where y vanishes at the end. With a
/// small ψ its zero is closer to that place than boundaries can be resolved.
pub fn beyond_end<T: Trajectory>(swing: &Swing<T>, k: u32) -> Option<f64> {
    let sign = half_swing_sign(k);
    let (y, w) = at_end(swing);
    let (q, fall) = (sign * y, -sign * w);
    if !(T::STARTS_IN_SLIP && q >= 0.0 && fall > 0.0) {
        return None;
    }
    let pull = swing.spring.kappa * fall;
    let excess = -1.0 - 6.75 * q / (fall * pull * pull);
    let angle = swing.spring.omega * swing.path.time_left(&swing.start);
    Some(if k == 0 { excess / (angle * angle) } else { excess })
}

/// y and w at the end of contact, if the phase lasted until then.
pub fn at_end<T: Trajectory>(swing: &Swing<T>) -> (f64, f64) {
    swing.motion(swing.path.time_left(&swing.start))
}
