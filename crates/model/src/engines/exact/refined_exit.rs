//! Switches beside a graze, where rounding in the guard would be magnified.
//!
//! A guard that falls through 0 at the rate δ turns an error of 1e-16 in itself into one of
//! 1e-16/δ in the switch. One Newton step with the guard computed in [`DoubleDouble`]s takes it away.

use super::slide::{Slide, pull};
use super::swing::Swing;
use super::trajectory::{CONTACT_TIME, CONTACT_TIME_REST, Half, Moment, Point};
use crate::double_double::DoubleDouble;

/// `root`, where a slip phase in the compression ends, improved beside a slip graze; `target` is
/// s·w carried back to the start of contact, `crest` the end of the piece on which h rises.
///
/// The step is taken in v, in which u = ((5/4)(1 − v²))^{1/5} and
/// g = (target − 1) + v (1 − b u) need nothing that is known to rounding only.
pub fn refined_onset(slide: &Slide, target: f64, root: f64, crest: f64) -> f64 {
    let Point { u, v, .. } = Point::at(Moment { half: Half::Compression, root });
    let slope = pull(slide.bend, u);
    // Elsewhere rounding moves the switch by 1e-14 at most, and v is no good unknown near the
    // start, far from every graze.
    if slope > 0.02 || v > 0.9 {
        return root;
    }
    let one = DoubleDouble(1.0, 0.0);
    let z = DoubleDouble(1.25, 0.0).times(one.minus(DoubleDouble::product(v, v)));
    let u2 = DoubleDouble::product(u, u);
    let residue = z.minus(u2.times(u2).times(DoubleDouble(u, 0.0))).nearest();
    let u = DoubleDouble::sum(u, residue / (5.0 * u * u * u * u));
    let bend = DoubleDouble(1.5, 0.0).over(DoubleDouble(slide.kappa, 0.0));
    let guard = DoubleDouble::sum(target, -1.0).plus(one.minus(bend.times(u)).times(DoubleDouble(v, 0.0)));
    let refined = root + guard.nearest() / slope / (2.0 * root);
    // Beside the crest itself a Newton step is of no use.
    if (refined - root).abs() < 0.1 * (crest - root) { refined } else { root }
}

/// `moment`, where a stick phase ends on the side `sign`, improved beside a stick graze; `rate`
/// is d(L − sign·y)/dt there.
///
/// The angle √κ·τ of the spring suffers most from rounding.
pub fn refined_exit(swing: &Swing, sign: f64, moment: Moment, rate: f64) -> Moment {
    let omega =
        DoubleDouble(swing.omega, (-swing.omega).mul_add(swing.omega, swing.kappa) / (2.0 * swing.omega));
    let angle = omega.times(elapsed(swing.start, moment));
    let (sin, cos) = angle.0.sin_cos();
    let (sin, cos) = (DoubleDouble::sum(sin, angle.1 * cos), DoubleDouble::sum(cos, -angle.1 * sin));
    let elongation = limit(swing.kappa, swing.start);
    let y = elongation.times(cos).plus(swing.velocity.over(omega).times(sin));
    let gap = limit(swing.kappa, moment).minus(DoubleDouble(sign * y.0, sign * y.1));
    let root = moment.root - gap.nearest() / rate / moment.time_per_root();
    // A touch within rounding has no rate to divide by.
    if (root - moment.root).abs() < 1e-6 * moment.root { Moment { root, ..moment } } else { moment }
}

/// L = u³/κ.
fn limit(kappa: f64, moment: Moment) -> DoubleDouble {
    let u = DoubleDouble::sum(moment.root, Point::excess(moment.root));
    u.times(u).times(u).over(DoubleDouble(kappa, 0.0))
}

/// Time from `start` to `end`.
fn elapsed(start: Moment, end: Moment) -> DoubleDouble {
    let (a, b) = (DoubleDouble::product(start.root, start.root), DoubleDouble::product(end.root, end.root));
    match (start.half, end.half) {
        (Half::Compression, Half::Compression) => b.minus(a),
        (Half::Decompression, _) => a.minus(b),
        (Half::Compression, Half::Decompression) => {
            DoubleDouble(CONTACT_TIME, CONTACT_TIME_REST).minus(a).minus(b)
        }
    }
}
