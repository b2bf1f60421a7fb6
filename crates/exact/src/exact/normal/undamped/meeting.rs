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

use stickslip_contact::numerics::root::{Jet, bracketed};

use super::refined_onset::refined_onset;
use super::{LARGEST_U, MIDDLE_ROOT, NormalMotion, pull};
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
