//! Properties of the spring's limit L = u³/κ that slip and stick phases both use.
//!
//! With b = 3/(2κ), dL/dt = b u v. While sliding, the number that decides is
//! h = (1 − |v|) + b u |v|; `slide` says why.

use super::trajectory::{Half, LARGEST_U, MIDDLE_ROOT, Moment, NormalMotion, speed_at};

/// The place where h is largest, if that is not the largest compression.
#[derive(Clone, Copy, Debug)]
pub struct Crest {
    /// The root coordinate, in either half.
    pub root: f64,
    /// The value of h.
    pub height: f64,
}

impl Crest {
    /// Solves dh/dt = 0, that is u⁴/b + 1/2 = (7/5) u⁵, for b u > 1 at the largest compression.
    pub fn new(kappa: f64, bend: f64) -> Self {
        let scale = kappa / 1.5;
        // From the zero to the largest u the function is concave and falls: Newton's steps from
        // the right approach the zero from one side.
        let mut u = LARGEST_U;
        for _ in 0..60 {
            let u3 = u * u * u;
            let step =
                (scale * u3 * u + 0.5 - 1.4 * u3 * u * u) / (4.0 * scale * u3 - 7.0 * u3 * u);
            u -= step;
            if step.abs() < 1e-15 {
                break;
            }
        }
        let mut moment = Moment::near_compression(Half::Compression, u);
        // One Newton step in time, with dv/dt = −u³.
        let error = NormalMotion::at(moment).v - speed_at(u);
        moment.root = (moment.root + error / (2.0 * moment.root * u * u * u)).min(MIDDLE_ROOT);
        let NormalMotion { u, v, deficit } = NormalMotion::at(moment);
        Self { root: moment.root, height: deficit + bend * u * v }
    }
}

/// κL + L̈ = u³ + b (1/(2u) − (7/5) u⁴), which drives the spring and its limit apart.
///
/// In slip it is −dg/dt. In stick it is D̈ + κD for D = L ∓ y.
pub fn pull(bend: f64, u: f64) -> f64 {
    u * u * u + bend * (0.5 / u - 1.4 * (u * u) * (u * u))
}
