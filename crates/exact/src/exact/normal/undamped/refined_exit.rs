//! The end of a stick phase beside a graze, without the errors of rounding in its guard.
//!
//! As at the end of a slip phase (`meeting`), one Newton step with the guard in [`DoubleDouble`]
//! numbers removes them.

use stickslip_contact::numerics::double_double::DoubleDouble;

use super::{CONTACT_TIME, CONTACT_TIME_REST, NormalMotion, Undamped};
use crate::exact::moment::{Half, Moment};
use crate::exact::normal::{StickPhase, Trajectory};

/// The moment at which a stick phase ends on the side `sign`: `moment`, improved.
///
/// `rate` is d(L − sign·y)/dt at `moment`. Most of the rounding is in the angle √κ·τ of the spring.
pub fn refined_exit(stick: &StickPhase, sign: f64, moment: Moment, rate: f64) -> Moment {
    let spring = stick.spring;
    let omega = DoubleDouble(
        spring.omega,
        (-spring.omega).mul_add(spring.omega, spring.kappa) / (2.0 * spring.omega),
    );
    let angle = omega.times(elapsed(stick.start, moment));
    let (sin, cos) = angle.0.sin_cos();
    let (sin, cos) =
        (DoubleDouble::sum(sin, angle.1 * cos), DoubleDouble::sum(cos, -angle.1 * sin));
    let elongation = limit(spring.kappa, stick.start);
    let y = elongation.times(cos).plus(stick.velocity.over(omega).times(sin));
    let gap = limit(spring.kappa, moment).minus(DoubleDouble(sign * y.0, sign * y.1));
    let root =
        moment.root - gap.nearest() / rate / Undamped.time_along_root(&Undamped.at(moment))[0];
    // At a touch within rounding the rate is too small to divide by.
    if (root - moment.root).abs() < 1e-6 * moment.root { Moment { root, ..moment } } else { moment }
}

/// The limit L = u³/κ.
fn limit(kappa: f64, moment: Moment) -> DoubleDouble {
    let u = DoubleDouble::sum(moment.root, NormalMotion::excess(moment.root));
    u.times(u).times(u).over(DoubleDouble(kappa, 0.0))
}

/// Time from `start` to `end`.
fn elapsed(start: Moment, end: Moment) -> DoubleDouble {
    let (a, b) =
        (DoubleDouble::product(start.root, start.root), DoubleDouble::product(end.root, end.root));
    match (start.half, end.half) {
        (Half::Compression, Half::Compression) => b.minus(a),
        (Half::Decompression, _) => a.minus(b),
        (Half::Compression, Half::Decompression) => {
            DoubleDouble(CONTACT_TIME, CONTACT_TIME_REST).minus(a).minus(b)
        }
    }
}
