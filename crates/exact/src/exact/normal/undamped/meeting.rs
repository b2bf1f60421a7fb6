//! The end of a slip phase without damping.
//!
//! With b = 3/(2κ), the guard is g = s·w − b u v. All slip phases of a collision share the function
//!
//! h = (1 − |v|) + b u |v|.
//!
//! Let C be s·w carried back to the start of contact. Then g is C − h in the compression and
//! h − (2 − C) in the decompression. From either end of contact h rises from 0 up to its crest. The
//! crest is the largest compression if b u ≤ 1 there (κ ≥ 1.568…), and otherwise the one zero of
//! dh/dt before it.

use stickslip_contact::numerics::double_double::DoubleDouble;
use stickslip_contact::numerics::root::{Jet, bracketed};

use super::{LARGEST_U, MIDDLE_ROOT, NormalMotion, pull, root_near, speed_at};
use crate::exact::moment::{Half, Moment, Spring};
use crate::exact::slip::SlipPhase;

/// Value of b u at the largest compression above which h is nearly flat somewhere: there dg/dt is
/// −u³(1 − b u), and before it |dg/dt| is not smaller.
const FLAT: f64 = 0.97;

/// See [`Trajectory::meeting`](crate::exact::normal::Trajectory::meeting).
pub fn meeting(spring: &Spring, sliding: &SlipPhase, low: Moment, high: Moment) -> Moment {
    let bend = spring.bend;
    let until = |half, root| if half == low.half { root } else { MIDDLE_ROOT };
    let early = low.half == Half::Compression
        && (high.half == Half::Compression || sliding.at_start() < 1.0);
    if !early {
        let first = until(Half::Decompression, low.root);
        let root = inverse(bend, -sliding.at_end(), high.root, first);
        return Moment { half: Half::Decompression, root };
    }
    let carried_back = sliding.at_start();
    let crest = if high.half == Half::Compression { high.root } else { MIDDLE_ROOT };
    let root = inverse(bend, carried_back, low.root, crest);
    let root = if bend * LARGEST_U > FLAT {
        refined_onset(spring.kappa, bend, carried_back, root, crest)
    } else {
        root
    };
    Moment { half: Half::Compression, root }
}

/// The root coordinate at which h is `target`, between `low` and `high` on the rising piece.
fn inverse(bend: f64, target: f64, low: f64, high: f64) -> f64 {
    // h = b u + (1 − |v|)(1 − b u). Close to an end of contact the first term dominates, for a
    // stiff spring the second. Up to h = 1 each of them alone gives a u above the root.
    let soft = target / bend;
    let u = if target < 1.0 {
        soft.min((1.25 * target * (2.0 - target)).powf(0.2))
    } else {
        soft.min(LARGEST_U)
    };
    let guess = u * (1.0 + 0.0571 * u * (u * u) * (u * u));
    bracketed(high, low, guess, |root| {
        let NormalMotion { u, v, deficit } =
            NormalMotion::at(Moment { half: Half::Compression, root });
        let pull = pull(bend, u);
        let pull_per_u = 3.0 * u * u - bend * (0.5 / (u * u) + 5.6 * u * u * u);
        Jet {
            value: deficit + bend * u * v - target,
            slope: 2.0 * root * pull,
            curvature: 2.0 * pull + 2.0 * root * root / u * v * pull_per_u,
        }
    })
}

/// The root coordinate at which a slip phase in the compression ends: `root`, improved if it is
/// beside a slip graze.
///
/// `target` is s·w carried back to the start of contact, and `crest` the end of the piece on which
/// h rises. The unknown of the step is v: u = ((5/4)(1 − v²))^{1/5} and g = (target − 1) + v (1 − b
/// u) need no number that is known to rounding only.
pub fn refined_onset(kappa: f64, bend: f64, target: f64, root: f64, crest: f64) -> f64 {
    let NormalMotion { u, v, .. } = NormalMotion::at(Moment { half: Half::Compression, root });
    let slope = pull(bend, u);
    // With a larger slope, rounding moves the switch by at most 1e-14. Near the start, where there
    // is no graze, v is not a good unknown.
    if slope > 0.02 || v > 0.9 {
        return root;
    }
    let one = DoubleDouble(1.0, 0.0);
    let z = DoubleDouble(1.25, 0.0).times(one.minus(DoubleDouble::product(v, v)));
    let u2 = DoubleDouble::product(u, u);
    let residue = z.minus(u2.times(u2).times(DoubleDouble(u, 0.0))).nearest();
    let u = DoubleDouble::sum(u, residue / (5.0 * u * u * u * u));
    let bend = DoubleDouble(1.5, 0.0).over(DoubleDouble(kappa, 0.0));
    let guard =
        DoubleDouble::sum(target, -1.0).plus(one.minus(bend.times(u)).times(DoubleDouble(v, 0.0)));
    let refined = root + guard.nearest() / slope / (2.0 * root);
    // At the crest itself a Newton step would not help.
    if (refined - root).abs() < 0.1 * (crest - root) { refined } else { root }
}

/// The root coordinate, in both halves, of the zeros of κL + L̈, if there are any: for κ < 1.568….
///
/// In the compression it is the crest of h = (1 − |v|) + b u |v|, which decides where slip ends.
pub fn crest(spring: &Spring) -> Option<f64> {
    (spring.bend * LARGEST_U > 1.0).then(|| solve(spring.kappa))
}

/// Solves dh/dt = 0, that is u⁴/b + 1/2 = (7/5) u⁵, for b u > 1 at the largest compression.
fn solve(kappa: f64) -> f64 {
    let scale = kappa / 1.5;
    // From the zero to the largest u the function is concave and falls: Newton's steps from the
    // right approach the zero from one side.
    let mut u = LARGEST_U;
    for _ in 0..60 {
        let u3 = u * u * u;
        let step = (scale * u3 * u + 0.5 - 1.4 * u3 * u * u) / (4.0 * scale * u3 - 7.0 * u3 * u);
        u -= step;
        if step.abs() < 1e-15 {
            break;
        }
    }
    let root = root_near(u);
    // One Newton step in time, with dv/dt = −u³.
    let error = NormalMotion::at(Moment { half: Half::Compression, root }).v - speed_at(u);
    (root + error / (2.0 * root * u * u * u)).min(MIDDLE_ROOT)
}
