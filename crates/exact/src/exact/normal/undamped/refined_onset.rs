//! The end of a slip phase beside a graze, without the errors of rounding in its guard.
//!
//! If a guard falls through 0 at the rate δ, an error of 1e-16 in the guard becomes an error of
//! 1e-16/δ in the switch. One Newton step with the guard in [`DoubleDouble`] numbers removes it.

use stickslip_contact::numerics::double_double::DoubleDouble;

use super::{NormalMotion, pull};
use crate::exact::moment::{Half, Moment};

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
