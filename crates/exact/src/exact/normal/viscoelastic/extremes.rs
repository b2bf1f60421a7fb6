//! Where P = κL + L̈ changes its sign.
//!
//! P is F(1 − K/κ) with K = −F̈/F. With p = a v/u² and k = a² u,
//!
//! 4 (1 + p)² a² dK/d(t/a) = −(A k² + B k + C), A = 4(p + 1)(3p² + 5p + 3),
//! B = p(6p³ + 5p² − 6p − 9), C = 2p³(p² − 3).
//!
//! K rises only where p is between 0 and √3 and k is small; a trajectory can enter that region only
//! at p > p\* and leave it only at p < p\*, with p\* = 0.9692288275… (PROOFS.md). Therefore K
//! falls, or it falls to one minimum, rises to one maximum and falls. If it rises, it does so where
//! p = p\*.

use stickslip_contact::numerics::root::crossing;

use super::Viscoelastic;
use crate::exact::moment::{Moment, Motion, Spring};
use crate::exact::normal::Trajectory;

/// A number above the maximum of K for every damping. It is largest, 1.8620002…, where the extremes
/// merge, at a = 0.587758755… (computed; PROOFS.md).
pub const LARGEST_MAXIMUM: f64 = 1.8622;

/// p\*, a zero of the resultant in PROOFS.md.
const TANGENCY: f64 = 0.969_228_827_5;

/// The minimum and the maximum of K.
#[derive(Clone, Copy, Debug)]
pub struct Extremes {
    /// Their places, and K there.
    least: (f64, f64),
    most: (f64, f64),
}

impl Extremes {
    /// The extremes of `path`, if there are any: for a < 0.5877….
    pub fn of(path: &Viscoelastic) -> Option<Self> {
        let rise = |s: f64| path.rise_of_k(s);
        let top = path.middle;
        let tangency = crossing(0.0, top, |s| path.excess_of_p(s));
        if rise(tangency) <= 0.0 {
            return None;
        }
        // K falls at the start, and from where v = 0 on.
        let least = crossing(tangency, 0.0, rise);
        let still = crossing(tangency, path.end, |s| path.motion(path.moment(s)).v);
        let most = crossing(tangency, still, rise);
        let k = |s: f64| {
            let motion = path.motion(path.moment(s));
            -motion.force_bend / motion.force
        };
        Some(Self { least: (least, k(least)), most: (most, k(most)) })
    }

    /// The two last zeros of P, if it has three.
    pub fn turns(&self, path: &Viscoelastic, spring: &Spring) -> Option<[Moment; 2]> {
        if !(self.least.1 < spring.kappa && spring.kappa < self.most.1) {
            return None;
        }
        let pull = |s: f64| path.motion(path.moment(s)).pull(spring);
        let fall = crossing(self.least.0, self.most.0, pull);
        let rise = crossing(path.end, self.most.0, pull);
        Some([fall, rise].map(|s| path.moment(s)))
    }

    /// The moment of the maximum.
    pub fn split(&self, path: &Viscoelastic) -> Moment {
        path.moment(self.most.0)
    }
}

impl Viscoelastic {
    /// The two last zeros of P, if the signs at the nodes show them: then P has three zeros, and
    /// the first one is before these.
    pub(super) fn turns_between_nodes(&self, spring: &Spring) -> Option<[Moment; 2]> {
        let pull = |moment: Moment| self.motion(moment).pull(spring);
        let mut nodes = self.nodes_in_time().skip(1);
        let high = nodes.find(|&node| pull(node) > 0.0)?;
        let mut before = high;
        let low = nodes.find(|&node| {
            let falls = pull(node) < 0.0;
            before = if falls { before } else { node };
            falls
        })?;
        let mut last = low;
        let rise = nodes.chain([Moment::END]).find(|&node| {
            let rises = pull(node) > 0.0;
            last = if rises { last } else { node };
            rises
        })?;
        let zero = |positive: Moment, negative: Moment| {
            let at = |s: f64| self.motion(self.moment(s)).pull(spring);
            self.moment(crossing(self.place(positive), self.place(negative), at))
        };
        Some([zero(before, low), zero(rise, last)])
    }

    /// a v − p\* u², which falls through 0 where p = p\*.
    fn excess_of_p(&self, s: f64) -> f64 {
        let motion = self.motion(self.moment(s));
        let (alpha, beta) = (self.scale.strengths.alpha, self.scale.strengths.beta);
        beta * motion.v - TANGENCY * alpha * motion.u * motion.u
    }

    /// A number with the sign of dK/dt: −(A k² + B k + C) u¹⁰/a³, for a damping below 1.
    fn rise_of_k(&self, s: f64) -> f64 {
        let motion = self.motion(self.moment(s));
        let (a, u, v) = (self.scale.strengths.beta, motion.u, motion.v);
        let (x, d) = (u * u, a * v);
        let (x2, d2) = (x * x, d * d);
        // The coefficients times u¹⁰ with p = d/x, divided by a³ together with k² and k.
        let square = 4.0 * a * x * x2 * (d + x) * (3.0 * d2 + 5.0 * d * x + 3.0 * x2);
        let linear = u * x * v * (6.0 * d * d2 + 5.0 * d2 * x - 6.0 * d * x2 - 9.0 * x * x2);
        let constant = 2.0 * v * v * v * (d2 - 3.0 * x2);
        -(square + linear + constant)
    }
}
