//! Where the undamped limit turns: the zeros of κL + L̈.

use super::{LARGEST_U, MIDDLE_ROOT, NormalMotion, root_near, speed_at};
use crate::exact::moment::{Half, Moment, Spring};

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
